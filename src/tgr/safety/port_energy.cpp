// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/port_energy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

PortEnergy::PortEnergy(const Rules& rules)
    : cap_j_(rules.cap_j),
      supply_j_(rules.supply_w * rules.tick_s),
      damping_j_(rules.damping / rules.tick_s),
      loop_ticks_(0.5 + rules.delay_ticks),
      kept_(std::exp(-rules.tick_s / kMemoryS)),
      under_way_(static_cast<std::size_t>(rules.delay_ticks) + 1) {}

ERGOTIC_REALTIME void PortEnergy::moved(double dx, std::int64_t ticks) noexcept {
  const double acted = under_way_[(newest_ + 1) % under_way_.size()];
  const auto passed = static_cast<double>(ticks);
  dx_ = dx;
  own_j_ = damping_j_ * dx * dx / passed;
  const double taken = acted != 0.0 && pays() ? own_j_ : 0.0;
  way_ += dx;
  const double most = cap_j_ + std::abs(wanted_ * way_);
  energy_ = std::min(energy_ - acted * dx + taken + supply_j_ * passed, most);
  least_ = std::min(least_, energy_);
}

ERGOTIC_REALTIME double PortEnergy::predicted(double dx) const noexcept {
  const double oldest = under_way_[(newest_ + 1) % under_way_.size()];
  const double sum = std::accumulate(under_way_.begin(), under_way_.end(), 0.0) - oldest;
  return energy_ - sum * dx;
}

ERGOTIC_REALTIME void PortEnergy::follow(double force) noexcept {
  if (force * wanted_ <= 0.0) {
    way_ = is_lost_ && force != 0.0 ? -std::copysign(kUnknownWayM, force) : 0.0;
  } else {  // in contact
    sampling_j_ = kept_ * sampling_j_ + loop_ticks_ * (wanted_ - force) * dx_;
    damped_j_ = kept_ * damped_j_ + own_j_;
  }
  wanted_ = force;
  is_lost_ = false;
}

ERGOTIC_REALTIME void PortEnergy::lift(double gain_change) noexcept {
  const double stored = 0.5 * std::max(-wanted_ * way_, 0.0);
  const double least = std::min(energy_, 0.0);
  energy_ = std::max(energy_ + gain_change * stored, least);
}

ERGOTIC_REALTIME void PortEnergy::issue(double force) noexcept {
  newest_ = (newest_ + 1) % under_way_.size();
  under_way_[newest_] = force;
}

ERGOTIC_REALTIME void PortEnergy::forget() noexcept {
  std::fill(under_way_.begin(), under_way_.end(), 0.0);
  energy_ = 0.0;
  least_ = 0.0;
  sampling_j_ = 0.0;
  damped_j_ = 0.0;
}

}  // namespace ergotic::tgr
