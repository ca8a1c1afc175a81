// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/energy_meter.hpp"

#include <algorithm>

#include "at.hpp"
#include "physics/engine/stored_energy.hpp"
#include "physics/kernels/link_kernels.hpp"

namespace ergotic::physics {
namespace {

bool isSpring(const LinkRun& run) {
  return scene::lawOf(run.law).kind == scene::Law::Kind::kLinear && !run.energy_stable;
}

/// Whether audio inputs change its stiffness, which is work that no balance has.
bool isDriven(const scene::Scene& scene, const LinkRun& run) {
  return std::any_of(run.lias.begin(), run.lias.end(),
                     [&](int lia) { return scene.lias[at(lia)].stiffness.audio >= 0; });
}

}  // namespace

template <class Real>
EnergyMeter<Real>::EnergyMeter(const scene::Scene& scene, const Layout& layout, State<Real>& state)
    : layout_(layout),
      newton_(1.0 / (scene.time_unit_s * scene.time_unit_s)),
      everything_(everythingOf(layout)),
      forced_of_section_(layout.sections.size()) {
  const auto force = [this](int section, int slot, bool by_device) {
    forced_of_section_[at(section)].push_back(forced_.size());
    forced_.push_back({slot, by_device});
  };
  for (const int slot : layout.port_slots) {
    force(scene.mats[at(layout.mat_of_slot[at(slot)])].section, slot, true);
  }
  for (const Feed& feed : layout.feeds) {
    if (feed.quantity == scene::Quantity::kPosition) {
      force(feed.section, feed.slot, false);
    }
  }
  const auto couple = [this](int one, int other) {
    const int a = std::min(one, other);
    const int b = std::max(one, other);
    const auto found = std::find_if(couplings_.begin(), couplings_.end(),
                                    [&](const Coupled& c) { return c.a == a && c.b == b; });
    if (found == couplings_.end()) {
      couplings_.push_back({a, b});
      return couplings_.size() - 1;
    }
    return static_cast<std::size_t>(found - couplings_.begin());
  };
  for (const LinkRun& run : layout.runs) {
    coupling_of_run_.push_back(
        run.section_a == run.section_b ? kInside : couple(run.section_a, run.section_b));
    const bool is_inside = coupling_of_run_.back() == kInside;
    follows_positions_.push_back(isSpring(run) && run.dimensions == 0 &&
                                 (is_inside || !isDriven(scene, run)));
  }
  scratch_ = make();
  ahead_.assign(layout.sections.size(), 0.0);
  if (!state.isMetered()) {
    return;
  }
  Arena& arena = state.arena();
  accounts_at_ = arena.add<SectionAccount>("section_energy", layout.sections.size());
  forced_at_ = arena.add<Feeding>("slice_forces", forced_.size());
  feeds_at_ = arena.add<Feeding>("input_forces", layout.feeds.size());
  places_at_ = arena.add<Feeding>("place_forces", coordinatesOf(layout.places));
  interpolated_work_at_ = arena.add<double>("glide_work", coordinatesOf(layout.interpolated));
  totals_at_ = arena.add<Totals>("energy_totals", 1);
}

template <class Real>
void EnergyMeter<Real>::addDissipated(int section,
                                      double energy,
                                      State<Real>& state) const noexcept {
  if (state.isMetered()) {
    state.arena().template at<SectionAccount>(accounts_at_)[section].dissipated += energy;
  }
}

template <class Real>
template <class StateType, class Add>
void EnergyMeter<Real>::forEachSource(const Group& group,
                                      StateType& state,
                                      const Add& add) const noexcept {
  auto& arena = state.arena();
  const Real* d = state.d();
  const Real* moved = state.moved();
  const Real* f = state.f();
  auto* feedings = arena.template at<Feeding>(forced_at_);
  for (const int section : group.sections) {
    for (const std::size_t i : forced_of_section_[at(section)]) {
      const int slot = forced_[i].slot;
      add(section, forced_[i].device ? Source::kDevice : Source::kInputs, -d[slot], -d[slot],
          feedings[i], f[slot]);
    }
  }
  feedings = arena.template at<Feeding>(feeds_at_);
  for (const std::size_t k : group.feeds) {
    const Feed& feed = layout_.feeds[k];
    add(feed.section, Source::kInputs, d[feed.slot], d[feed.slot], feedings[k], feedings[k].mean);
  }
  for (const std::size_t p : group.places) {
    const PlacePoint& point = layout_.places[p];
    const Real* place_d = state.placeD() + point.coordinate;
    auto* feeding = arena.template at<Feeding>(places_at_) + point.coordinate;
    for (int k = point.slot; k < point.slot + point.dimensions; ++k, ++feeding, ++place_d) {
      add(point.section, Source::kInputs, d[k] - moved[k], *place_d - moved[k], *feeding,
          feeding->mean);
    }
  }
}

template <class Real>
void EnergyMeter<Real>::endFrame(const Group& group,
                                 std::int64_t now,
                                 State<Real>& state) const noexcept {
  if (!state.isMetered()) {
    return;
  }
  auto* accounts = state.arena().template at<SectionAccount>(accounts_at_);
  collectPointForces(group, state);
  forEachSource(group, state,
                [&](int section, Source source, Real moved, Real moved_last, Feeding& feeding,
                    Real force) noexcept {
                  if (!endsStep(section, now)) {
                    return;
                  }
                  double& account = source == Source::kDevice ? accounts[section].from_device
                                                              : accounts[section].from_inputs;
                  account += 0.5 * static_cast<double>(moved * force + moved_last * feeding.last);
                  feeding = {Real(0), force};
                });
  addWorkOfInterpolatedSlices(group, now, state);
}

/// An interpolated slice works by its positions as the faster section sees them.
template <class Real>
void EnergyMeter<Real>::addWorkOfInterpolatedSlices(const Group& group,
                                                    std::int64_t now,
                                                    State<Real>& state) const noexcept {
  for (const std::size_t g : group.interpolated) {
    const InterpolatedSlice& slice = layout_.interpolated[g];
    if (!endsStep(slice.section, now)) {
      continue;
    }
    auto* work = state.arena().template at<double>(interpolated_work_at_) + slice.coordinate;
    const InterpolatedForce<Real>* force = state.interpolatedForces() + slice.coordinate;
    for (int k = 0; k < slice.dimensions; ++k) {
      const int slot = slice.slot + k;
      work[k] -= 0.5 * static_cast<double>(state.d()[slot] * (force[k].last + state.f()[slot]));
    }
  }
}

/// Points give their forces away in every frame: their means are collected here.
template <class Real>
void EnergyMeter<Real>::collectPointForces(const Group& group, State<Real>& state) const noexcept {
  for (const std::size_t p : group.places) {
    const PlacePoint& point = layout_.places[p];
    auto* feeding = state.arena().template at<Feeding>(places_at_) + point.coordinate;
    for (int k = 0; k < point.dimensions; ++k) {
      feeding[k].mean += state.f()[point.slot + k];
    }
  }
}

template <class Real>
double EnergyMeter<Real>::storedIn(int section,
                                   const CoefficientsOf<Real>& c,
                                   const State<Real>& state) const noexcept {
  const SectionRange& range = layout_.sections[at(section)];
  double energy = kineticOf(range, c.masses, state) + potentialOf(range, c.masses, state);
  for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
    if (coupling_of_run_[r] == kInside && layout_.runs[r].section == section) {
      energy += storedIn(r, c, state);
    }
  }
  return energy;
}

