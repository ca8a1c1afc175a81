// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/tanks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "at.hpp"
#include "ergotic/rt/realtime.hpp"
#include "physics/kernels/tank_kernels.hpp"

namespace ergotic::physics {
namespace {

constexpr double kClipped = 0.99;  // share of what psi asks for, from which on a step counts

/// Part of the most that a tank has held that rounding may take from it in a performance: what is
/// missing then is no cut. Forces are rounded by half an epsilon, at random, in 10^6 steps.
template <class Real>
constexpr double kRounding = 1000.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());

}  // namespace

template <class Real>
Tanks<Real>::Tanks(const Layout& layout,
                   const std::vector<EnergyStableGroup>& groups,
                   State<Real>& state)
    : layout_(layout) {
  for (const EnergyStableGroup& group : groups) {
    bodies_.emplace_back();
    for (const std::size_t r : group.tanks) {
      Body body;
      body.run = r;
      int last = 0;
      body.first = layout.slots();
      for (const LinkEnds& ends : layout.runs[r].ends) {
        body.first = std::min({body.first, ends.a, ends.b});
        last = std::max({last, ends.a, ends.b});
      }
      body.count = last + 1 - body.first;
      for (const LinkEnds& ends : layout.runs[r].ends) {
        body.modules.push_back(static_cast<std::uint32_t>(ends.a - body.first));
        body.modules.push_back(static_cast<std::uint32_t>(ends.b - body.first));
      }
      std::sort(body.modules.begin(), body.modules.end());
      body.modules.erase(std::unique(body.modules.begin(), body.modules.end()), body.modules.end());
      body.is_lone = group.links.empty();
      body.slope.resize(at(body.count));
      const std::string name = "tank" + std::to_string(r);
      body.state_at = state.arena().template add<TankState>(name, 1);
      body.force_at = state.arena().template add<Real>(name + ".force", at(body.count));
      bodies_.back().push_back(std::move(body));
    }
  }
}

/// Computes psi and its gradient. The potential is psi^2/2 for both kinds of links: psi = (sum Q
/// e^2)/sqrt(2 sum Q) by the mean, otherwise psi = sqrt(sum Q e^4/2).
template <class Real>
void Tanks<Real>::measure(Body& body,
                          const RunCoefficients<Real>& c,
                          const Real* x,
                          double& psi) noexcept {
  const LinkRun& run = layout_.runs[body.run];
  const kernels::TankLinks<Real> links{run.spans.data(), run.spans.size(), run.ends.data(),
                                       c.fields.data() + 2 * run.ends.size(),
                                       c.fields.data() + 3 * run.ends.size()};
  for (const std::size_t i : body.modules) {
    body.slope[i] = Real(0);
  }
  const kernels::TankSums sums =
      run.is_mean ? kernels::addMeanSlopes(links, x, body.slope.data() - body.first)
                  : kernels::addCubicSlopes(links, x, body.slope.data() - body.first);
  if (run.is_mean) {
    const double scale = sums.weight > 0.0 ? 1.0 / std::sqrt(2.0 * sums.weight) : 0.0;
    psi = scale * sums.energy;
    body.per_slope = 2.0 * scale;
  } else {
    psi = std::sqrt(0.5 * sums.energy);
    body.per_slope = psi > 0.0 ? 1.0 / psi : 0.0;
  }
}

template <class Real>
void Tanks<Real>::addForce(Body& body, double psi, State<Real>& state) const noexcept {
  const Real scale = static_cast<Real>(body.per_slope * psi);
  kernels::addForces(body.modules, body.slope.data(), scale, state.f() + body.first,
                     state.arena().template at<Real>(body.force_at));
}

template <class Real>
ERGOTIC_REALTIME void Tanks<Real>::start(std::size_t group,
                                         const CoefficientsOf<Real>& c,
                                         State<Real>& state) noexcept {
  for (Body& body : bodies_[group]) {
    double psi = 0.0;
    measure(body, c.runs[body.run], state.x(), psi);
    double now = 0.0;
    for (int i = 0; i < body.count; ++i) {
      now +=
          static_cast<double>(body.slope[at(i)]) * static_cast<double>(state.d()[body.first + i]);
    }
    const double asked = psi - 0.5 * body.per_slope * now;
    TankState& tank = stateOf(body, state);
    tank.stored = 0.5 * asked * asked;
    tank.most = tank.stored;
    if (state.isMetered()) {
      state.work()[body.run].stored = tank.stored;
    }
  }
}

