// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/engine/instrument.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ergotic/exception.hpp"
#include "ergotic/rt/thread.hpp"
#include "physics/engine/group_stepper.hpp"
#include "physics/engine/parts.hpp"
#include "physics/engine/workers.hpp"
#include "physics/modes/modal_scene.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// A scene in which the parameters have these values.
scene::Scene withParameters(scene::Scene scene, const std::vector<double>& values) {
  if (values.size() != scene.parameters.size()) {
    throw Exception(std::to_string(values.size()) + " parameter values for a scene with " +
                    std::to_string(scene.parameters.size()));
  }
  for (std::size_t p = 0; p < values.size(); ++p) {
    scene::Parameter& parameter = scene.parameters[p];
    if (!(values[p] >= parameter.minimum && values[p] <= parameter.maximum)) {
      throw Exception("parameter '" + parameter.name + "': " + std::to_string(values[p]) +
                      " is outside its range " + std::to_string(parameter.minimum) + "..." +
                      std::to_string(parameter.maximum));
    }
    parameter.value = values[p];
  }
  return scene;
}

template <class Real>
class InstrumentOf final : public Instrument {
 public:
  InstrumentOf(std::shared_ptr<const scene::Scene> shared,
               const Rates& rates,
               const CompileOptions& options)
      : Instrument(std::move(shared), rates, options),
        modal_(withModes(scene(), rates, notes_)),
        parts_(played(), rates, options, modal_ ? modal_->points : std::vector<ModalPoint>{}),
        stepper_(played(), rates, parts_),
        inputs_(at(rates.ratio * inputChannels())),
        heard_of_held_(heardOf(parts_.groups.held)),
        workers_(Workers::useful(options.threads, parts_.groups.running.size()),
                 parts_.groups.running.size(),
                 options.wait_limit_ns,
                 [this](std::size_t g) { stepGroup(g); }) {
    for (const Group& group : parts_.groups.running) {
      heard_.push_back(heardOf(group));
    }
    placeInitialState();
  }

  void tick(const TickIo& io) noexcept override {
    const rt::FlushDenormals flush_denormals;
    if (!finishTick()) {
      stall(io);
      return;
    }
    std::copy_n(io.inputs, inputs_.size(), inputs_.data());
    takeSlices(io.positions);
    beginTick();
    is_under_way_ = !workers_.run();
    if (is_under_way_) {
      stall(io);
      return;
    }
    endTick();
    giveOutputs(io.outputs);
    giveForces(io.forces);
  }

  std::unique_ptr<Coefficients> prepare(const std::vector<double>& values) const override {
    return std::make_unique<CoefficientsOf<Real>>(withParameters(played(), values), rates(),
                                                  parts_.layout);
  }

  std::unique_ptr<Coefficients> exchange(std::unique_ptr<Coefficients> next) noexcept override {
    if (!finishTick()) {
      return next;
    }
    if (!changed_ && parts_.state.frame() > 0) {
      parts_.meter.beginChange(*parts_.coefficients, parts_.state);
      changed_ = true;
    }
    auto* mine = static_cast<CoefficientsOf<Real>*>(next.release());
    if (parts_.state.frame() > 0) {
      parts_.guarded.retune(*parts_.coefficients, *mine, parts_.state);
    }
    std::unique_ptr<Coefficients> old = std::move(parts_.coefficients);
    parts_.coefficients.reset(mine);
    return old;
  }

  std::size_t stateSize() const noexcept override { return parts_.state.arena().size(); }
  std::vector<StateEntry> stateEntries() const override { return parts_.state.arena().entries(); }
  void saveState(void* to) const noexcept override { parts_.state.arena().save(to); }
  void loadState(const void* from) noexcept override { parts_.state.arena().load(from); }

