// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/energy_stable_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "at.hpp"

namespace ergotic::physics {
template <class Real>
EnergyStableRuns<Real>::EnergyStableRuns(const scene::Scene& scene,
                                         const Layout& layout,
                                         const Groups& groups,
                                         const Points<Real>& points,
                                         State<Real>& state)
    : layout_(layout),
      points_(points),
      ahead_(layout.taps.empty() ? 0 : at(layout.slots())),
      members_(energyStableGroupsOf(layout)),
      reach_(scene, layout, members_),
      pressures_(layout, members_),
      modules_(members_.empty() ? 0 : at(layout.slots())),
      tanks_(layout, members_, state),
      forces_(members_.empty() ? 0 : at(layout.slots()), Real(0)) {
  for (const EnergyStableGroup& members : members_) {
    addLinks(scene, members, state);
    reached_.push_back(reachedBy(
        members.group == LinkRun::kHeldGroup ? groups.held : groups.running[at(members.group)]));
  }
}

/// Contacts whose ends come nearer by their own motion only, which falling asleep and places that
/// move are not.
template <class Real>
bool EnergyStableRuns<Real>::mayWait(const scene::Scene& scene, const EnergyStableRef& ref) const {
  const LinkRun& run = layout_.runs[ref.run];
  const auto isAwake = [&](int section) { return scene.sections[at(section)].sleep_energy == 0.0; };
  const auto isThis = [&](const Follower& follower) {
    return follower.run >= 0 && at(follower.run) == ref.run && at(follower.index) == ref.link;
  };
  return scene::lawOf(run.law).kind == scene::Law::Kind::kGap && !reach_.mayBeLed(ref) &&
         isAwake(run.section_a) && isAwake(run.section_b) &&
         std::none_of(layout_.followers.begin(), layout_.followers.end(), isThis);
}

template <class Real>
void EnergyStableRuns<Real>::addLinks(const scene::Scene& scene,
                                      const EnergyStableGroup& members,
                                      State<Real>& state) {
  const std::vector<double> somewhere(2 * layout_.places.size(), 0.0);
  std::vector<EnergyStableLink> links;
  std::vector<OnPlaces> on_places;
  std::vector<std::vector<std::size_t>> taps;
  std::vector<int> slow;
  EnergyStableReach::Terms terms;  // has room for those of any link then
  for (const EnergyStableRef& ref : members.links) {
    const LinkRun& run = layout_.runs[ref.run];
    if (reach_.isOnPlace(ref)) {
      constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
      on_places.push_back(
          {links.size(), reach_.placesOf(ref), {kNowhere, kNowhere, kNowhere, kNowhere}});
    }
    taps.push_back(reach_.tapsAt(ref));
    if (run.slow_section >= 0 && (slow.empty() || slow.back() != run.slow_section)) {
      slow.push_back(run.slow_section);
    }
    reach_.find(ref, somewhere.data(), terms);
    links.push_back(
        {run.dimensions, terms.terms, {}, scene::sticks(run.law), run.share, mayWait(scene, ref)});
    std::copy_n(terms.offset, 3, links.back().offset);
  }
  const std::string name = "energy_stable" + std::to_string(links_.size());
  NearLinks<Real> near(links);
  const std::size_t states_at =
      state.arena().template add<EnergyStableState<Real>>(name, links.size());
  const std::size_t clearances_at =
      near.waiting() == 0 ? 0
                          : state.arena().template add<Real>(name + ".clearances", near.waiting());
  links_.push_back({EnergyStableLinks<Real>(links, modules_), std::move(near), std::move(on_places),
                    taps, std::vector<unsigned char>(links.size(), 0), slow,
                    std::vector<unsigned char>(layout_.sections.size(), 0), states_at,
                    clearances_at, std::move(terms)});
}

/// The ends of energy-stable links, all points, and the modules that points hand their forces to.
/// Taps hand theirs to their modules themselves.
template <class Real>
std::vector<int> EnergyStableRuns<Real>::reachedBy(const Group& group) const {
  std::vector<int> reached;
  const auto add = [&reached](int slot, int stride, int count) {
    for (int k = 0; k < count; ++k) {
      reached.push_back(slot + k * stride);
    }
  };
  for (const std::size_t g : group.energy_stable) {
    for (const EnergyStableRef& ref : members_[g].links) {
      const LinkRun& run = layout_.runs[ref.run];
      const LinkEnds& ends = run.ends[ref.link];
      add(ends.a, run.stride_a, std::max(1, run.dimensions));
      add(ends.b, run.stride_b, std::max(1, run.dimensions));
    }
  }
  for (const std::size_t p : group.projections) {
    const ProjectedPoint& point = layout_.projections[p];
    add(point.slot, 1, point.dimensions);
    add(point.of.slot, point.of.stride, point.source_dimensions);
  }
  for (const std::size_t p : group.places) {
    const PlacePoint& point = layout_.places[p];
    add(point.slot, 1, point.dimensions);
    for (const int slot : reach_.slotsUnder(p)) {
      add(slot, point.stride, point.dimensions);
    }
  }
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  return reached;
}

/// \pre forces of everything else are on the modules, and the near links are found
template <class Real>
void EnergyStableRuns<Real>::lookAhead(std::size_t g,
                                       const CoefficientsOf<Real>& c,
                                       const State<Real>& state) noexcept {
  for (const std::size_t l : links_[g].near) {
    for (const std::size_t t : links_[g].taps[l]) {
      for (int k = 0; k < layout_.taps[t].dimensions; ++k) {
        ahead_[at(layout_.taps[t].slot + k)] =
            points_.taps().stepAhead(t, k, c.masses, state.x(), state.d(), state.f());
      }
    }
  }
}

template <class Real>
EnergyStableView<Real> EnergyStableRuns<Real>::viewOf(const Links& links,
                                                      const CoefficientsOf<Real>& c,
                                                      State<Real>& state) const noexcept {
  EnergyStableView<Real> view;
  view.x = state.x();
  view.d = state.d();
  view.f = state.f();
  view.inverse_mass = c.masses.inverse_mass.data();
  view.drift = c.masses.drift.data();
  view.lose = c.masses.lose.data();
  view.pull = c.masses.pull.data();
  view.ahead = ahead_.data();
  view.due = links.due.data();
  view.idle = links.idle.data();
  return view;
}

template <class Real>
void EnergyStableRuns<Real>::followPlaces(std::size_t g, State<Real>& state) noexcept {
  EnergyStableReach::Terms& to = links_[g].terms;
  for (OnPlaces& on : links_[g].on_places) {
    std::array<double, 4> here{};
    for (std::size_t end = 0; end < 2; ++end) {
      if (on.places[end] >= 0) {
        std::copy_n(state.places() + 2 * on.places[end], 2, here.begin() + 2 * end);
      }
    }
    if (here != on.found_at) {  // most places stand still
      on.found_at = here;
      reach_.find(members_[g].links[on.link], state.places(), to);
      links_[g].links.setTerms(on.link, to.terms.data(), to.terms.size(), to.offset);
    }
  }
}

template <class Real>
void EnergyStableRuns<Real>::markIdle(std::size_t g, State<Real>& state) noexcept {
  for (const std::size_t l : links_[g].near) {
    const LinkRun& run = layout_.runs[members_[g].links[l].run];
    const bool is_inside = run.section_a == run.section_b;
    links_[g].idle[l] = is_inside ? state.asleep()[run.section_a] : 0;
  }
}

template <class Real>
void EnergyStableRuns<Real>::markDue(std::size_t g, std::int64_t began) noexcept {
  for (const int section : links_[g].slow) {
    links_[g].due[at(section)] = layout_.isDue(section, began) ? 1 : 0;
  }
}

/// Hands the forces to both ends, as explicit links do.
template <class Real>
void EnergyStableRuns<Real>::exchange(std::size_t g,
                                      std::int64_t began,
                                      const Stepper<Real>& stepper,
                                      State<Real>& state) noexcept {
  const EnergyStableState<Real>* all = states(g, state);
  std::size_t last_run = layout_.runs.size();
  kernels::RunStep<Real> frame{};
  for (const std::size_t l : links_[g].near) {
    const EnergyStableRef& ref = members_[g].links[l];
    const LinkRun& run = layout_.runs[ref.run];
    if (links_[g].idle[l] != 0) {
      continue;
    }
    if (ref.run != last_run) {
      frame = stepper.stepOfRun(ref.run, began, state);
      frame.f = forces_.data();
      last_run = ref.run;
    }
    for (int k = 0; k < std::max(1, run.dimensions); ++k) {
      const int a = run.ends[ref.link].a + k * run.stride_a;
      const int b = run.ends[ref.link].b + k * run.stride_b;
      const std::size_t index = at(k) * run.ends.size() + ref.link;
      const Real n = all[l].gradient[k];
      kernels::exchangeForce(run, frame, index, a, b, {n * all[l].force, n * all[l].damper});
      if (frame.slow_ends) {
        kernels::closeMean(run, frame, index, a, b);
      }
    }
  }
}

/// True if a force of a link has still to be counted, or to be felt by a slower end.
template <class Real>
bool EnergyStableRuns<Real>::remembersForce(const EnergyStableRef& ref,
                                            const State<Real>& state) const noexcept {
  const LinkRun& run = layout_.runs[ref.run];
  const LinkMemory<const Real> memory = state.memory(ref.run);
  const auto isAny = [&](const Real* forces) {
    bool is_any = false;
    for (int k = 0; forces != nullptr && k < std::max(1, run.dimensions); ++k) {
      is_any = is_any || forces[at(k) * run.ends.size() + ref.link] != Real(0);
    }
    return is_any;
  };
  return isAny(memory.elastic) || isAny(memory.viscous) || isAny(memory.mean) ||
         isAny(memory.last_mean) || isAny(memory.mean_viscous) || isAny(memory.last_mean_viscous);
}

/// How far apart the ends of contacts are that have no force, and have told a slower end so.
template <class Real>
void EnergyStableRuns<Real>::rememberGaps(std::size_t g, State<Real>& state) noexcept {
  if (links_[g].near.waiting() == 0) {
    return;
  }
  const auto gapOf = [&](std::size_t l) noexcept {
    const EnergyStableRef& ref = members_[g].links[l];
    return remembersForce(ref, state) ? Real(0) : links_[g].links.gapOf(l, states(g, state)[l]);
  };
  links_[g].near.remember(gapOf, clearances(g, state));
}

/// Closes the energy accounts: a run stores what its tanks hold, the rest counts as dissipated.
template <class Real>
void EnergyStableRuns<Real>::closeAccounts(std::size_t g,
                                           bool starts,
                                           State<Real>& state) const noexcept {
  if (!state.isMetered()) {
    return;
  }
  const EnergyStableState<Real>* all = states(g, state);
  const std::vector<EnergyStableRef>& links = members_[g].links;
  for (std::size_t l = 0; l < links.size();) {
    const std::size_t run = links[l].run;
    double stored = 0.0;
    for (; l < links.size() && links[l].run == run; ++l) {
      stored += starts ? static_cast<double>(all[l].tank) : all[l].stored;
    }
    LinkWork& work = state.work()[run];
    if (starts) {
      work.initial = stored;
    }
    const double gone = work.initial + work.stored - stored;
    work.stored -= gone;
    work.dissipated += gone;
  }
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableRuns<Real>::step(const Group& group,
                                                   std::int64_t first,
                                                   std::int64_t last,
                                                   const CoefficientsOf<Real>& c,
                                                   const Stepper<Real>& stepper,
                                                   State<Real>& state) noexcept {
  bool any = false;
  for (const std::size_t g : group.energy_stable) {
    EnergyStableView<Real> view = viewOf(links_[g], c, state);
    if (first == 0) {
      followPlaces(g, state);
      links_[g].links.start(view, c.energy_stable[g].data(), states(g, state));
      closeAccounts(g, true, state);
      tanks_.start(g, c, state);
    }
    if (!endsStep(g, last)) {
      continue;
    }
    any = true;
    tanks_.exert(g, c, state);
    followPlaces(g, state);
    links_[g].near.find(state.x(), state.d(), clearances(g, state));
    lookAhead(g, c, state);
    markIdle(g, state);
    const std::int64_t began = last + 1 - members_[g].divisor;
    markDue(g, began);
    view.pressed = pressures_.read(g, c.energy_stable[g].data(), state);
    links_[g].links.step(links_[g].near, view, c.energy_stable[g].data(), states(g, state));
    exchange(g, began, stepper, state);
    rememberGaps(g, state);
    closeAccounts(g, false, state);
  }
  if (any) {
    points_.scatterPlaces(group, forces_.data(), state.places());
    points_.scatterTaps(group, forces_.data(), state.f());
    for (const int slot : reached_[group.energy_stable.front()]) {
      state.f()[slot] += forces_[at(slot)];
      forces_[at(slot)] = Real(0);
    }
    for (const std::size_t g : group.energy_stable) {
      if (endsStep(g, last)) {
        tanks_.answer(g, c, state);
      }
    }
  }
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableRuns<Real>::retune(const CoefficientsOf<Real>& from,
                                                     const CoefficientsOf<Real>& to,
                                                     State<Real>& state) noexcept {
  for (std::size_t g = 0; g < links_.size(); ++g) {
    const EnergyStableView<Real> view = viewOf(links_[g], from, state);
    const auto add = [&](double sign) {
      for (std::size_t l = 0; state.isMetered() && l < members_[g].links.size(); ++l) {
        state.work()[members_[g].links[l].run].stored +=
            sign * static_cast<double>(states(g, state)[l].tank);
      }
    };
    add(-1.0);
    links_[g].links.retune(view, from.energy_stable[g].data(), to.energy_stable[g].data(),
                           states(g, state));
    std::fill_n(clearances(g, state), links_[g].near.waiting(), Real(0));
    add(1.0);
  }
  tanks_.retune(from, to, state);
}

template <class Real>
ERGOTIC_REALTIME bool EnergyStableRuns<Real>::isFinite(const State<Real>& state) const noexcept {
  return tanks_.areFinite(state) &&
         std::all_of(links_.begin(), links_.end(), [&state](const Links& group) {
           const auto* all = state.arena().template at<EnergyStableState<Real>>(group.states_at);
           return std::all_of(
               all, all + group.links.size(),
               [](const EnergyStableState<Real>& link) { return std::isfinite(link.tank); });
         });
}

template <class Real>
std::vector<TankReport> EnergyStableRuns<Real>::makeReports() const {
  std::vector<TankReport> reports;
  for (const EnergyStableGroup& members : members_) {
    for (const EnergyStableRef& ref : members.links) {
      reports.push_back({layout_.runs[ref.run].lias[ref.link], 0, 0});
    }
  }
  tanks_.addReports(reports);
  return reports;
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableRuns<Real>::read(const State<Real>& state,
                                                   std::vector<TankReport>& to) const noexcept {
  std::size_t next = 0;
  for (const Links& group : links_) {
    const auto* all = state.arena().template at<EnergyStableState<Real>>(group.states_at);
    for (std::size_t l = 0; l < group.links.size(); ++l) {
      to[next].active = wholeOf(all[l].active);
      to[next].clipped = wholeOf(all[l].clipped);
      ++next;
    }
  }
  tanks_.read(state, to.data() + next);
}

template class EnergyStableRuns<float>;
template class EnergyStableRuns<double>;

}  // namespace ergotic::physics
