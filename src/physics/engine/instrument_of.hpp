// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "at.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/rt/thread.hpp"
#include "physics/engine/group_stepper.hpp"
#include "physics/engine/mechanism.hpp"
#include "physics/engine/picture.hpp"
#include "physics/engine/workers.hpp"

namespace ergotic::physics {

/// A scene in which the parameters have these values.
/// \throws Exception if there are not as many, or if one is outside its range
scene::Scene withParameters(scene::Scene scene, const std::vector<double>& values);

/// Indices of the links that are played in the scene as written, which contains all of them.
inline std::vector<int> liasAsWritten(const scene::Scene& written, const scene::Scene& played) {
  std::vector<int> indices;
  int next = 0;
  for (const scene::Lia& lia : played.lias) {
    while (!(written.lias[at(next)].name == lia.name)) {
      ++next;
    }
    indices.push_back(next++);
  }
  return indices;
}

inline std::int64_t waitLimitNs(const CompileOptions& options, const Rates& rates) {
  return options.wait_limit_ns == kOneTick ? std::llround(1e9 / rates.gesturalHz())
                                           : options.wait_limit_ns;
}

/// The instrument in one precision: all of a tick, on one thread or several.
template <class Real>
class InstrumentOf final : public Instrument {
 public:
  InstrumentOf(std::shared_ptr<const scene::Scene> written,
               const Rates& rates,
               const CompileOptions& options,
               std::unique_ptr<Mechanism<Real>> mechanism,
               Picture picture,
               std::vector<std::string> notes)
      : Instrument(std::move(written), rates, options),
        notes_(std::move(notes)),
        mechanism_(std::move(mechanism)),
        picture_(std::move(picture)),
        stepper_(rates, *mechanism_),
        inputs_(at(rates.ratio * inputChannels())),
        heard_of_held_(heardOf(mechanism_->groups.held)),
        workers_(Workers::useful(options.threads, mechanism_->groups.running.size()),
                 mechanism_->groups.running.size(),
                 waitLimitNs(options, rates),
                 [this](std::size_t g) { stepGroup(g); }) {
    for (const Group& group : mechanism_->groups.running) {
      heard_.push_back(heardOf(group));
    }
  }

  void tick(const TickIo& io) noexcept override {
    const rt::FlushDenormals flush_denormals;
    if (!finish()) {
      stall(io);
      return;
    }
    std::copy_n(io.inputs, inputs_.size(), inputs_.data());
    takeSlices(io.positions);
    mechanism_->touches.begin(io.touches, mechanism_->meter, mechanism_->state);
    beginTick();
    is_under_way_ = !workers_.run();
    if (is_under_way_) {
      stall(io);
      return;
    }
    endTick();
    giveOutputs(io.outputs);
    giveForces(io.forces);
    mechanism_->touches.end(io.touches, *mechanism_->coefficients, mechanism_->meter,
                            mechanism_->state);
  }

  std::unique_ptr<Coefficients> prepare(const std::vector<double>& values) const override {
    return std::make_unique<CoefficientsOf<Real>>(withParameters(*mechanism_->scene, values),
                                                  rates(), mechanism_->layout);
  }

  std::unique_ptr<Coefficients> exchange(std::unique_ptr<Coefficients> next) noexcept override {
    if (!finish()) {
      return next;
    }
    if (!changed_ && mechanism_->state.frame() > 0) {
      mechanism_->meter.beginChange(*mechanism_->coefficients, mechanism_->state);
      changed_ = true;
    }
    auto* mine = static_cast<CoefficientsOf<Real>*>(next.release());
    if (mechanism_->state.frame() > 0) {
      mechanism_->energy_stable.retune(*mechanism_->coefficients, *mine, mechanism_->state);
    }
    std::unique_ptr<Coefficients> old = std::move(mechanism_->coefficients);
    mechanism_->coefficients.reset(mine);
    return old;
  }

  std::size_t stateSize() const noexcept override { return mechanism_->state.arena().size(); }
  std::vector<StateEntry> stateEntries() const override {
    return mechanism_->state.arena().entries();
  }
  void saveState(void* to) const noexcept override { mechanism_->state.arena().save(to); }
  void loadState(const void* from) noexcept override { mechanism_->state.arena().load(from); }

  bool canTouch(int mat) const noexcept override { return mechanism_->touches.canTouch(mat); }

  void readDisplacements(float* to) const noexcept override {
    if (!is_under_way_) {
      picture_.read(mechanism_->state.x(), to);
    }
  }

  Energies makeEnergies() const override { return mechanism_->meter.make(); }
  void readEnergies(Energies& to) const noexcept override {
    if (!is_under_way_) {
      mechanism_->meter.read(*mechanism_->coefficients, mechanism_->state, to);
    }
  }
  std::vector<TankReport> makeTankReports() const override {
    std::vector<TankReport> reports = mechanism_->energy_stable.makeReports();
    const std::vector<int> written = liasAsWritten(scene(), *mechanism_->scene);
    for (TankReport& report : reports) {
      report.lia = written[at(report.lia)];
    }
    return reports;
  }
  void readTanks(std::vector<TankReport>& to) const noexcept override {
    if (!is_under_way_) {
      mechanism_->energy_stable.read(mechanism_->state, to);
    }
  }

  std::vector<std::string> notes() const override { return notes_; }

