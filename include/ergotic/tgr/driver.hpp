// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/device_clock.hpp"
#include "ergotic/tgr/gesture.hpp"

namespace YAML {
class Node;
}

namespace ergotic::tgr {

constexpr int kMaxSlices = 64;
constexpr double kAbsoluteForceLimitN = 200.0;  ///< physical limit; no setting exceeds it

/// Bits of what `exchange` met; 0: all went well.
enum ExchangeFlag : std::uint32_t {
  kExchangeOk = 0,
  kMissingSample = 1U << 0U,  ///< at least one position is not fresh
  kDeviceLost = 1U << 1U,     ///< the device does not answer any more
  kMadeSafe = 1U << 2U,       ///< forces are latched to zero by makeSafe()
  kWriteFailed = 1U << 3U,    ///< at least one force was not taken by the device
};

/// Assumed damping of a slice without better data, N s/m.
constexpr double kSupposedDamping = 2.0;

/// Grip of a simulated hand at a slice; docs/tgr.md has the figures.
enum class HandGrip : std::uint8_t { kConfigured, kSoft, kFirm, kQuick, kKey };

constexpr int kMaxHandSources = 16;
constexpr double kMaxTargetM = 0.1;  ///< largest distance of a hand's target from rest, m

/// Request of a player without a device: a motion of the hand at one slice of a simulated device.
struct HandMove {
  static constexpr double kOnArrival = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kMaxGlideS = 60.0;
  static constexpr double kMaxDelayS = 120.0;
  static constexpr double kPeakOfMean = 1.875;  ///< peak speed of a glide over its mean speed

  int slice = 0;
  double target_m = 0.0;  ///< target position of the hand, within +-kMaxTargetM
  /// Arrival time at the target, s, by the clock of the source: moves of one source keep their
  /// distances in time, and the hand goes on straight lines between them. kOnArrival: `delay_s`
  /// after the move arrives in the tick.
  double time_s = kOnArrival;
  double delay_s = 0.0;
  /// Duration of a minimum-jerk path that begins then, fed forward by the hand; 0: the hand moves
  /// on a straight line that ends then.
  double glide_s = 0.0;
  double timeout_s = 0.0;  ///< the hand lets go if its source is silent for so long; 0: never
  HandGrip grip = HandGrip::kConfigured;
  std::uint8_t source = 0;  ///< below kMaxHandSources
  bool lets_go = false;     ///< the hand lets go of the slice; the target has no effect
  bool jumps = false;       ///< the target jumps with the next tick, however far that is

  /// Whether the fields are within their ranges for a device of so many slices.
  bool isValid(int slices) const noexcept;
};

/// Data with which another process can take the force off a device when this process no longer can.
struct Guard {
  std::vector<std::string> words;  ///< kind of the device, then the parameters of that kind
  int file = -1;                   ///< open file that the other process also needs; -1: none
  std::int64_t life = 0;           ///< distinguishes this opening of the device from the one before

  bool operator==(const Guard& other) const {
    return words == other.words && file == other.file && life == other.life;
  }
};

/// A force-feedback device, an impedance device: it gives positions and takes forces.
///
/// The order of calls is open, any number of exchange, close. `makeSafe` may come at any time.
class Driver {
 public:
  virtual ~Driver() = default;

  /// Opens the device with zero force. Realtime: no. Thread: setup
  /// \param tick_rate_hz  rate at which exchange will be called
  /// \throws DeviceError saying which device, what failed, and what to do
  virtual void open(double tick_rate_hz) = 0;

  /// Zero force, then gives the device back. Idempotent. Realtime: no. Thread: setup
  virtual void close() noexcept = 0;

  /// Tries to get a lost device back, while ticks go on: exchange says kDeviceLost until then.
  /// No effect on a device that is well. The force stays at zero until the caller's chain wants it.
  /// Realtime: no. Thread: setup, while exchange runs in the tick's
  /// \throws DeviceError if it is still lost
  virtual void reconnect() {}

  /// Number of slices, 1...kMaxSlices, constant.
  virtual int slices() const noexcept = 0;

  /// Runs one transaction: the forces of the last tick go out, positions come in.
  /// \param[in]  forces     [slices] N, positive along the slice's axis (up); V if `isRaw`
  /// \param[out] positions  [slices] m, relative to the slice's rest; V if `isRaw`
  /// \return ExchangeFlag bits
  /// Realtime: yes. Thread: tick
  virtual std::uint32_t exchange(const double* forces, double* positions) noexcept = 0;

