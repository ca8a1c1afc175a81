// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/instrument.hpp"

#include <algorithm>
#include <cmath>

#include "coefficients.hpp"
#include "energy_meter.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/settle.hpp"
#include "guarded_runs.hpp"
#include "layout.hpp"
#include "points.hpp"
#include "sleeper.hpp"
#include "state.hpp"
#include "step_units.hpp"
#include "stepper.hpp"
#include "taps.hpp"

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
  InstrumentOf(const scene::Scene& scene,
               const Rates& rates,
               Layout layout,
               const CompileOptions& options)
      : Instrument(scene, rates, options),
        layout_(std::move(layout)),
        coefficients_(std::make_unique<CoefficientsOf<Real>>(scene, rates, layout_)),
        state_(layout_),
        meter_(scene, layout_, state_),
        stepper_(layout_),
        points_(scene, layout_),
        guarded_(scene, layout_, points_, state_),
        taps_(layout_),
        sleeper_(scene, layout_, *coefficients_),
        due_(layout_.sections.size(), 0),
        followed_(layout_.followers.empty() ? scene::Scene{} : scene) {
    state_.allocate();
    placeInitialState();
  }

  void tick(const TickIo& io) noexcept override {
    const std::int64_t first = state_.frame();
    takeSlices(io.positions, first == 0);
    const int channels_in = inputChannels();
    const int channels_out = outputChannels();
    for (int r = 0; r < rates().ratio; ++r) {
      const double* in = io.inputs + at(r) * at(channels_in);
      double* out = io.outputs + at(r) * at(channels_out);
      std::fill_n(out, channels_out, 0.0);
      frameStep(first + r, in, out);
      state_.frame() = first + r + 1;
      if (first + r == 0) {
        meter_.start(*coefficients_, state_);
      }
    }
    if (changed_) {
      meter_.endChange(*coefficients_, state_);
      changed_ = false;
    }
    giveForces(io.forces);
  }

  std::unique_ptr<Coefficients> prepare(const std::vector<double>& values) const override {
    return std::make_unique<CoefficientsOf<Real>>(withParameters(scene(), values), rates(),
                                                  layout_);
  }

  std::unique_ptr<Coefficients> exchange(std::unique_ptr<Coefficients> next) noexcept override {
    if (!changed_ && state_.frame() > 0) {
      meter_.beginChange(*coefficients_, state_);
      changed_ = true;
    }
    auto* mine = static_cast<CoefficientsOf<Real>*>(next.release());
    if (state_.frame() > 0) {
      guarded_.retune(*coefficients_, *mine, state_);
    }
    std::unique_ptr<Coefficients> old = std::move(coefficients_);
    coefficients_.reset(mine);
    return old;
  }

  std::size_t stateSize() const noexcept override { return state_.arena().size(); }
  std::vector<StateEntry> stateEntries() const override { return state_.arena().entries(); }
  void saveState(void* to) const noexcept override { state_.arena().save(to); }
  void loadState(const void* from) noexcept override { state_.arena().load(from); }

  void readDisplacements(float* to) const noexcept override {
    const Real* x = state_.x();
    for (std::size_t m = 0; m < layout_.slot_of_mat.size(); ++m) {
      const scene::Mat& mat = scene().mats[m];
      const SectionRange& range = layout_.sections[at(mat.section)];
      const int stride = mat.type == scene::MatType::kPoint ? 1 : range.stride;
      for (int k = 0; k < range.dimensions; ++k) {
        *to++ = static_cast<float>(x[layout_.slot_of_mat[m] + k * stride]);
      }
    }
  }

  Energies makeEnergies() const override { return meter_.make(); }
  void readEnergies(Energies& to) const noexcept override {
    meter_.read(*coefficients_, state_, to);
  }
  std::vector<GuardReport> makeGuardReports() const override { return guarded_.makeReports(); }
  void readGuards(std::vector<GuardReport>& to) const noexcept override {
    guarded_.read(state_, to);
  }

  std::vector<std::string> describe() const override {
    std::vector<std::string> lines;
    for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
      const SectionRange& range = layout_.sections[s];
      lines.push_back("section '" + scene().sections[s].name + "': " +
                      std::to_string(range.fixed - range.cells) + " free modules one by one");
    }
    return lines;
  }

  bool isFinite() const noexcept override {
    const Real* x = state_.x();
    return std::all_of(x, x + layout_.slots(), [](Real v) { return std::isfinite(v); });
  }

 private:
  void placeInitialState() {
    for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
      const SectionRange& range = layout_.sections[s];
      const StepUnits units(scene(), rates(), range.divisor);
      for (int slot = range.cells; slot < range.end; ++slot) {
        const scene::Mat& mat = scene().mats[at(layout_.mat_of_slot[at(slot)])];
        for (int k = 0; k < range.dimensions; ++k) {
          const int here = slot + k * range.stride;
          state_.x()[here] = static_cast<Real>(mat.position[k] - mat.rest[k]);
          if (slot < range.fixed) {
            state_.d()[here] = static_cast<Real>(units.velocity(mat.velocity[k]));
          }
        }
      }
    }
    points_.placeAtStart(*coefficients_, state_.x(), state_.d(), state_.places());
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      if (remembers(layout_.runs[r]) && !layout_.runs[r].guarded) {
        stepper_.storeAtStart(r, coefficients_->runs[r], state_);
      }
    }
  }

  /// Slices move at the start of a tick; a slice at 0 has its module at rest.
  void takeSlices(const double* positions, bool is_first_tick) noexcept {
    for (std::size_t p = 0; p < layout_.port_slots.size(); ++p) {
      // Before the first tick nothing is known of the hand: it did not jump, it was there.
      moveTo(layout_.port_slots[p], static_cast<Real>(positions[p]), is_first_tick);
    }
  }

  /// Something outside moves a module.
  void moveTo(int slot, Real position, bool was_there) noexcept {
    state_.dLast()[slot] = state_.d()[slot];
    state_.d()[slot] = was_there ? Real(0) : position - state_.x()[slot];
    state_.x()[slot] = position;
  }

  void giveForces(double* forces) noexcept {
    const double newton = 1.0 / (scene().time_unit_s * scene().time_unit_s);
    for (std::size_t p = 0; p < layout_.port_slots.size(); ++p) {
      forces[p] = newton * static_cast<double>(state_.f()[layout_.port_slots[p]]);
    }
  }

  /// One audio frame: modules move, positions are heard, links, inputs, forces are heard.
  void frameStep(std::int64_t now, const double* in, double* out) noexcept {
    followAudio(in);
    moveModules(now);
    feedPositions(in);
    gatherPoints();
    taps_.takePositions(*coefficients_, state_, out);
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      const LinkRun& run = layout_.runs[r];
      if (!run.guarded && due_[at(run.section)] != 0 && !isAsleep(run)) {
        stepper_.stepLinks(r, coefficients_->runs[r], due_.data(), layout_.endsSlowStep(run, now),
                           state_);
      }
    }
    feedForces(in);
    points_.scatter(state_.f(), state_.places());
    guarded_.step(now, *coefficients_, stepper_, state_);
    meter_.endFrame(now, state_);
    taps_.takeForces(*coefficients_, now, state_, out);
    sleeper_.endFrame(now, *coefficients_, meter_, state_);
  }

  bool isAsleep(const LinkRun& run) noexcept {
    return run.section_a == run.section_b && state_.asleep()[run.section_a] != 0;
  }

  /// What follows an audio input gets its coefficients of this frame.
  void followAudio(const double* in) noexcept {
    for (scene::AudioParameter& parameter : followed_.audio_parameters) {
      parameter.value = in[parameter.channel];
    }
    for (const Follower& follower : layout_.followers) {
      coefficients_->follow(followed_, rates(), layout_, follower);
    }
  }

  void moveModules(std::int64_t now) noexcept {
    for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
      due_[s] = now % layout_.sections[s].divisor == 0 ? 1 : 0;
      if (due_[s] != 0 && state_.asleep()[s] == 0) {
        const int section = static_cast<int>(s);
        meter_.addDissipated(section, stepper_.moveMasses(section, coefficients_->masses, state_),
                             state_);
      }
    }
  }

  void gatherPoints() noexcept {
    if (!layout_.places.empty()) {
      for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
        const SectionRange& range = layout_.sections[s];
        if (due_[s] != 0) {
          std::copy_n(state_.d() + range.cells, range.dimensions * range.stride,
                      state_.moved() + range.cells);
        }
      }
    }
    points_.gather(*coefficients_, due_.data(), state_);
    points_.clearForces(state_.f());
  }

  void feedPositions(const double* in) noexcept {
    for (std::size_t k = 0; k < layout_.feeds.size(); ++k) {
      const Feed& feed = layout_.feeds[k];
      if (feed.quantity == scene::Quantity::kPosition && due_[at(feed.section)] != 0) {
        const double gain = static_cast<double>(coefficients_->feed_gains[k]);
        moveTo(feed.slot, static_cast<Real>(gain * in[feed.channel] - feed.rest), false);
      }
    }
  }

  void feedForces(const double* in) noexcept {
    for (std::size_t k = 0; k < layout_.feeds.size(); ++k) {
      const Feed& feed = layout_.feeds[k];
      if (feed.quantity == scene::Quantity::kForce) {
        const Real force = coefficients_->feed_gains[k] * static_cast<Real>(in[feed.channel]) *
                           static_cast<Real>(feed.share);
        state_.f()[feed.slot] += force;
        meter_.addFeed(k, force, state_);
      }
    }
  }

  Layout layout_;
  std::unique_ptr<CoefficientsOf<Real>> coefficients_;
  State<Real> state_;
  EnergyMeter<Real> meter_;
  Stepper<Real> stepper_;
  Points<Real> points_;
  GuardedRuns<Real> guarded_;
  Taps<Real> taps_;
  Sleeper<Real> sleeper_;
  std::vector<unsigned char> due_;  // [sections] in this frame
  scene::Scene followed_;           // where audio parameters have their present samples
  bool changed_ = false;            // coefficients were exchanged since the last tick
};

}  // namespace

std::unique_ptr<Instrument> compile(const scene::Scene& scene,
                                    const Rates& rates,
                                    const CompileOptions& options) {
  if (!isSettled(scene)) {
    throw Exception("scene '" + scene.name + "' is not settled: settle() comes before compile()");
  }
  Layout layout = makeLayout(scene, rates);
  if (options.precision == Precision::kFloat) {
    return std::make_unique<InstrumentOf<float>>(scene, rates, std::move(layout), options);
  }
  return std::make_unique<InstrumentOf<double>>(scene, rates, std::move(layout), options);
}

}  // namespace ergotic::physics
