// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tgr/drivers/virtual/target_gesture.hpp"
#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::tgr {

/// What a bank of virtual slices is made of.
struct SliceBankConfig {
  int slices = 12;
  VirtualSliceConfig slice;
  std::string gesture_file;  ///< empty: hands rest at 0
  std::uint64_t seed = 1;    ///< of the sensor noise; each slice has its own sequence
};

/// All slices of a virtual device, stepped together. One thread, whoever steps it.
/// Realtime: yes, all but the constructor and `start`.
class SliceBank {
 public:
  /// \throws TextError from the gesture file, Exception if a setting is outside its range
  explicit SliceBank(const SliceBankConfig& config);

  /// Back to rest at 0, time 0, first noise sample; forgets the targets that were set.
  /// \param step_s  time that `step` moves on. \throws Exception if it is outside its range
  void start(double step_s);

  /// The gesture begins anew with the next step.
  void restartGesture() noexcept { steps_ = 0; }

  /// A hand's target in place of the gesture's, m; NaN gives the slice back to the gesture.
  void setTarget(int slice, double target_m) noexcept;

  /// \param forces  [slices] N, held over the step
  void step(const double* forces) noexcept;

  /// \param[out] positions  [slices] m, as the sensors say
  void read(double* positions) noexcept;

  int slices() const noexcept { return config_.slices; }

 private:
  SliceBankConfig config_;
  TargetGesture gesture_;
  std::vector<VirtualSlice> slices_;
  std::array<double, kMaxSlices> set_targets_{};  // NaN: the gesture's
  double step_s_ = 0.0;
  std::int64_t steps_ = 0;  // of the gesture
};

}  // namespace ergotic::tgr
