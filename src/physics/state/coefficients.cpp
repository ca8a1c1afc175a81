// SPDX-License-Identifier: BSD-3-Clause
#include "physics/state/coefficients.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "at.hpp"
#include "ergotic/scene/table.hpp"
#include "physics/laws/oscillator.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

constexpr double kCreditSeconds = 0.1;  // of what a place may bring, in advance

/// Motion of a grid point along one way. A guide moves it in the guide's own step, or as the guide
/// is interpolated; an audio input in the step of the point, parameters between two ticks.
PlaceCoefficients::Way wayOf(const scene::Scene& scene,
                             const Rates& rates,
                             const scene::Connection::Way& way,
                             int section) {
  int glide = way.at.audio >= 0 ? divisorOf(scene.sections[at(section)], rates) : rates.ratio;
  if (way.guide >= 0) {
    const bool is_seen = isInterpolated(scene, rates, way.guide, section);
    const int steps = is_seen ? section : scene.mats[at(way.guide)].section;
    glide = divisorOf(scene.sections[at(steps)], rates);
  }
  return {scene.valueOf(way.at), way.scale, way.minimum, way.maximum, glide};
}

/// [mats] Sums of the explicit links that end there, at their steepest.
struct Ends {
  std::vector<double> stiffness;
  std::vector<double> damping;
};

Ends endsOf(const scene::Scene& scene) {
  Ends ends{std::vector<double>(scene.mats.size()), std::vector<double>(scene.mats.size())};
  for (const scene::Lia& lia : scene.lias) {
    if (lia.scheme == scene::Scheme::kEnergyStable) {
      continue;
    }
    const scene::Slopes slopes = scene::lawOf(lia.type).slopes(scene, lia);
    for (const int end : {lia.a, lia.b}) {
      ends.stiffness[at(end)] += std::max(0.0, slopes.stiffness.highest);
      ends.damping[at(end)] += std::max(0.0, slopes.damping.highest);
    }
  }
  return ends;
}

}  // namespace

template <class Real>
CoefficientsOf<Real>::CoefficientsOf(const scene::Scene& scene,
                                     const Rates& rates,
                                     const Layout& layout) {
  fillMasses(scene, rates, layout);
  fillPlaces(scene, rates, layout);
  runs.resize(layout.runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (layout.runs[r].block < 0) {
      fillRun(scene, rates, layout, r);
    }
  }
  fillBlocks(scene, rates, layout);
  fillEnergyStable(scene, rates, layout);
  for (const scene::Output& output : scene.outputs) {
    pickup_gains.push_back(static_cast<Real>(scene.valueOf(output.gain)));
  }
  for (const scene::Input& input : scene.inputs) {
    feed_gains.push_back(static_cast<Real>(scene.valueOf(input.gain)));
  }
}

template <class Real>
void CoefficientsOf<Real>::fillMasses(const scene::Scene& scene,
                                      const Rates& rates,
                                      const Layout& layout) {
  const std::size_t slots = at(layout.slots());
  masses.inverse_mass.assign(slots, Real(0));
  masses.drift.assign(slots, Real(0));
  masses.lose.assign(slots, Real(0));
  masses.pull.assign(slots, Real(0));
  masses.loss.assign(slots, Real(0));
  for (const SectionRange& range : layout.sections) {
    const StepUnits units(scene, rates, range.divisor);
    for (int slot = range.first; slot < range.fixed; ++slot) {
      const int mat = layout.mat_of_slot[at(slot)];
      if (mat >= 0 && scene.mats[at(mat)].type != scene::MatType::kGround) {
        setSlot(scene, units, layout, slot);
      }
    }
  }
  for (const TapPoint& tap : layout.taps) {
    double inverse = 0.0;
    forEachShare(tap, [&](int slot, double weight) {
      inverse += weight * weight * static_cast<double>(masses.inverse_mass[at(slot)]);
    });
    std::fill_n(masses.inverse_mass.begin() + tap.slot, tap.dimensions, static_cast<Real>(inverse));
  }
}

template <class Real>
void CoefficientsOf<Real>::setSlot(const scene::Scene& scene,
                                   const StepUnits& units,
                                   const Layout& layout,
                                   int slot) {
  const scene::Mat& mat = scene.mats[at(layout.mat_of_slot[at(slot)])];
  const scene::Section& section = scene.sectionOf(mat);
  const OscillatorCoefficients own = oscillatorOf(scene, mat, units);
  const double inverse = units.inverseMass(scene.valueOf(mat.mass));
  const int stride = layout.sections[at(mat.section)].stride;
  for (int c = 0; c < dimensionsOf(section.geometry); ++c) {
    const std::size_t here = at(slot + c * stride);
    double drift = mat.push->force[c] * inverse + units.acceleration(section.gravity[c]);
    if (section.geometry == scene::Geometry::kScalar) {
      drift -= own.pull * mat.rest.x();  // its spring ends at 0, wherever it rests
    }
    masses.inverse_mass[here] = static_cast<Real>(inverse);
    masses.lose[here] = static_cast<Real>(own.lose);
    masses.pull[here] = static_cast<Real>(own.pull);
    masses.drift[here] = static_cast<Real>(drift);
    masses.loss[here] = static_cast<Real>(own.lose / inverse);
  }
}