/// Exerts the force -(psi_ + psi+)/2 grad psi, with psi_ = psi - grad psi d/2 half a step ago and
/// psi+ half a step ahead; it changes the tank by (psi+^2 - psi_^2)/2, exactly.
template <class Real>
ERGOTIC_REALTIME void Tanks<Real>::exert(std::size_t group,
                                         const CoefficientsOf<Real>& c,
                                         State<Real>& state) noexcept {
  for (Body& body : bodies_[group]) {
    TankState& tank = stateOf(body, state);
    double psi = 0.0;
    measure(body, c.runs[body.run], state.x(), psi);
    const kernels::TankModules<Real> modules{state.x() + body.first,
                                             state.d() + body.first,
                                             state.f() + body.first,
                                             c.masses.inverse_mass.data() + body.first,
                                             c.masses.drift.data() + body.first,
                                             c.masses.lose.data() + body.first,
                                             c.masses.pull.data() + body.first,
                                             body.modules.data(),
                                             body.modules.size()};
    Real* const last_force = state.arena().template at<Real>(body.force_at);
    const kernels::TankSteps steps = kernels::measureSteps(modules, body.slope.data(), last_force);
    body.half = 0.5 * body.per_slope * steps.now;
    const double asked = psi - body.half;
    const double held = std::max(0.0, tank.stored + 0.5 * steps.worked);
    const double most = std::sqrt(2.0 * held);
    const double before = std::clamp(asked, -most, most);
    body.give = 0.25 * body.per_slope * body.per_slope * steps.give;
    body.mean = (before + 0.5 * body.half + 0.25 * body.per_slope * steps.next) / (1.0 + body.give);
    tank.active += psi > 0.0 ? 1.0 : 0.0;
    const bool is_cut = std::abs(before) < kClipped * std::abs(asked) &&
                        0.5 * asked * asked > kRounding<Real> * tank.most;
    tank.clipped += is_cut ? 1.0 : 0.0;
    tank.stored = held + body.mean * body.half;
    tank.most = std::max(tank.most, tank.stored);
    for (const std::size_t i : body.modules) {
      last_force[i] = Real(0);
    }
    addForce(body, body.mean, state);
    body.push = body.is_lone ? 0.0 : kernels::pushOn(modules, body.slope.data());
    if (state.isMetered()) {
      state.work()[body.run].stored = tank.stored;
    }
  }
}

/// Others took the tank's force for given. That they give way to one another by the tank, too,
/// makes all masses heavier along grad psi only, so nothing they were charged for was too little.
template <class Real>
ERGOTIC_REALTIME void Tanks<Real>::answer(std::size_t group,
                                          const CoefficientsOf<Real>& c,
                                          State<Real>& state) noexcept {
  for (Body& body : bodies_[group]) {
    if (body.is_lone) {
      continue;
    }
    kernels::TankModules<Real> modules{};
    modules.f = state.f() + body.first;
    modules.inverse_mass = c.masses.inverse_mass.data() + body.first;
    modules.indices = body.modules.data();
    modules.count = body.modules.size();
    const double added = kernels::pushOn(modules, body.slope.data()) - body.push;
    const double psi = 0.25 * body.per_slope * added / (1.0 + body.give);
    if (psi != 0.0) {
      TankState& tank = stateOf(body, state);
      tank.stored += psi * body.half;
      addForce(body, psi, state);
      if (state.isMetered()) {
        state.work()[body.run].stored = tank.stored;
      }
    }
  }
}

template <class Real>
ERGOTIC_REALTIME void Tanks<Real>::retune(const CoefficientsOf<Real>& from,
                                          const CoefficientsOf<Real>& to,
                                          State<Real>& state) noexcept {
  for (std::vector<Body>& group : bodies_) {
    for (Body& body : group) {
      double before = 0.0;
      double after = 0.0;
      measure(body, from.runs[body.run], state.x(), before);
      measure(body, to.runs[body.run], state.x(), after);
      TankState& tank = stateOf(body, state);
      tank.stored += 0.5 * (after * after - before * before);
      if (state.isMetered()) {
        state.work()[body.run].stored = tank.stored;
      }
    }
  }
}

template <class Real>
ERGOTIC_REALTIME bool Tanks<Real>::areFinite(const State<Real>& state) const noexcept {
  return std::all_of(bodies_.begin(), bodies_.end(), [&state](const std::vector<Body>& group) {
    return std::all_of(group.begin(), group.end(), [&state](const Body& body) {
      return std::isfinite(state.arena().template at<TankState>(body.state_at)->stored);
    });
  });
}

template <class Real>
void Tanks<Real>::addReports(std::vector<TankReport>& to) const {
  for (const std::vector<Body>& group : bodies_) {
    for (const Body& body : group) {
      to.push_back({layout_.runs[body.run].lias.front(), 0, 0});
    }
  }
}

template <class Real>
ERGOTIC_REALTIME void Tanks<Real>::read(const State<Real>& state, TankReport* to) const noexcept {
  for (const std::vector<Body>& group : bodies_) {
    for (const Body& body : group) {
      const auto& tank = *state.arena().template at<TankState>(body.state_at);
      to->active = wholeOf(tank.active);
      to->clipped = wholeOf(tank.clipped);
      ++to;
    }
  }
}

template class Tanks<float>;
template class Tanks<double>;

}  // namespace ergotic::physics