  void readDisplacements(float* to) const noexcept override {
    if (is_under_way_) {
      return;
    }
    const Real* x = parts_.state.x();
    std::size_t picture = 0;
    for (std::size_t written = 0; written < scene().mats.size(); ++written) {
      const int m = modal_ ? modal_->mats[written] : static_cast<int>(written);
      if (m < 0) {
        *to++ = displacementIn(modal_->pictures[picture++]);
        continue;
      }
      const scene::Mat& mat = played().mats[at(m)];
      const SectionRange& range = parts_.layout.sections[at(mat.section)];
      const int stride = mat.type == scene::MatType::kPoint ? 1 : range.stride;
      for (int k = 0; k < range.dimensions; ++k) {
        *to++ = static_cast<float>(x[parts_.layout.slot_of_mat[at(m)] + k * stride]);
      }
    }
  }

  Energies makeEnergies() const override { return parts_.meter.make(); }
  void readEnergies(Energies& to) const noexcept override {
    if (!is_under_way_) {
      parts_.meter.read(*parts_.coefficients, parts_.state, to);
    }
  }
  std::vector<GuardReport> makeGuardReports() const override {
    std::vector<GuardReport> reports = parts_.guarded.makeReports();
    for (GuardReport& report : reports) {
      report.lia = modal_ ? modal_->lias[at(report.lia)] : report.lia;
    }
    return reports;
  }
  void readGuards(std::vector<GuardReport>& to) const noexcept override {
    if (!is_under_way_) {
      parts_.guarded.read(parts_.state, to);
    }
  }

  std::vector<std::string> notes() const override { return notes_; }

  std::vector<std::string> describe() const override {
    std::vector<std::string> lines = notes_;
    const std::vector<std::string> stepped = parts_.stepper.describe(scene());
    lines.insert(lines.end(), stepped.begin(), stepped.end());
    const std::vector<std::string> groups =
        describeGroups(scene(), parts_.groups, workers_.threads());
    lines.insert(lines.end(), groups.begin(), groups.end());
    return lines;
  }

  std::int64_t stalledTicks() const noexcept override { return stalled_; }
  bool isUnderWay() const noexcept override { return is_under_way_; }

  bool isFinite() const noexcept override {
    const Real* x = parts_.state.x();
    return is_under_way_ ||
           std::all_of(x, x + parts_.layout.slots(), [](Real v) { return std::isfinite(v); });
  }

 private:
  /// The scene whose modules are stepped: as it was written, or with modes in place of some.
  const scene::Scene& played() const noexcept { return modal_ ? modal_->scene : scene(); }

  float displacementIn(const ModalPicture& picture) const noexcept {
    const Real* modes = parts_.state.x() + parts_.layout.slot_of_mat[at(picture.first)];
    float sum = 0.0F;
    for (std::size_t k = 0; k < picture.weights.size(); ++k) {
      sum += picture.weights[k] * static_cast<float>(modes[k]);
    }
    return sum;
  }

  void placeInitialState() {
    for (std::size_t s = 0; s < parts_.layout.sections.size(); ++s) {
      const SectionRange& range = parts_.layout.sections[s];
      const StepUnits units(scene(), rates(), range.divisor);
      for (int slot = range.first; slot < range.end; ++slot) {
        if (parts_.layout.mat_of_slot[at(slot)] < 0) {
          continue;
        }
        const scene::Mat& mat = played().mats[at(parts_.layout.mat_of_slot[at(slot)])];
        for (int k = 0; k < range.dimensions; ++k) {
          const int here = slot + k * range.stride;
          parts_.state.x()[here] = static_cast<Real>(mat.position[k] - mat.rest[k]);
          if (slot < range.fixed && mat.type != scene::MatType::kGround) {
            parts_.state.d()[here] = static_cast<Real>(units.velocity(mat.push->velocity[k]));
          }
        }
      }
    }
    if (modal_) {
      for (const auto& [mode, force] : modal_->first_forces) {
        parts_.state.f()[parts_.layout.slot_of_mat[at(mode)]] = static_cast<Real>(force);
      }
    }
    parts_.points.placeAtStart(*parts_.coefficients, parts_.state.x(), parts_.state.d(),
                               parts_.state.places());
    for (const Group& group : parts_.groups.running) {
      stepper_.fillProxies(group);
    }
    for (std::size_t r = 0; options().metered && r < parts_.layout.runs.size(); ++r) {
      if (remembers(parts_.layout.runs[r]) && !parts_.layout.runs[r].guarded) {
        parts_.stepper.storeAtStart(r, parts_.coefficients->runs[r], parts_.state);
      }
    }
  }

