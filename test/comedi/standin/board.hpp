// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <comedilib.h>

#include <chrono>
#include <vector>

#include "comedi/standin/standin.hpp"
#include "tgr/drivers/virtual/slice_bank.hpp"

namespace ergotic::test {

constexpr unsigned kInputSubdevice = 1;  // 0 is digital, so that nobody guesses
constexpr unsigned kOutputSubdevice = 2;
constexpr unsigned kSubdevices = 3;

/// Ranges of a subdevice. \return empty if it has none
const std::vector<comedi_range>& rangesOf(unsigned subdevice);

/// The simulated board behind the stand-in's functions, which hold `mutex` as the kernel does.
class StandinBoard {
 public:
  explicit StandinBoard(const ComediStandinBoard& config);
  ~StandinBoard();
  StandinBoard(const StandinBoard&) = delete;
  StandinBoard& operator=(const StandinBoard&) = delete;

  const ComediStandinBoard& config() const { return config_; }
  void inject(const ComediFaultOrder& order) { faults_.push_back(order); }
  void plugIn();
  bool isPluggedIn();
  /// Handles know it from when they were opened; another one is dead.
  int generation() const { return generation_; }
  void hold(int channel, double target_m) {
    tgr::HandMove move;
    move.slice = channel;
    move.target_m = target_m;
    move.jumps = true;
    bank_.take(move);
  }
  double outputVolts(int channel) const { return outputs_[static_cast<std::size_t>(channel)]; }

  /// What the outputs give, V, as doubles in a file: as the terminals of a board, it is seen from
  /// outside, and does not end with the process.
  int terminals() const { return terminals_; }

  /// \return instructions run, or minus an errno
  int run(comedi_insnlist& list);

  ComediCounters counters;

 private:
  /// What faults do to one list.
  struct Trouble {
    int error = 0;
    unsigned instructions = 0;  // that are run
    double delay_s = 0.0;
  };
  Trouble meetFaults(const comedi_insnlist& list);
  void step();
  int execute(const comedi_insn& insn);
  int write(unsigned channel, const comedi_range& range, const comedi_insn& insn);
  int read(unsigned channel, const comedi_range& range, const comedi_insn& insn);

  ComediStandinBoard config_;
  tgr::SliceBank bank_;
  std::vector<ComediFaultOrder> faults_;
  std::vector<double> outputs_;  // V
  std::vector<double> sensed_;   // V
  std::vector<bool> stuck_;
  std::vector<bool> railed_;
  bool plugged_ = true;
  std::chrono::steady_clock::time_point back_;  // plugged in again by itself
  int generation_;
  int terminals_;
};

}  // namespace ergotic::test