template <class Real>
double EnergyMeter<Real>::storedIn(std::size_t run,
                                   const CoefficientsOf<Real>& c,
                                   const State<Real>& state) const noexcept {
  const LinkRun& asked = layout_.runs[run];
  if (asked.block >= 0) {
    return springsOf(layout_.blocks[at(asked.block)], asked, c.blocks[at(asked.block)], c.masses,
                     state);
  }
  const bool is_inside = coupling_of_run_[run] == kInside;
  if (state.isMetered() ? follows_positions_[run] : is_inside && isSpring(asked)) {
    return springsOf(asked, c.runs[run], state);
  }
  if (!state.isMetered()) {
    return 0.0;
  }
  const LinkWork work = workOf(run, state);
  return work.initial + work.stored;
}

template <class Real>
Energies EnergyMeter<Real>::make() const {
  Energies energies;
  energies.sections.resize(layout_.sections.size());
  for (const Coupled& pair : couplings_) {
    energies.couplings.push_back({pair.a, pair.b, 0.0, 0.0, 0.0});
  }
  return energies;
}

template <class Real>
void EnergyMeter<Real>::addSections(const CoefficientsOf<Real>& c,
                                    const State<Real>& state,
                                    Energies& to) const noexcept {
  for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
    const SectionRange& range = layout_.sections[s];
    SectionAccount account{};
    if (state.isMetered()) {
      account = state.arena().template at<SectionAccount>(accounts_at_)[s];
    }
    to.sections[s] = {kineticOf(range, c.masses, state),
                      potentialOf(range, c.masses, state),
                      account.dissipated,
                      account.from_device,
                      account.from_inputs,
                      0.0};
  }
  for (const InterpolatedSlice& slice : layout_.interpolated) {
    for (int k = 0; k < slice.dimensions && state.isMetered(); ++k) {
      to.sections[at(slice.of.section)].from_device +=
          state.arena().template at<double>(interpolated_work_at_)[slice.coordinate + k];
    }
  }
}

template <class Real>
void EnergyMeter<Real>::addLinks(const CoefficientsOf<Real>& c,
                                 const State<Real>& state,
                                 Energies& to) const noexcept {
  for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
    const LinkRun& run = layout_.runs[r];
    const LinkWork work = workOf(r, state);
    const double stored = storedIn(r, c, state);
    if (coupling_of_run_[r] == kInside) {
      to.sections[at(run.section)].potential += stored;
      to.sections[at(run.section)].dissipated += work.dissipated;
      continue;
    }
    CouplingEnergy& coupling = to.couplings[coupling_of_run_[r]];
    coupling.stored += stored;
    coupling.dissipated += work.dissipated;
    coupling.made += work.made;
    to.sections[at(run.section_a)].from_links += work.on_a;
    to.sections[at(run.section_b)].from_links += work.on_b;
  }
}