template <class Real>
void CoefficientsOf<Real>::fillPlaces(const scene::Scene& scene,
                                      const Rates& rates,
                                      const Layout& layout) {
  const Ends ends = layout.places.empty() ? Ends{} : endsOf(scene);
  for (const PlacePoint& point : layout.places) {
    const scene::Connection& from = scene.connections[at(point.connection)];
    const SectionRange& range = layout.sections[at(point.section)];
    const StepUnits units(scene, rates, range.divisor);
    PlaceCoefficients to;
    to.ways = {wayOf(scene, rates, from.along, point.section),
               wayOf(scene, rates, from.across, point.section)};
    to.speed = units.velocity(from.speed);
    const double energy = from.power * std::pow(scene.time_unit_s, 3.0);  // per time unit
    to.allowance = energy * units.step;
    to.credit = energy * kCreditSeconds / scene.time_unit_s;
    to.stiffness = ends.stiffness[at(from.mat)];
    to.resistance = ends.damping[at(from.mat)] / units.step;
    places.push_back(to);
  }
}

template <class Real>
void CoefficientsOf<Real>::setLink(
    const scene::Scene& scene, const StepUnits& units, const LinkRun& run, std::size_t r, int l) {
  const scene::Lia& lia = scene.lias[at(run.lias[at(l)])];
  const double rest = run.dimensions == 0 ? run.rests[at(l)].x() : 0.0;
  const scene::ExplicitForm& form = scene::lawOf(run.law).explicit_form;
  std::array<double, scene::ExplicitForm::kMaxNumbers> numbers{};
  form.convert({scene, lia, units, rest}, numbers.data());
  for (std::size_t i = 0; i < form.numbers; ++i) {
    const bool is_load = i < 2;  // of what a bend is made of: K, Z, where it rests
    runs[r].fields[i * run.lias.size() + at(l)] =
        is_load ? scene::inPrecision<Real>(scene, lia, numbers[i]) : static_cast<Real>(numbers[i]);
  }
}

template <class Real>
void CoefficientsOf<Real>::follow(const scene::Scene& scene,
                                  const Rates& rates,
                                  const Layout& layout,
                                  const Follower& follower) noexcept {
  const StepUnits units(scene, rates, layout.sections[at(follower.section)].divisor);
  if (follower.run == Follower::kModule) {
    setSlot(scene, units, layout, follower.index);
  } else if (follower.run == Follower::kPlace) {
    const scene::Connection& from =
        scene.connections[at(layout.places[at(follower.index)].connection)];
    places[at(follower.index)].ways[0].at = scene.valueOf(from.along.at);
    places[at(follower.index)].ways[1].at = scene.valueOf(from.across.at);
  } else {
    setLink(scene, units, layout.runs[at(follower.run)], at(follower.run), follower.index);
  }
}

template <class Real>
void CoefficientsOf<Real>::fillRun(const scene::Scene& scene,
                                   const Rates& rates,
                                   const Layout& layout,
                                   std::size_t r) {
  const LinkRun& run = layout.runs[r];
  const StepUnits units(scene, rates, layout.sections[at(run.section)].divisor);
  RunCoefficients<Real>& to = runs[r];
  to.fields.resize(scene::lawOf(run.law).explicit_form.numbers * run.lias.size());
  for (int l = 0; l < static_cast<int>(run.lias.size()); ++l) {
    setLink(scene, units, run, r, l);
    const scene::Lia& lia = scene.lias[at(run.lias[at(l)])];
    to.table.add(lia.law->table);
    to.viscous_table.add(lia.law->viscous_table);
  }
  for (int c = 0; c < run.dimensions; ++c) {
    for (const Eigen::Vector3d& rest : run.rests) {
      to.rests.push_back(static_cast<Real>(rest[c]));
    }
  }
}

template <class Real>
void CoefficientsOf<Real>::fillEnergyStable(const scene::Scene& scene,
                                            const Rates& rates,
                                            const Layout& layout) {
  for (const EnergyStableGroup& group : energyStableGroupsOf(layout)) {
    const StepUnits units(scene, rates, group.divisor);
    energy_stable.emplace_back();
    for (const EnergyStableRef& ref : group.links) {
      const scene::Lia& lia = scene.lias[at(layout.runs[ref.run].lias[ref.link])];
      energy_stable.back().push_back(EnergyStableLaw<Real>::make(scene, lia, units));
    }
  }
}

template <class Real>
void TableCoefficients<Real>::add(const scene::Table& table) {
  first.push_back(static_cast<int>(x.size()));
  count.push_back(static_cast<int>(table.points.size()));
  if (table.empty()) {
    return;
  }
  const scene::Curve curve = scene::interpolate(table);
  const auto push = [this](double from, std::initializer_list<double> numbers) {
    x.push_back(static_cast<Real>(from));
    for (const double number : numbers) {
      cubic.push_back(static_cast<Real>(number));
    }
  };
  for (const scene::CurvePiece& p : curve.pieces) {
    push(p.begin, {p.c0, p.c1, p.c2, p.c3});
  }
  push(curve.end, {curve.end_value, 0.0, 0.0, 0.0});
}

template class CoefficientsOf<float>;
template class CoefficientsOf<double>;

}  // namespace ergotic::physics
