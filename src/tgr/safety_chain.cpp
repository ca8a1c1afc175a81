// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety_chain.hpp"

#include <algorithm>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

const SafetyConfig& checked(const SafetyConfig& c) {
  requireWithin("force_limit", c.force_limit_n, 0.0, kAbsoluteForceLimitN, "N");
  requireWithin("slew", c.slew_n_per_s, 10.0, 1e6, "N/s");
  requireWithin("ramp", c.ramp_s, 0.1, 10.0, "s");
  requireWithin("resume_ramp", c.resume_ramp_s, 0.005, 10.0, "s");
  requireWithin("raw_force_limit", c.raw_force_limit_n, 1.0, 1e6, "N");
  requireWithin("position_limit", c.position_limit_m, 0.001, 1.0, "m");
  requireWithin("max_speed", c.max_speed_m_per_s, 0.1, 100.0, "m/s");
  requireWithin("max_missing", c.max_missing, 0, 1000, "ticks");
  if (c.frozen_s != 0.0) {
    requireWithin("frozen (or 0)", c.frozen_s, 0.001, 10.0, "s");
  }
  requireWithin("energy_limit", c.energy_limit_j, 0.001, 100.0, "J");
  requireWithin("energy_cap", c.energy_cap_j, 0.001, 10.0, "J");
  requireWithin("energy_supply", c.energy_supply_w, 0.0, 20.0, "W");
  requireWithin("slice_damping", c.slice_damping, 0.0, 100.0, "N s/m");
  requireWithin("slice_mass", c.slice_mass_kg, 0.01, 100.0, "kg");
  return c;
}

std::vector<SliceChain> makeSlices(const SafetyConfig& config,
                                   int slices,
                                   double tick_s,
                                   int extra_delay_ticks) {
  requireWithin("slices", slices, 1, kMaxSlices, "");
  requireWithin("tick", tick_s, 1e-6, 0.1, "s");
  requireWithin("extra_delay", extra_delay_ticks, 0, PortEnergy::kMaxDelayTicks - 1, "ticks");
  return {static_cast<std::size_t>(slices), SliceChain(config, tick_s, 1 + extra_delay_ticks)};
}

}  // namespace

SafetyChain::SafetyChain(const SafetyConfig& config,
                         int slices,
                         double tick_s,
                         int extra_delay_ticks)
    : gate_(checked(config).ramp_s, config.resume_ramp_s, tick_s),
      missing_(config.max_missing),
      slices_(makeSlices(config, slices, tick_s, extra_delay_ticks)),
      in_use_(all()) {}

ERGOTIC_REALTIME std::uint64_t SafetyChain::all() const noexcept {
  return ~std::uint64_t{0} >> (static_cast<std::size_t>(kMaxSlices) - slices_.size());
}

ERGOTIC_REALTIME void SafetyChain::engage() noexcept {
  if (gate_.isOpen() || fault_ != FaultReason::kNone) {
    return;
  }
  gate_.open();
  for (SliceChain& slice : slices_) {
    slice.engage();
  }
}

ERGOTIC_REALTIME void SafetyChain::disengage() noexcept {
  gate_.close();
}

ERGOTIC_REALTIME void SafetyChain::resume() noexcept {
  gate_.resume();
  for (SliceChain& slice : slices_) {
    slice.resume();
  }
}

ERGOTIC_REALTIME void SafetyChain::recover() noexcept {
  gate_.close();
  missing_.cameAgain();
  for (SliceChain& slice : slices_) {
    slice.recover();
  }
  fault_ = FaultReason::kNone;
  fault_slice_ = -1;
}

ERGOTIC_REALTIME void SafetyChain::setInUse(std::uint64_t slices) noexcept {
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    const bool is_new = (slices >> i & 1U) != 0 && !isInUse(i);
    if (is_new) {
      slices_[i].forget();
    }
  }
  in_use_ = slices & all();
}

ERGOTIC_REALTIME void SafetyChain::raise(FaultReason fault, int slice) noexcept {
  gate_.close();
  if (fault_ == FaultReason::kNone) {  // the first cause is the one to tell
    fault_ = fault;
    fault_slice_ = slice;
  }
}

/// Faults of the device as a whole. \return true if there are fresh positions
ERGOTIC_REALTIME bool SafetyChain::hasSample(std::uint32_t flags) noexcept {
  if ((flags & kDeviceLost) != 0) {
    raise(FaultReason::kDeviceLost, -1);
    return false;
  }
  if ((flags & kWriteFailed) != 0) {
    raise(FaultReason::kWriteFailed, -1);
  }
  if ((flags & kMissingSample) == 0) {
    missing_.cameAgain();
    return true;
  }
  if (!missing_.miss()) {
    raise(FaultReason::kMissingSamples, -1);
  }
  return false;
}

ERGOTIC_REALTIME std::uint64_t SafetyChain::validate(double* positions,
                                                     std::uint32_t flags,
                                                     std::int64_t host_missed) noexcept {
  if (!has_limited_) {
    for (SliceChain& slice : slices_) {
      slice.release();
    }
  }
  has_limited_ = false;
  const std::int64_t ticks = 1 + std::max<std::int64_t>(host_missed, 0);
  if (!hasSample(flags)) {
    for (SliceChain& slice : slices_) {
      slice.hold(*positions++, ticks);
    }
    return all();
  }
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    const double came = positions[i];
    const FaultReason reason = slices_[i].accept(positions[i], ticks);
    held |= std::uint64_t{positions[i] != came} << i;  // also true for what is not a number
    if (reason != FaultReason::kNone && isInUse(i)) {
      raise(reason, static_cast<int>(i));
    }
  }
  return held;
}

ERGOTIC_REALTIME void SafetyChain::limit(double* forces, double fade) noexcept {
  has_limited_ = true;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    if (!isInUse(i)) {
      continue;
    }
    const FaultReason reason = slices_[i].inspect(forces[i], gate_.isOpen());
    if (reason != FaultReason::kNone) {
      raise(reason, static_cast<int>(i));
    }
  }
  const bool open = gate_.isOpen();
  const double gain = open ? fade * gate_.next() : 0.0;
  muted_slice_ = -1;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    if (open && isInUse(i)) {
      forces[i] = slices_[i].limited(forces[i], gain);
      muted_slice_ = slices_[i].justMuted() ? static_cast<int>(i) : muted_slice_;
    } else {
      slices_[i].release();
      forces[i] = 0.0;
    }
  }
}

}  // namespace ergotic::tgr