/// The work of a run, with that of the steps under way.
template <class Real>
LinkWork EnergyMeter<Real>::workOf(std::size_t r, const State<Real>& state) const noexcept {
  if (!state.isMetered()) {
    return {};
  }
  const LinkRun& run = layout_.runs[r];
  LinkWork work = state.work()[r];
  const bool is_slow_done = layout_.isBetweenSlowSteps(run, state.frame());
  const bool is_done =
      !run.energy_stable || state.frame() % layout_.sections[at(run.section)].divisor == 0;
  if (is_slow_done && is_done) {
    return work;
  }
  const LinkMemory<const Real> memory = state.memory(r);
  const std::size_t links = run.ends.size();
  for (std::size_t i = 0; i < state.remembered(r); ++i) {
    const LinkEnds& ends = run.ends[i % links];
    const int k = static_cast<int>(i / links);
    const Real moved_a = state.moved()[ends.a + k * run.stride_a];
    const Real moved_b = state.moved()[ends.b + k * run.stride_b];
    if (!is_slow_done) {
      kernels::addWorkOfMean(run, memory, i, static_cast<double>(run.slow_is_a ? moved_a : moved_b),
                             work);
    }
    if (!is_done) {
      // Its force comes with the last frame of the step.
      kernels::addHalfWork(run, moved_a, moved_b, {memory.elastic[i], memory.viscous[i]}, work);
    }
  }
  return work;
}

/// Adds the work of the device and of inputs in the steps under way; takes off work counted ahead.
template <class Real>
void EnergyMeter<Real>::addSources(const State<Real>& state, Energies& to) const noexcept {
  if (!state.isMetered()) {
    return;
  }
  for (std::size_t s = 0; s < to.sections.size(); ++s) {
    to.sections[s].from_inputs -= ahead_[s];
  }
  forEachSource(everything_, state,
                [&](int section, Source source, Real moved, Real moved_last, const Feeding& feeding,
                    Real force) {
                  if (state.frame() % layout_.sections[at(section)].divisor == 0) {
                    return;
                  }
                  const double work =
                      0.5 * static_cast<double>(moved * force + moved_last * feeding.last);
                  SectionEnergy& energy = to.sections[at(section)];
                  (source == Source::kDevice ? energy.from_device : energy.from_inputs) += work;
                });
}

/// Collects all energies except the residual, in the scene's unit. \return the balance
template <class Real>
double EnergyMeter<Real>::collect(const CoefficientsOf<Real>& c,
                                  const State<Real>& state,
                                  Energies& to) const noexcept {
  for (CouplingEnergy& coupling : to.couplings) {
    coupling.stored = coupling.dissipated = coupling.made = 0.0;
  }
  addSections(c, state, to);
  addLinks(c, state, to);
  addSources(state, to);
  to.stored = 0.0;
  double balance = 0.0;
  for (const SectionEnergy& s : to.sections) {
    to.stored += s.kinetic + s.potential;
    balance += s.dissipated - s.from_device - s.from_inputs;
  }
  for (const CouplingEnergy& coupling : to.couplings) {
    to.stored += coupling.stored;
    balance += coupling.dissipated - coupling.made;
  }
  return balance + to.stored;
}

template <class Real>
void EnergyMeter<Real>::start(const CoefficientsOf<Real>& c, State<Real>& state) noexcept {
  if (state.isMetered()) {
    totals(state).reference = collect(c, state, scratch_);
  }
}

template <class Real>
void EnergyMeter<Real>::beginChange(const CoefficientsOf<Real>& c, State<Real>& state) noexcept {
  if (state.isMetered()) {
    totals(state).before_change = collect(c, state, scratch_);
  }
}

template <class Real>
void EnergyMeter<Real>::endChange(const CoefficientsOf<Real>& c, State<Real>& state) noexcept {
  if (state.isMetered()) {
    totals(state).from_parameters += collect(c, state, scratch_) - totals(state).before_change;
  }
}

template <class Real>
void EnergyMeter<Real>::read(const CoefficientsOf<Real>& c,
                             const State<Real>& state,
                             Energies& to) const noexcept {
  const double balance = collect(c, state, to);
  Totals totals{};
  totals.reference = balance;
  if (state.isMetered()) {
    totals = *state.arena().template at<Totals>(totals_at_);
  }
  to.residual = newton_ * (balance - totals.reference - totals.from_parameters);
  to.from_parameters = newton_ * totals.from_parameters;
  to.stored *= newton_;
  for (SectionEnergy& s : to.sections) {
    for (double* value :
         {&s.kinetic, &s.potential, &s.dissipated, &s.from_device, &s.from_inputs, &s.from_links}) {
      *value *= newton_;
    }
  }
  for (CouplingEnergy& coupling : to.couplings) {
    for (double* value : {&coupling.stored, &coupling.dissipated, &coupling.made}) {
      *value *= newton_;
    }
  }
}

template class EnergyMeter<float>;
template class EnergyMeter<double>;

}  // namespace ergotic::physics
