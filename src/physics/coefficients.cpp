// SPDX-License-Identifier: BSD-3-Clause
#include "coefficients.hpp"

#include <array>

#include "laws.hpp"

namespace ergotic::physics {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The fields of one link, in the order that laws.hpp reads them.
struct LinkFields {
  std::array<double, 7> values{};
  std::size_t count = 0;
};

LinkFields fieldsOf(const scene::Scene& scene, const scene::Lia& lia, const StepUnits& units) {
  const double k = scene.valueOf(lia.stiffness);
  const double z = units.damping(scene.valueOf(lia.damping));
  const double width = scene.valueOf(lia.width);
  const double q = scene.valueOf(lia.nonlinearity);
  const double k_limit = scene.valueOf(lia.stiffness_limit);
  const double z_limit = z + units.damping(scene.valueOf(lia.limit_damping));
  // Displacements are stored from rest: the distance at rest is folded into the elongation.
  const double offset =
      scene.mats[at(lia.a)].rest.x() - scene.mats[at(lia.b)].rest.x() - lia.rest_length;
  switch (lawOf(lia)) {
    case Law::kSpringDamper:
    case Law::kPluckTable:
      return {{k, z, offset}, 3};
    case Law::kContact:
      return {{k, z, offset + width}, 3};
    case Law::kQuadratic:
    case Law::kCubic:
      return {{k, z, offset, q}, 4};
    case Law::kClippedCubic:
      return {{k, z, offset, q, k_limit, z_limit, lia.tipping_point}, 7};
    case Law::kCubicContact:
      return {{k, z, offset + width, q, k_limit, z_limit, lia.tipping_point}, 7};
    case Law::kPluck:
      return {{k, z, offset, width}, 4};
    case Law::kBow:
      return {{z, units.velocity(width)}, 2};
    case Law::kSmoothBow:
      return {{z, 1.0 / units.velocity(width)}, 2};
    case Law::kBowTable:
      return {{1.0 / units.step}, 1};
  }
  return {};
}

std::size_t fieldCount(Law law) {
  switch (law) {
    case Law::kSpringDamper:
      return laws::SpringDamper<double>::kFields;
    case Law::kContact:
      return laws::Contact<double>::kFields;
    case Law::kQuadratic:
      return laws::Quadratic<double>::kFields;
    case Law::kCubic:
      return laws::Cubic<double>::kFields;
    case Law::kClippedCubic:
      return laws::ClippedCubic<double>::kFields;
    case Law::kCubicContact:
      return laws::CubicContact<double>::kFields;
    case Law::kPluck:
      return laws::Pluck<double>::kFields;
    case Law::kBow:
      return laws::Bow<double>::kFields;
    case Law::kSmoothBow:
      return laws::SmoothBow<double>::kFields;
    case Law::kPluckTable:
      return laws::PluckTable<double>::kFields;
    case Law::kBowTable:
      return laws::BowTable<double>::kFields;
  }
  return 0;
}

}  // namespace

template <class Real>
CoefficientsOf<Real>::CoefficientsOf(const scene::Scene& scene,
                                     const Rates& rates,
                                     const Layout& layout) {
  fillMasses(scene, rates, layout);
  runs.resize(layout.runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    fillRun(scene, rates, layout, r);
  }
  for (const scene::Output& output : scene.outputs) {
    tap_gains.push_back(static_cast<Real>(scene.valueOf(output.gain)));
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
  masses.keep.assign(slots, Real(1));
  masses.pull.assign(slots, Real(0));
  for (const SectionRange& range : layout.sections) {
    const StepUnits units(scene, rates, range.divisor);
    for (int slot = range.cells; slot < range.fixed; ++slot) {
      setSlot(scene, units, layout, slot);
    }
  }
}

template <class Real>
void CoefficientsOf<Real>::setSlot(const scene::Scene& scene,
                                   const StepUnits& units,
                                   const Layout& layout,
                                   int slot) {
  const scene::Mat& mat = scene.mats[at(layout.mat_of_slot[at(slot)])];
  const double inverse = units.inverseMass(scene.valueOf(mat.mass));
  double drift =
      mat.force.x() * inverse + units.acceleration(scene.sections[at(mat.section)].gravity.x());
  if (mat.type == scene::MatType::kCell) {
    const double pull = scene.valueOf(mat.stiffness) * inverse;
    const double loss = units.damping(scene.valueOf(mat.damping)) * inverse;
    masses.keep[at(slot)] = static_cast<Real>(1.0 - loss);
    masses.pull[at(slot)] = static_cast<Real>(pull);
    drift -= pull * mat.rest.x();
  }
  masses.inverse_mass[at(slot)] = static_cast<Real>(inverse);
  masses.drift[at(slot)] = static_cast<Real>(drift);
}

template <class Real>
void CoefficientsOf<Real>::setLink(
    const scene::Scene& scene, const StepUnits& units, const LinkRun& run, std::size_t r, int l) {
  const LinkFields from = fieldsOf(scene, scene.lias[at(run.lias[at(l)])], units);
  for (std::size_t f = 0; f < from.count; ++f) {
    runs[r].fields[f * run.lias.size() + at(l)] = static_cast<Real>(from.values[f]);
  }
}

template <class Real>
void CoefficientsOf<Real>::follow(const scene::Scene& scene,
                                  const Rates& rates,
                                  const Layout& layout,
                                  const Follower& follower) noexcept {
  const StepUnits units(scene, rates, layout.sections[at(follower.section)].divisor);
  if (follower.run < 0) {
    setSlot(scene, units, layout, follower.index);
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
  to.fields.resize(fieldCount(run.law) * run.lias.size());
  for (int l = 0; l < static_cast<int>(run.lias.size()); ++l) {
    setLink(scene, units, run, r, l);
    const scene::Lia& lia = scene.lias[at(run.lias[at(l)])];
    to.table_first.push_back(static_cast<int>(to.table_x.size()));
    to.table_count.push_back(static_cast<int>(lia.table.points.size()));
    for (const auto& [x, y] : lia.table.points) {
      to.table_x.push_back(static_cast<Real>(x));
      to.table_y.push_back(static_cast<Real>(y));
    }
  }
}

template class CoefficientsOf<float>;
template class CoefficientsOf<double>;

}  // namespace ergotic::physics
