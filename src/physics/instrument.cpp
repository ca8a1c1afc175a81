// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/instrument.hpp"

#include <algorithm>
#include <cmath>

#include "arena.hpp"
#include "coefficients.hpp"
#include "ergotic/exception.hpp"
#include "laws.hpp"
#include "layout.hpp"
#include "step_units.hpp"

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
  InstrumentOf(const scene::Scene& scene, const Rates& rates, Layout layout, Precision precision)
      : Instrument(scene, rates, precision),
        layout_(std::move(layout)),
        coefficients_(std::make_unique<CoefficientsOf<Real>>(scene, rates, layout_)),
        due_(layout_.sections.size(), 0),
        followed_(layout_.followers.empty() ? scene::Scene{} : scene) {
    const std::size_t slots = at(layout_.slots());
    clock_at_ = arena_.add<std::int64_t>("frame", 1);
    x_at_ = arena_.add<Real>("x", slots);
    d_at_ = arena_.add<Real>("d", slots);
    f_at_ = arena_.add<Real>("f", slots);
    held_at_ = arena_.add<Real>("held_force_outputs", layout_.taps.size());
    arena_.allocate();
    placeInitialState();
  }

  void tick(const TickIo& io) noexcept override {
    const std::int64_t first = frame();
    const bool is_first_tick = first == 0;
    takeSlices(io.positions, is_first_tick);
    const int channels_in = inputChannels();
    const int channels_out = outputChannels();
    for (int r = 0; r < rates().ratio; ++r) {
      const double* in = io.inputs + at(r) * at(channels_in);
      double* out = io.outputs + at(r) * at(channels_out);
      std::fill_n(out, channels_out, 0.0);
      frameStep(first + r, in, out);
    }
    frame() = first + rates().ratio;
    giveForces(io.forces);
  }

  std::unique_ptr<Coefficients> prepare(const std::vector<double>& values) const override {
    return std::make_unique<CoefficientsOf<Real>>(withParameters(scene(), values), rates(),
                                                  layout_);
  }

  std::unique_ptr<Coefficients> exchange(std::unique_ptr<Coefficients> next) noexcept override {
    auto* mine = static_cast<CoefficientsOf<Real>*>(next.release());
    std::unique_ptr<Coefficients> old = std::move(coefficients_);
    coefficients_.reset(mine);
    return old;
  }

  std::size_t stateSize() const noexcept override { return arena_.size(); }
  std::vector<StateEntry> stateEntries() const override { return arena_.entries(); }
  void saveState(void* to) const noexcept override { arena_.save(to); }
  void loadState(const void* from) noexcept override { arena_.load(from); }

  void readDisplacements(float* to) const noexcept override {
    const Real* x = arena_.template at<Real>(x_at_);
    for (std::size_t m = 0; m < layout_.slot_of_mat.size(); ++m) {
      to[m] = static_cast<float>(x[layout_.slot_of_mat[m]]);
    }
  }

  Energies makeEnergies() const override { return {}; }
  std::vector<GuardReport> makeGuardReports() const override { return {}; }
  void readEnergies(Energies&) const noexcept override {}
  void readGuards(std::vector<GuardReport>&) const noexcept override {}

  bool isFinite() const noexcept override {
    const Real* x = arena_.template at<Real>(x_at_);
    return std::all_of(x, x + layout_.slots(), [](Real v) { return std::isfinite(v); });
  }

 private:
  Real* x() noexcept { return arena_.at<Real>(x_at_); }
  Real* d() noexcept { return arena_.at<Real>(d_at_); }
  Real* f() noexcept { return arena_.at<Real>(f_at_); }
  std::int64_t& frame() noexcept { return *arena_.at<std::int64_t>(clock_at_); }

  void placeInitialState() {
    for (const SectionRange& range : layout_.sections) {
      const StepUnits units(scene(), rates(), range.divisor);
      for (int slot = range.cells; slot < range.end; ++slot) {
        const scene::Mat& mat = scene().mats[at(layout_.mat_of_slot[at(slot)])];
        x()[slot] = static_cast<Real>(mat.position.x() - mat.rest.x());
        if (slot < range.fixed) {
          d()[slot] = static_cast<Real>(units.velocity(mat.velocity.x()));
        }
      }
    }
  }

  /// Slices move at the start of a tick; a slice at 0 has its module at rest.
  void takeSlices(const double* positions, bool is_first_tick) noexcept {
    for (std::size_t p = 0; p < layout_.port_slots.size(); ++p) {
      const int slot = layout_.port_slots[p];
      const Real position = static_cast<Real>(positions[p]);
      // Before the first tick nothing is known of the hand: it did not jump, it was there.
      d()[slot] = is_first_tick ? Real(0) : position - x()[slot];
      x()[slot] = position;
    }
  }

  void giveForces(double* forces) noexcept {
    const double newton = 1.0 / (scene().time_unit_s * scene().time_unit_s);
    for (std::size_t p = 0; p < layout_.port_slots.size(); ++p) {
      forces[p] = newton * static_cast<double>(f()[layout_.port_slots[p]]);
    }
  }

  /// One audio frame: masses, position outputs, links, force inputs, force outputs.
  void frameStep(std::int64_t now, const double* in, double* out) noexcept {
    followAudio(in);
    for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
      due_[s] = now % layout_.sections[s].divisor == 0 ? 1 : 0;
      if (due_[s] != 0) {
        moveMasses(layout_.sections[s]);
      }
    }
    feedPositions(in);
    takePositions(out);
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      if (due_[at(layout_.runs[r].section)] != 0) {
        dispatch(layout_.runs[r], coefficients_->runs[r]);
      }
    }
    feedForces(in);
    takeForces(now, out);
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

  void moveMasses(const SectionRange& range) noexcept {
    Real* xs = x();
    Real* ds = d();
    Real* fs = f();
    const MassCoefficients<Real>& c = coefficients_->masses;
    const Real* inverse = c.inverse_mass.data();
    const Real* drift = c.drift.data();
    const Real* keep = c.keep.data();
    const Real* pull = c.pull.data();
    for (int i = range.cells; i < range.masses; ++i) {
      ds[i] = keep[i] * ds[i] - pull[i] * xs[i] + (inverse[i] * fs[i] + drift[i]);
      xs[i] += ds[i];
    }
    for (int i = range.masses; i < range.fixed; ++i) {
      ds[i] += inverse[i] * fs[i] + drift[i];
      xs[i] += ds[i];
    }
    std::fill(fs + range.cells, fs + range.end, Real(0));
  }

  void feedPositions(const double* in) noexcept {
    for (std::size_t k = 0; k < layout_.feeds.size(); ++k) {
      const Feed& feed = layout_.feeds[k];
      if (feed.quantity == scene::Quantity::kPosition && due_[at(feed.section)] != 0) {
        const double gain = static_cast<double>(coefficients_->feed_gains[k]);
        const Real position = static_cast<Real>(gain * in[feed.channel] - feed.rest);
        d()[feed.slot] = position - x()[feed.slot];
        x()[feed.slot] = position;
      }
    }
  }

  void feedForces(const double* in) noexcept {
    for (std::size_t k = 0; k < layout_.feeds.size(); ++k) {
      const Feed& feed = layout_.feeds[k];
      if (feed.quantity == scene::Quantity::kForce) {
        f()[feed.slot] += coefficients_->feed_gains[k] * static_cast<Real>(in[feed.channel]) *
                          static_cast<Real>(feed.share);
      }
    }
  }

  /// A quantity at a tap, between two modules if it lies there.
  double read(const Real* values, const Tap& tap) const noexcept {
    const double here = static_cast<double>(values[tap.slot]);
    if (tap.next < 0) {
      return here;
    }
    return here + tap.fraction * (static_cast<double>(values[tap.next]) - here);
  }

  void takePositions(double* out) noexcept {
    for (std::size_t k = 0; k < layout_.taps.size(); ++k) {
      const Tap& tap = layout_.taps[k];
      const double gain = static_cast<double>(coefficients_->tap_gains[k]);
      if (tap.quantity == scene::Quantity::kPosition) {
        out[tap.channel] += gain * (read(x(), tap) + tap.rest);
      } else if (tap.quantity == scene::Quantity::kVelocity) {
        out[tap.channel] += gain * tap.velocity * read(d(), tap);
      }
    }
  }

  /// The force on a slow module is whole only at the end of its step: it is held until the next.
  void takeForces(std::int64_t now, double* out) noexcept {
    Real* held = arena_.at<Real>(held_at_);
    for (std::size_t k = 0; k < layout_.taps.size(); ++k) {
      const Tap& tap = layout_.taps[k];
      if (tap.quantity != scene::Quantity::kForce) {
        continue;
      }
      if ((now + 1) % tap.divisor == 0) {
        held[k] = static_cast<Real>(read(f(), tap));
      }
      out[tap.channel] +=
          static_cast<double>(coefficients_->tap_gains[k]) * static_cast<double>(held[k]);
    }
  }

  void dispatch(const LinkRun& run, const RunCoefficients<Real>& c) noexcept {
    const laws::Fields<Real> fields{c.fields.data(), run.ends.size()};
    const laws::Tables<Real> tables{c.table_x.data(), c.table_y.data(), c.table_first.data(),
                                    c.table_count.data()};
    switch (run.law) {
      case Law::kSpringDamper:
        return apply(run, laws::SpringDamper<Real>{fields});
      case Law::kContact:
        return apply(run, laws::Contact<Real>{fields});
      case Law::kQuadratic:
        return apply(run, laws::Quadratic<Real>{fields});
      case Law::kCubic:
        return apply(run, laws::Cubic<Real>{fields});
      case Law::kClippedCubic:
        return apply(run, laws::ClippedCubic<Real>{fields});
      case Law::kCubicContact:
        return apply(run, laws::CubicContact<Real>{{fields}});
      case Law::kPluck:
        return apply(run, laws::Pluck<Real>{fields});
      case Law::kBow:
        return apply(run, laws::Bow<Real>{fields});
      case Law::kSmoothBow:
        return apply(run, laws::SmoothBow<Real>{fields});
      case Law::kPluckTable:
        return apply(run, laws::PluckTable<Real>{fields, tables});
      case Law::kBowTable:
        return apply(run, laws::BowTable<Real>{fields, tables});
    }
  }

  template <class LawType>
  void apply(const LinkRun& run, const LawType& law) noexcept {
    if (run.slow_section < 0) {
      applySameRate(run, law);
    } else {
      applyAcrossRates(run, law);
    }
  }

  template <class LawType>
  void applySameRate(const LinkRun& run, const LawType& law) noexcept {
    const Real* xs = x();
    const Real* ds = d();
    Real* fs = f();
    const LinkEnds* ends = run.ends.data();
    const std::size_t links = run.ends.size();
    for (std::size_t l = 0; l < links; ++l) {
      const int a = ends[l].a;
      const int b = ends[l].b;
      const Real force = law.force(l, xs[a] - xs[b], ds[a] - ds[b]);
      fs[a] -= force;
      fs[b] += force;
    }
  }

  /// Hold up, mean down: the held end moved, by its whole difference, only in the frame in which
  /// it stepped. Those two are adjoint, so the coupling neither makes nor eats energy on average.
  template <class LawType>
  void applyAcrossRates(const LinkRun& run, const LawType& law) noexcept {
    const Real fresh = due_[at(run.slow_section)] != 0 ? Real(1) : Real(0);
    const Real share = static_cast<Real>(run.share);
    const Real gate_a = run.slow_is_a ? fresh : Real(1);
    const Real gate_b = run.slow_is_a ? Real(1) : fresh;
    const Real share_a = run.slow_is_a ? share : Real(1);
    const Real share_b = run.slow_is_a ? Real(1) : share;
    const Real* xs = x();
    const Real* ds = d();
    Real* fs = f();
    for (std::size_t l = 0; l < run.ends.size(); ++l) {
      const int a = run.ends[l].a;
      const int b = run.ends[l].b;
      const Real force = law.force(l, xs[a] - xs[b], gate_a * ds[a] - gate_b * ds[b]);
      fs[a] -= share_a * force;
      fs[b] += share_b * force;
    }
  }

  Layout layout_;
  std::unique_ptr<CoefficientsOf<Real>> coefficients_;
  std::vector<unsigned char> due_;  // [sections] in this frame
  scene::Scene followed_;           // where audio parameters have their present samples
  Arena arena_;
  std::size_t clock_at_ = 0;
  std::size_t x_at_ = 0;
  std::size_t d_at_ = 0;
  std::size_t f_at_ = 0;
  std::size_t held_at_ = 0;
};

}  // namespace

std::unique_ptr<Instrument> compile(const scene::Scene& scene,
                                    const Rates& rates,
                                    Precision precision) {
  Layout layout = makeLayout(scene, rates);
  if (precision == Precision::kFloat) {
    return std::make_unique<InstrumentOf<float>>(scene, rates, std::move(layout), precision);
  }
  return std::make_unique<InstrumentOf<double>>(scene, rates, std::move(layout), precision);
}

}  // namespace ergotic::physics
