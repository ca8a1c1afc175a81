// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/slice_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kStillS = 0.009;
constexpr double kWorth = 0.05;         // of the limit: what comes back from less is no kick
constexpr std::int64_t kMinStill = 20;  // samples: fewer may be the same by chance

std::int64_t ticksOf(double seconds, double tick_s) {
  return static_cast<std::int64_t>(std::ceil(seconds / tick_s));
}

PositionCheck::Rules positionRules(const SafetyConfig& config, double tick_s) {
  PositionCheck::Rules rules;
  rules.limit_m = config.position_limit_m;
  rules.max_step_m = config.max_speed_m_per_s * tick_s;
  if (config.frozen_s > 0.0) {
    rules.frozen_ticks = ticksOf(config.frozen_s, tick_s);
    rules.still_ticks = std::max(ticksOf(kStillS, tick_s), kMinStill);
  }
  return rules;
}

EnergyDetector::Rules energyRules(const SafetyConfig& config) {
  EnergyDetector::Rules rules;
  rules.force_limit_n = config.force_limit_n;
  rules.range_m = config.position_limit_m;
  rules.limit_j = config.energy_limit_j;
  rules.cap_j = config.energy_cap_j;
  rules.supply_w = config.energy_supply_w;
  return rules;
}

}  // namespace

SliceChain::SliceChain(const SafetyConfig& config, double tick_s, int delay_ticks)
    : position_(positionRules(config, tick_s)),
      blow_up_(config.force_limit_n, config.raw_force_limit_n),
      detector_(energyRules(config), tick_s),
      controller_(config.slice_mass_kg, tick_s),
      controls_(config.passivity_controller),
      slew_(config.slew_n_per_s * tick_s),
      force_limit_(config.force_limit_n),
      port_(
          {config.energy_cap_j, config.energy_supply_w, config.slice_damping, tick_s, delay_ticks}),
      trust_step_(tick_s / config.resume_ramp_s),
      least_kick_(kWorth * config.force_limit_n) {
  port_.loseTrack();
}

ERGOTIC_REALTIME FaultReason SliceChain::accept(double& x, std::int64_t ticks) noexcept {
  const FaultReason reason = position_.accept(x, ticks);
  moved(x, ticks);
  return reason;
}

ERGOTIC_REALTIME void SliceChain::hold(double& x, std::int64_t ticks) noexcept {
  position_.hold(x, ticks);
  moved(x, ticks);
}

ERGOTIC_REALTIME void SliceChain::moved(double x, std::int64_t ticks) noexcept {
  dx_ = knows_x_ ? x - x_ : 0.0;
  knows_x_ = true;
  x_ = x;
  way_ += dx_;
  port_.moved(dx_, ticks);
}

ERGOTIC_REALTIME FaultReason SliceChain::inspect(double raw, bool open) noexcept {
  FaultReason reason = blow_up_.look(raw);
  if (std::isfinite(raw)) {
    peak_raw_ = std::max(peak_raw_, std::abs(raw));
    port_.follow(force_limit_.limited(raw));
    if (!open) {  // a force that nobody feels may do what it likes
      reason = FaultReason::kNone;
      blow_up_.forget();
      detector_.restart();
    }
    const bool fine = detector_.look(raw, way_);
    way_ = 0.0;
    if (!fine && reason == FaultReason::kNone) {
      return FaultReason::kEnergy;
    }
  }
  return reason;
}

/// A sensor that may be frozen gives no force until it moves; then force comes back by a ramp.
ERGOTIC_REALTIME double SliceChain::trust() noexcept {
  just_muted_ = false;
  if (position_.isStill()) {
    just_muted_ = trust_ > 0.0 && std::abs(port_.issued()) > least_kick_;
    trust_ = 0.0;
    ++muted_ticks_;
    return trust_;
  }
  return std::exchange(trust_, std::min(1.0, trust_ + trust_step_));
}

ERGOTIC_REALTIME double SliceChain::limited(double raw, double gain) noexcept {
  turnTo(trust() * gain);
  double wanted = gain_ * raw;
  if (controls_) {
    wanted = controller_.damped(wanted, dx_, port_.energy());
  }
  const double limited = force_limit_.limited(slew_.limited(wanted, port_.issued()));
  const double force = EnergyClamp::limited(limited, dx_, port_.predicted(dx_));
  clamped_ticks_ += force != limited ? 1 : 0;
  port_.issue(force);
  return force;
}

ERGOTIC_REALTIME void SliceChain::turnTo(double gain) noexcept {
  port_.lift(gain - gain_);
  gain_ = gain;
}

ERGOTIC_REALTIME void SliceChain::release() noexcept {
  turnTo(0.0);
  port_.issue(0.0);
}

ERGOTIC_REALTIME void SliceChain::engage() noexcept {
  port_.restart();
  gain_ = 0.0;
}

ERGOTIC_REALTIME void SliceChain::resume() noexcept {
  turnTo(0.0);
  port_.withdraw();
  port_.loseTrack();
  blow_up_.forget();
  detector_.restart();
}

ERGOTIC_REALTIME void SliceChain::recover() noexcept {
  position_.forget();
  blow_up_.forget();
  detector_.restart();
  port_.forget();
  gain_ = 0.0;
  trust_ = 1.0;
  clamped_ticks_ = 0;
  muted_ticks_ = 0;
  peak_raw_ = 0.0;
}

ERGOTIC_REALTIME void SliceChain::forget() noexcept {
  recover();
  detector_.forget();
  port_.follow(0.0);
  port_.loseTrack();
  knows_x_ = false;
  dx_ = 0.0;
  way_ = 0.0;
}

ERGOTIC_REALTIME SliceReading SliceChain::reading() const noexcept {
  return {port_.energy(), port_.least(), clamped_ticks_, muted_ticks_, peak_raw_};
}

}  // namespace ergotic::tgr
