// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/slice_bank.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

std::vector<VirtualSliceConfig> sliceConfigs(const VirtualDriverConfig& config) {
  requireWithin("slices", config.slices, 1, kMaxSlices, "");
  std::vector<VirtualSliceConfig> slices(static_cast<std::size_t>(config.slices), config.slice);
  for (const auto& [slice, other] : config.others) {
    requireWithin("slice of others", slice, 0, config.slices - 1, "");
    slices[static_cast<std::size_t>(slice)] = other;
  }
  const bool is_raw = slices.front().volts.has_value();
  for (const VirtualSliceConfig& slice : slices) {
    if (slice.volts.has_value() != is_raw) {
      throw Exception("some slices of a virtual device have volts, allowed: all of them or none");
    }
  }
  return slices;
}

}  // namespace

SliceBank::SliceBank(const VirtualDriverConfig& config)
    : configs_(sliceConfigs(config)),
      seed_(config.seed),
      gesture_rate_(config.gesture_rate),
      gesture_(readTargetGesture(config.gesture_file, slices())) {
  constexpr double kAnyStepS = 1e-3;  // so that bad settings show here
  start(kAnyStepS, 1.0 / kAnyStepS);
}

void SliceBank::start(double step_s, double tick_rate_hz) {
  step_s_ = step_s;
  steps_ = 0;
  gesture_.setTickRate(gesture_rate_ > 0.0 ? gesture_rate_ : tick_rate_hz);
  gesture_begins_ = 0;
  players_.clear();
  slices_.clear();
  for (const VirtualSliceConfig& config : configs_) {
    constexpr std::uint64_t kStream = 0xd1342543de82ef95U;  // odd: every slice another sequence
    slices_.emplace_back(config, step_s, (seed_ << 8U | slices_.size()) * kStream);
  }
}

ERGOTIC_REALTIME void SliceBank::restartGesture() noexcept {
  gesture_begins_ = steps_;
  players_.clear();
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    slices_[i].hold(holdOf(HandGrip::kConfigured, configs_[i]));
  }
}

ERGOTIC_REALTIME bool SliceBank::take(const HandMove& move) noexcept {
  if (!move.isValid(slices())) {
    return false;
  }
  players_.take(move, now());
  return true;
}

ERGOTIC_REALTIME double SliceBank::newtons(int slice, double force) const noexcept {
  const VirtualSliceConfig& config = configs_[static_cast<std::size_t>(slice)];
  if (!config.volts) {
    return saturated(force, config.force_limit);
  }
  const SliceCalibration& c = *config.volts;
  const double volts = saturated(force, c.max_volts);
  return saturated((volts - c.zero_volts) / c.volts_per_newton, config.force_limit);
}

ERGOTIC_REALTIME void SliceBank::step(const double* forces) noexcept {
  for (int i = 0; i < slices(); ++i) {
    const HandTarget target = handAt(i);
    slices_[static_cast<std::size_t>(i)].step(forces[i], target);
  }
  ++steps_;
}

ERGOTIC_REALTIME HandTarget SliceBank::handAt(int slice) noexcept {
  if (!players_.owns(slice)) {
    return gesture_.at(slice, gestureTime());
  }
  VirtualSlice& held = slices_[static_cast<std::size_t>(slice)];
  const PlayerHands::Holding hand =
      players_.step(slice, {held.position(), held.velocity()}, now(), step_s_);
  const VirtualSliceConfig& config = configs_[static_cast<std::size_t>(slice)];
  HandHold hold = holdOf(hand.grip, config);
  hold.stiffness *= hand.strength;
  hold.damping *= hand.strength;
  held.hold(hold);
  HandTarget target = hand.target;
  if (hand.acceleration != 0.0) {
    target.push = hand.strength * ((config.mass + config.hand_mass) * hand.acceleration +
                                   config.damping * target.velocity);
  }
  return target;
}

ERGOTIC_REALTIME void SliceBank::read(double* positions) noexcept {
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    positions[i] = slices_[i].read();
    if (const auto& volts = configs_[i].volts) {
      positions[i] = std::clamp(volts->rest_volts + positions[i] / volts->metres_per_volt,
                                volts->low_volts, volts->high_volts);
    }
  }
}

double SliceBank::damping() const noexcept {
  double least = configs_.front().damping;
  for (const VirtualSliceConfig& config : configs_) {
    least = std::min(least, config.damping);
  }
  return least;
}

double SliceBank::delay() const noexcept {
  double longest = 0.0;
  for (const VirtualSliceConfig& config : configs_) {
    longest = std::max(longest, config.delay);
  }
  return longest;
}

}  // namespace ergotic::tgr