  /// Whether all of the device is simulated and moves on by one tick with each exchange, whenever
  /// that comes. The ticks that a stall has cost are then run one by one, with their exchanges and
  /// their forces, as if they had been in time; a real device has moved on by itself meanwhile, and
  /// is asked once. Never true where `canHurt` is. Realtime: yes. Thread: tick
  virtual bool isSteppedByExchange() const noexcept { return false; }

  /// Zero force now and from now on: later exchanges send zero until `rearm`. Idempotent, from any
  /// thread or a signal's helper thread, also while exchange runs; takes at most one tick.
  virtual void makeSafe() noexcept = 0;
  /// As makeSafe, for the tick itself: work that takes a lock, or longer, is left to the tick's
  /// next exchange. Realtime: yes. Thread: tick
  virtual void makeSafeInTick() noexcept { makeSafe(); }

  /// Allows force again after makeSafe; the caller's chain ramps it in. Realtime: yes. Thread: tick
  virtual void rearm() noexcept = 0;

  /// Ticks of delay the driver adds to the loop's one (0 for a synchronous device). Constant after
  /// open.
  virtual int extraDelayTicks() const noexcept { return 0; }

  /// Data for a guardian process, see Guardian; empty if the device has no force once this process
  /// ends. \pre open. Realtime: no. Thread: setup
  virtual std::vector<Guard> guards() const { return {}; }

  /// True if `exchange` speaks volts: a CalibratedDriver is needed in front.
  virtual bool isRaw() const noexcept { return false; }

  /// Slices that have no calibration, a bit each: they may not get force. Changes while ticks go
  /// on. Realtime: yes. Thread: any
  virtual std::uint64_t uncalibrated() const noexcept { return 0; }

  /// Whether a hand may be at the device, which a stall of the ticks would kick: false for devices
  /// that are only simulated. Constant. Realtime: yes. Thread: any
  virtual bool canHurt() const noexcept { return true; }

  /// Damping of a slice by itself, N s/m, known or supposed: what scenes may ask for rests on it.
  virtual double damping() const noexcept { return kSupposedDamping; }
  /// Declared part of that damping, N s/m; 0: none is declared. The passivity limits towards a hand
  /// rely on this value.
  virtual double declaredDamping() const noexcept { return 0.0; }

  /// Clock of the device, if the device says when ticks are due; else null. Constant after open.
  virtual DeviceClock* clock() noexcept { return nullptr; }

  /// Parameter values that the gesture of a simulated device sets, in order of time: the player of
  /// the scene sets each when `gestureTime` has reached it. Constant. Realtime: no. Thread: any
  virtual std::vector<GestureValue> gestureValues() const { return {}; }
  /// Time for which that gesture has been played, s. Realtime: yes. Thread: any
  virtual double gestureTime() const noexcept { return 0.0; }

  /// Whether the slice is simulated, with a hand that `move` moves. Constant while open.
  /// Realtime: yes. Thread: any
  virtual bool hasHand(int /*slice*/) const noexcept { return false; }
  /// Moves the hand at a slice of a simulated device. Realtime: yes. Thread: one, any
  /// \return false if there is no such hand or slice, a value is outside its range, or the ring of
  ///         pending moves is full
  virtual bool move(const HandMove& /*move*/) noexcept { return false; }
  /// The hand wants the slice to be there from the next tick on, as one that jumps. As `move`
  bool setTarget(int slice, double target_m) noexcept {
    HandMove move;
    move.slice = slice;
    move.target_m = target_m;
    move.jumps = true;
    return this->move(move);
  }
};

/// Makes drivers of one kind; what a plugin exports.
class DriverFactory {
 public:
  virtual ~DriverFactory() = default;
  /// \param settings  map of the driver's own settings, may be empty; marks of its nodes are lines
  ///                  and columns of the file that they come from
  /// \param place     name of that file, for messages `place:line:col: error: ...`
  /// \throws Exception naming setting, value and allowed range
  virtual std::unique_ptr<Driver> make(const YAML::Node& settings,
                                       const std::string& place) const = 0;
};

}  // namespace ergotic::tgr