  std::vector<std::string> describe() const override {
    std::vector<std::string> lines = notes_;
    const std::vector<std::string> stepped = mechanism_->stepper.describe(scene());
    lines.insert(lines.end(), stepped.begin(), stepped.end());
    const std::vector<std::string> groups =
        describeGroups(scene(), mechanism_->groups, workers_.threads());
    lines.insert(lines.end(), groups.begin(), groups.end());
    return lines;
  }

  std::int64_t stalledTicks() const noexcept override { return stalled_; }
  bool isUnderWay() const noexcept override { return is_under_way_; }
  bool finish() noexcept override {
    if (is_under_way_ && workers_.areDone()) {
      endTick();
      is_under_way_ = false;
    }
    return !is_under_way_;
  }

  bool isFinite() const noexcept override {
    const Real* x = mechanism_->state.x();
    const auto is_finite = [](Real v) { return std::isfinite(v); };
    return is_under_way_ || (std::all_of(x, x + mechanism_->layout.slots(), is_finite) &&
                             mechanism_->energy_stable.isFinite(mechanism_->state));
  }

 private:
  /// Slices move at the start of a tick; a slice at 0 has its module at rest.
  void takeSlices(const double* positions) noexcept {
    const bool is_first_tick = mechanism_->state.frame() == 0;
    for (std::size_t p = 0; p < mechanism_->layout.port_slots.size(); ++p) {
      // Before the first tick nothing is known of the hand: it did not jump, it was there.
      stepper_.moveTo(mechanism_->layout.port_slots[p], static_cast<Real>(positions[p]),
                      is_first_tick);
    }
  }

  void giveForces(double* forces) noexcept {
    const double newton = 1.0 / (scene().time_unit_s * scene().time_unit_s);
    for (std::size_t p = 0; p < mechanism_->layout.port_slots.size(); ++p) {
      forces[p] =
          newton * static_cast<double>(mechanism_->state.f()[mechanism_->layout.port_slots[p]]);
    }
  }

  /// All frames of the present tick, with `heard` as their outputs, set to 0.
  Frames tickOf(std::vector<double>& heard) noexcept {
    std::fill(heard.begin(), heard.end(), 0.0);
    return {mechanism_->state.frame(), rates().ratio, inputs_.data(), heard.data()};
  }

  /// Held sections move, and groups see where they are for the whole tick.
  void beginTick() noexcept {
    held_frames_ = tickOf(heard_of_held_);
    stepper_.begin(mechanism_->groups.held, held_frames_);
    for (const Group& group : mechanism_->groups.running) {
      fillProxies(group, mechanism_->state);
    }
  }

  /// Steps a group through all frames of the tick, one after the other. Thread: any
  void stepGroup(std::size_t g) noexcept {
    const Group& group = mechanism_->groups.running[g];
    const Frames tick = tickOf(heard_[g]);
    stepper_.advanceLoneBlocks(group, tick);
    for (int r = 0; r < tick.count && !group.has_only_lone; ++r) {
      const Frames frame{tick.first + r, 1, tick.inputs + at(r) * at(inputChannels()),
                         tick.outputs + at(r) * group.channels.size()};
      stepper_.begin(group, frame);
      stepper_.end(group, frame);
    }
  }

  /// Held sections get the forces of all groups, always in the same order.
  void endTick() noexcept {
    for (const Group& group : mechanism_->groups.running) {
      emptyProxies(group, mechanism_->state);
    }
    stepper_.end(mechanism_->groups.held, held_frames_);
    const bool is_first_tick = mechanism_->state.frame() == 0;
    mechanism_->state.frame() += rates().ratio;
    if (is_first_tick) {
      mechanism_->meter.start(*mechanism_->coefficients, mechanism_->state);
    }
    if (changed_) {
      mechanism_->meter.endChange(*mechanism_->coefficients, mechanism_->state);
      changed_ = false;
    }
  }

  void stall(const TickIo& io) noexcept {
    std::fill_n(io.forces, ports(), 0.0);
    std::fill_n(io.outputs, rates().ratio * outputChannels(), 0.0);
    ++stalled_;
  }

  void giveOutputs(double* outputs) const noexcept {
    std::fill_n(outputs, at(rates().ratio * outputChannels()), 0.0);
    addHeard(mechanism_->groups.held, heard_of_held_, outputs);
    for (std::size_t g = 0; g < heard_.size(); ++g) {
      addHeard(mechanism_->groups.running[g], heard_[g], outputs);
    }
  }

  void addHeard(const Group& group, const std::vector<double>& heard, double* to) const noexcept {
    const double* from = heard.data();
    for (int r = 0; r < rates().ratio; ++r, to += outputChannels()) {
      for (const int channel : group.channels) {
        to[channel] += *from++;
      }
    }
  }

  std::vector<double> heardOf(const Group& group) const {
    return std::vector<double>(at(rates().ratio) * group.channels.size());
  }

  std::vector<std::string> notes_;  // on modes
  std::unique_ptr<Mechanism<Real>> mechanism_;
  Picture picture_;
  GroupStepper<Real> stepper_;
  std::vector<double> inputs_;              // [R][input channels]
  std::vector<double> heard_of_held_;       // [R][its channels]
  std::vector<std::vector<double>> heard_;  // [groups][R][its channels]
  Frames held_frames_;                      // of the present tick
  std::int64_t stalled_ = 0;
  bool is_under_way_ = false;  // another thread has not done its share of the last tick
  bool changed_ = false;       // coefficients were exchanged since the last tick
  Workers workers_;            // the last: its threads use all of the above
};

}  // namespace ergotic::physics
