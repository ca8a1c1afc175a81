// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/energy_detector.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/safety/port_energy.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kForgetS = 1.0;

}  // namespace

EnergyDetector::EnergyDetector(const Rules& rules, double tick_s) noexcept
    : rules_(rules),
      supply_j_(rules.supply_w * tick_s),
      kept_(1.0 - tick_s / kForgetS),
      most_j_(rules.force_limit_n * rules.range_m) {}

ERGOTIC_REALTIME bool EnergyDetector::look(double force, double dx) noexcept {
  way_ += dx;
  energy_ = std::min(energy_ - last_force_ * dx + supply_j_, most_j_);
  const bool fine = energy_ >= -rules_.limit_j;
  // Between the bounds nothing is forgotten; beyond them the distance to the nearer one shrinks.
  const double bound = std::clamp(energy_, 0.0, rules_.cap_j + std::abs(last_force_ * way_));
  energy_ = bound + kept_ * (energy_ - bound);
  const double next = std::clamp(force, -rules_.force_limit_n, rules_.force_limit_n);
  if (next * last_force_ <= 0.0) {
    way_ = anew_ && next != 0.0 ? -std::copysign(PortEnergy::kUnknownWayM, next) : 0.0;
  }
  last_force_ = next;
  if (anew_) {
    anew_ = false;
    energy_ = std::max(-last_force_ * way_, 0.0);
    return true;
  }
  return fine;
}

ERGOTIC_REALTIME void EnergyDetector::forget() noexcept {
  energy_ = 0.0;
  last_force_ = 0.0;
  way_ = 0.0;
  anew_ = false;
}

}  // namespace ergotic::tgr
