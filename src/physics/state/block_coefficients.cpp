// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "at.hpp"
#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/sparse_program.hpp"
#include "physics/state/coefficients.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/laws/explicit_form.hpp"

namespace ergotic::physics {
namespace {

bool hasDifferent(const Block& block) {
  return std::any_of(block.segments.begin(), block.segments.end(),
                     [](const Block::Segment& segment) { return !segment.uniform; });
}

/// Index of the coefficients of the link between elements a and b of a lattice or of chains.
std::size_t placeOf(const Block& block, int a, int b) {
  if (block.kind == Block::Kind::kChains) {
    return at(std::min(a, b));
  }
  const auto diagonal = std::find(block.offsets.begin(), block.offsets.end(), std::abs(a - b));
  return static_cast<std::size_t>(diagonal - block.offsets.begin()) *
             at(block.guard + block.elements) +
         at(block.guard + std::min(a, b));
}

scene::LinkInSteps inSteps(const scene::Scene& scene,
                           const scene::Lia& lia,
                           const StepUnits& units) {
  return {scene, lia, units, scene::restApart(scene, lia).x()};
}

/// A unit of force in whole multiples of which all sums of what links do at rest are exact: else
/// what is rounded would push a body that nothing holds, always the same way. 1 if there are none.
template <class Real>
double grainOf(const scene::Scene& scene,
               const StepUnits& units,
               const Block& block,
               const LinkRun& run) {
  std::vector<double> sums(at(block.elements), 0.0);
  for (std::size_t l = 0; l < run.ends.size(); ++l) {
    const scene::LinkInSteps link = inSteps(scene, scene.lias[at(run.lias[l])], units);
    const double force = std::abs(scene::number::stiffness(link) * scene::number::offset(link));
    sums[at(run.ends[l].a - block.first)] += force;
    sums[at(run.ends[l].b - block.first)] += force;
  }
  const double most = *std::max_element(sums.begin(), sums.end());
  return most > 0.0 ? std::ldexp(1.0, std::ilogb(most) + 2 - std::numeric_limits<Real>::digits)
                    : 1.0;
}

}  // namespace

template <class Real>
void CoefficientsOf<Real>::fillBlocks(const scene::Scene& scene,
                                      const Rates& rates,
                                      const Layout& layout) {
  for (const Block& block : layout.blocks) {
    const StepUnits units(scene, rates, layout.sections[at(block.section)].divisor);
    BlockCoefficients<Real> to;
    for (const std::vector<int>& links : block.reference) {
      Real k(0);
      Real z(0);
      for (const int l : links) {
        const scene::Lia& lia = scene.lias[at(l)];
        k += scene::inPrecision<Real>(scene, lia, scene.valueOf(lia.stiffness));
        z += scene::inPrecision<Real>(scene, lia, units.damping(scene.valueOf(lia.damping)));
      }
      to.uniform_k.push_back(k);
      to.uniform_z.push_back(z);
    }
    const std::size_t elements = at(block.elements);
    if (block.kind == Block::Kind::kSparse) {
      to.k.assign(block.program->slots() * kLanes, Real(0));
      to.z.assign(to.k.size(), Real(0));
    } else if (block.kind == Block::Kind::kChains) {
      to.k.assign(block.per_lane ? kLanes : elements, Real(0));
      to.z.assign(to.k.size(), Real(0));
    } else if (hasDifferent(block)) {
      to.k.assign(block.offsets.size() * (at(block.guard) + elements), Real(0));
      to.z.assign(block.one_ratio ? 0 : to.k.size(), Real(0));
    }
    if (block.has_bias) {
      to.bias.assign(elements, Real(0));
      to.rest.assign(block.kind == Block::Kind::kSparse
                         ? block.program->sides.size()
                         : block.offsets.size() * (at(block.guard) + elements),
                     Real(0));
    }
    blocks.push_back(std::move(to));
  }
  for (const LinkRun& run : layout.runs) {
    if (run.block >= 0) {
      const Block& block = layout.blocks[at(run.block)];
      fillBlock(scene, {scene, rates, layout.sections[at(block.section)].divisor}, block, run);
    }
  }
}

/// Adds the coefficients of a run to its block. Parallel links of a lattice are one spring, which
/// rests where their forces cancel.
template <class Real>
void CoefficientsOf<Real>::fillBlock(const scene::Scene& scene,
                                     const StepUnits& units,
                                     const Block& block,
                                     const LinkRun& run) {
  BlockCoefficients<Real>& to = blocks[at(run.block)];
  const Real grain =
      block.has_bias ? static_cast<Real>(grainOf<Real>(scene, units, block, run)) : Real(0);
  for (std::size_t l = 0; l < run.ends.size(); ++l) {
    const scene::Lia& lia = scene.lias[at(run.lias[l])];
    const scene::LinkInSteps link = inSteps(scene, lia, units);
    const Real k = scene::inPrecision<Real>(scene, lia, scene::number::stiffness(link));
    const Real z = scene::inPrecision<Real>(scene, lia, scene::number::damping(link));
    const Real offset = static_cast<Real>(scene::number::offset(link));
    const int a = run.ends[l].a - block.first;
    const int b = run.ends[l].b - block.first;
    if (l == 0 && block.one_ratio) {
      to.ratio = z / k;
    }
    if (block.kind == Block::Kind::kSparse) {
      const SparseProgram::Sides& sides = block.program->sides[l];
      to.k[sides.a] = to.k[sides.b] = k;
      to.z[sides.a] = to.z[sides.b] = z;
    } else if (block.per_lane) {
      to.k[at(std::min(a, b) % kLanes)] = k;
      to.z[at(std::min(a, b) % kLanes)] = z;
    } else if (!to.k.empty()) {
      const std::size_t place = placeOf(block, a, b);
      to.k[place] += k;
      if (!to.z.empty()) {
        to.z[place] += z;
      }
    }
    if (block.has_bias) {
      const Real force = grain * std::rint(k * offset / grain);
      to.bias[at(a)] -= force;
      to.bias[at(b)] += force;
    }
    if (block.has_bias && block.kind == Block::Kind::kSparse) {
      to.rest[l] = offset;
    } else if (block.has_bias && k != Real(0)) {
      const std::size_t place = placeOf(block, a, b);
      const Real together = to.k.empty() ? k : to.k[place];
      to.rest[place] += k / together * ((a < b ? offset : -offset) - to.rest[place]);
    }
  }
}

template void CoefficientsOf<float>::fillBlocks(const scene::Scene&, const Rates&, const Layout&);
template void CoefficientsOf<float>::fillBlock(const scene::Scene&,
                                               const StepUnits&,
                                               const Block&,
                                               const LinkRun&);
template void CoefficientsOf<double>::fillBlocks(const scene::Scene&, const Rates&, const Layout&);
template void CoefficientsOf<double>::fillBlock(const scene::Scene&,
                                                const StepUnits&,
                                                const Block&,
                                                const LinkRun&);

}  // namespace ergotic::physics