  /// Slices move at the start of a tick; a slice at 0 has its module at rest.
  void takeSlices(const double* positions) noexcept {
    const bool is_first_tick = parts_.state.frame() == 0;
    for (std::size_t p = 0; p < parts_.layout.port_slots.size(); ++p) {
      // Before the first tick nothing is known of the hand: it did not jump, it was there.
      stepper_.moveTo(parts_.layout.port_slots[p], static_cast<Real>(positions[p]), is_first_tick);
    }
  }

  void giveForces(double* forces) noexcept {
    const double newton = 1.0 / (scene().time_unit_s * scene().time_unit_s);
    for (std::size_t p = 0; p < parts_.layout.port_slots.size(); ++p) {
      forces[p] = newton * static_cast<double>(parts_.state.f()[parts_.layout.port_slots[p]]);
    }
  }

  /// All frames of the tick.
  Frames tickOf(std::vector<double>& heard) noexcept {
    std::fill(heard.begin(), heard.end(), 0.0);
    return {parts_.state.frame(), rates().ratio, inputs_.data(), heard.data()};
  }

  /// Held sections move, and groups see where they are for the whole tick.
  void beginTick() noexcept {
    held_frames_ = tickOf(heard_of_held_);
    stepper_.begin(parts_.groups.held, held_frames_);
    for (const Group& group : parts_.groups.running) {
      stepper_.fillProxies(group);
    }
  }

  /// All frames, one after the other. Thread: any
  void stepGroup(std::size_t g) noexcept {
    const Group& group = parts_.groups.running[g];
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
    for (const Group& group : parts_.groups.running) {
      stepper_.emptyProxies(group);
    }
    stepper_.end(parts_.groups.held, held_frames_);
    const bool is_first_tick = parts_.state.frame() == 0;
    parts_.state.frame() += rates().ratio;
    if (is_first_tick) {
      parts_.meter.start(*parts_.coefficients, parts_.state);
    }
    if (changed_) {
      parts_.meter.endChange(*parts_.coefficients, parts_.state);
      changed_ = false;
    }
  }

  /// Brings a stalled tick to its end. \return false if another thread is still at it
  bool finishTick() noexcept {
    if (is_under_way_ && workers_.finish()) {
      endTick();
      is_under_way_ = false;
    }
    return !is_under_way_;
  }

  void stall(const TickIo& io) noexcept {
    std::fill_n(io.forces, ports(), 0.0);
    std::fill_n(io.outputs, rates().ratio * outputChannels(), 0.0);
    ++stalled_;
  }

  void giveOutputs(double* outputs) const noexcept {
    std::fill_n(outputs, at(rates().ratio * outputChannels()), 0.0);
    addHeard(parts_.groups.held, heard_of_held_, outputs);
    for (std::size_t g = 0; g < heard_.size(); ++g) {
      addHeard(parts_.groups.running[g], heard_[g], outputs);
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
  std::optional<ModalScene> modal_;
  Parts<Real> parts_;
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

}  // namespace

std::unique_ptr<Instrument> compile(std::shared_ptr<const scene::Scene> scene,
                                    const Rates& rates,
                                    const CompileOptions& options) {
  if (!scene::isSettled(*scene)) {
    throw Exception("scene '" + scene->name + "' is not settled: settle() comes before compile()");
  }
  if (options.threads < 1 || options.threads > kMaxThreads) {
    throw Exception("threads: " + std::to_string(options.threads) + ", allowed: 1..." +
                    std::to_string(kMaxThreads));
  }
  if (options.precision == Precision::kFloat) {
    return std::make_unique<InstrumentOf<float>>(std::move(scene), rates, options);
  }
  return std::make_unique<InstrumentOf<double>>(std::move(scene), rates, options);
}

std::unique_ptr<Instrument> compile(const scene::Scene& scene,
                                    const Rates& rates,
                                    const CompileOptions& options) {
  return compile(std::make_shared<const scene::Scene>(scene), rates, options);
}

}  // namespace ergotic::physics
