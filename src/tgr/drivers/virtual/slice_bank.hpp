// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tgr/drivers/virtual/player_hands.hpp"
#include "tgr/drivers/virtual/target_gesture.hpp"
#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::tgr {

/// All slices of a virtual device, stepped together. Thread: one.
/// Realtime: yes, all but the constructor and `start`.
class SliceBank {
 public:
  /// Reads all settings but those of delay and shared memory.
  /// \throws TextError from the gesture file, Exception if a setting is outside its range
  explicit SliceBank(const VirtualDriverConfig& config);

  /// Returns to rest at 0, time 0, first noise sample; no player holds anything.
  /// \param step_s        time that `step` moves on. \throws Exception if it is outside its range
  /// \param tick_rate_hz  tick rate of a gesture of positions that has no rate of its own
  void start(double step_s, double tick_rate_hz);

  /// Time for which the gesture has been played, s.
  double gestureTime() const noexcept {
    return static_cast<double>(steps_ - gesture_begins_) * step_s_;
  }

  /// Restarts the gesture with the next step; it controls all slices again.
  void restartGesture() noexcept;

  /// A player's hand takes the slice from the gesture. \return false if the move is not valid
  bool take(const HandMove& move) noexcept;

  /// Saturated force request to an actuator that gets `force`, N, or volts if `isRaw`.
  double newtons(int slice, double force) const noexcept;

  /// \param forces  [slices] N, held over the step
  void step(const double* forces) noexcept;

  /// \param[out] positions  [slices] m, as the sensors say; V if `isRaw`
  void read(double* positions) noexcept;

  bool isRaw() const noexcept { return configs_.front().volts.has_value(); }
  double damping() const noexcept;  ///< the least of all slices, N s/m
  double delay() const noexcept;    ///< the longest of all actuators, s
  int slices() const noexcept { return static_cast<int>(configs_.size()); }

 private:
  double now() const noexcept { return static_cast<double>(steps_) * step_s_; }
  HandTarget handAt(int slice) noexcept;

  std::vector<VirtualSliceConfig> configs_;  // [slices]
  std::uint64_t seed_;
  double gesture_rate_;
  TargetGesture gesture_;
  std::vector<VirtualSlice> slices_;
  PlayerHands players_;
  double step_s_ = 0.0;
  std::int64_t steps_ = 0;           // since the start
  std::int64_t gesture_begins_ = 0;  // step
};

}  // namespace ergotic::tgr
