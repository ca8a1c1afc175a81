// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/tgr/virtual_driver.hpp"

/// A library with the functions of libcomedi that the driver calls, in front of a simulated board:
/// output channel i drives virtual slice i, which input channel i senses. Preloaded or linked
/// before libcomedi it takes its place.
///
/// The slices move on by one tick at the start of every list of instructions that reads, with the
/// outputs as they were; so a list's positions do not know its outputs yet, as on a real device,
/// and the same lists give the same bits.
///
/// In a process that only preloads it, the environment sets it up:
///   COMEDI_STANDIN_RATE_HZ  ticks per second, 1000 if absent
///   COMEDI_STANDIN_GESTURE  file of targets of the hands, as for the virtual driver
///   COMEDI_STANDIN_FAULTS   `kind[:channel[:after[:lists[:amount]]]]`, more after a comma; kinds
///                           short, eio, unplug, stuck, rail, slow
namespace ergotic::test {

struct ComediStandinBoard {
  double rate_hz = 1000.0;
  int channels = 16;               ///< of each subdevice
  double newtons_per_volt = 20.0;  ///< of each actuator
  double no_force_volts = 0.0;     ///< of each actuator
  double metres_per_volt = 0.004;  ///< of each sensor
  double rest_volts = 0.0;         ///< of each sensor
  bool can_deglitch = true;        ///< its outputs
  int open_error = 0;              ///< errno of comedi_open; 0: it opens
  tgr::VirtualSliceConfig slice;
  const char* gesture_file = "";
};

enum class ComediFault : std::uint8_t {
  kShort,   ///< only `amount` instructions of a list are run
  kError,   ///< none is run: EIO
  kUnplug,  ///< ENODEV for `amount` s, 0: until plugged in; old handles stay dead
  kStuck,   ///< the input keeps saying what it said
  kRail,    ///< the input is at its highest value
  kSlow,    ///< a list takes `amount` s longer
};

struct ComediFaultOrder {
  ComediFault kind = ComediFault::kError;
  int channel = 0;
  std::int64_t after = 0;  ///< reading lists that go well first
  std::int64_t lists = 1;  ///< reading lists that it lasts; < 0: for ever
  double amount = 0.0;
};

struct ComediCounters {
  std::int64_t opened = 0;
  std::int64_t closed = 0;
  std::int64_t lists = 0;          ///< of instructions, all
  std::int64_t reading_lists = 0;  ///< those that read: ticks
};

/// Resolution of all channels: 16 bits.
constexpr unsigned kComediMost = 65535;

/// The volts of a count in a range; that of +-10 V is the first one of both subdevices.
constexpr double comediVolts(double count, double low = -10.0, double high = 10.0) {
  return low + (high - low) * (count / kComediMost);
}

}  // namespace ergotic::test

/// For tests in the same process. Thread: any, all of them.
extern "C" {
/// A new board with slices at rest; handles of an old one are dead, its faults and counters gone.
void comediStandinReset(const ergotic::test::ComediStandinBoard* board);
void comediStandinInject(const ergotic::test::ComediFaultOrder* order);
void comediStandinPlugIn();
/// A hand's target, m.
void comediStandinHold(int channel, double target_m);
double comediStandinOutputVolts(int channel);
void comediStandinCounters(ergotic::test::ComediCounters* counters);
}
