// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/energy_detector.hpp"

#include <algorithm>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kForgetS = 1.0;

}  // namespace

EnergyDetector::EnergyDetector(const Rules& rules, double tick_s) noexcept
    : rules_(rules), supply_j_(rules.supply_w * tick_s), kept_(1.0 - tick_s / kForgetS) {}

ERGOTIC_REALTIME bool EnergyDetector::look(double force, double dx) noexcept {
  energy_ = std::min(energy_ - last_force_ * dx + supply_j_, rules_.cap_j);
  last_force_ = std::clamp(force, -rules_.force_limit_n, rules_.force_limit_n);
  const bool fine = energy_ >= -rules_.limit_j;
  if (energy_ < 0.0) {
    energy_ *= kept_;
  }
  return fine;
}

ERGOTIC_REALTIME void EnergyDetector::forget() noexcept {
  energy_ = 0.0;
  last_force_ = 0.0;
}

}  // namespace ergotic::tgr
