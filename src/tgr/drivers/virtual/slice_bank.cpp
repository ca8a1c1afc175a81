// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/slice_bank.hpp"

#include <cmath>
#include <limits>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

int checkedSlices(int slices) {
  requireWithin("slices", slices, 1, kMaxSlices, "");
  return slices;
}

}  // namespace

SliceBank::SliceBank(const SliceBankConfig& config)
    : config_(config),
      gesture_(readTargetGesture(config.gesture_file, checkedSlices(config.slices))) {
  constexpr double kAnyStepS = 1e-3;  // so that bad settings show here
  start(kAnyStepS);
}

void SliceBank::start(double step_s) {
  step_s_ = step_s;
  steps_ = 0;
  set_targets_.fill(std::numeric_limits<double>::quiet_NaN());
  slices_.clear();
  for (int i = 0; i < config_.slices; ++i) {
    constexpr std::uint64_t kStream = 0xd1342543de82ef95U;  // odd: every slice another sequence
    slices_.emplace_back(config_.slice, step_s,
                         (config_.seed << 8U | static_cast<std::uint64_t>(i)) * kStream);
  }
}

ERGOTIC_REALTIME void SliceBank::setTarget(int slice, double target_m) noexcept {
  set_targets_[static_cast<std::size_t>(slice)] = target_m;
}

ERGOTIC_REALTIME void SliceBank::step(const double* forces) noexcept {
  const double t_s = static_cast<double>(steps_) * step_s_;
  ++steps_;
  for (int i = 0; i < config_.slices; ++i) {
    const double set = set_targets_[static_cast<std::size_t>(i)];
    const HandTarget target = std::isnan(set) ? gesture_.at(i, t_s) : HandTarget{set, 0.0};
    slices_[static_cast<std::size_t>(i)].step(forces[i], target);
  }
}

ERGOTIC_REALTIME void SliceBank::read(double* positions) noexcept {
  for (VirtualSlice& slice : slices_) {
    *positions++ = slice.read();
  }
}

}  // namespace ergotic::tgr
