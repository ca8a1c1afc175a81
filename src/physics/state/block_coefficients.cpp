// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>

#include "at.hpp"
#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/sparse_program.hpp"
#include "physics/state/coefficients.hpp"

namespace ergotic::physics {
namespace {

bool hasDifferent(const Block& block) {
  return std::any_of(block.segments.begin(), block.segments.end(),
                     [](const Block::Segment& segment) { return !segment.uniform; });
}

std::size_t placeOf(const Block& block, int element, int offset) {
  if (block.kind == Block::Kind::kChains) {
    return at(element);
  }
  const auto diagonal = std::find(block.offsets.begin(), block.offsets.end(), offset);
  return static_cast<std::size_t>(diagonal - block.offsets.begin()) *
             at(block.guard + block.elements) +
         at(block.guard + element);
}

}  // namespace

template <class Real>
void CoefficientsOf<Real>::fillBlocks(const scene::Scene& scene,
                                      const Rates& rates,
                                      const Layout& layout) {
  for (const Block& block : layout.blocks) {
    const StepUnits units(scene, rates, layout.sections[at(block.section)].divisor);
    BlockCoefficients<Real> to;
    for (const int l : block.reference) {
      to.uniform_k.push_back(
          static_cast<Real>(l < 0 ? 0.0 : scene.valueOf(scene.lias[at(l)].stiffness)));
      to.uniform_z.push_back(
          static_cast<Real>(l < 0 ? 0.0 : units.damping(scene.valueOf(scene.lias[at(l)].damping))));
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
    }
    blocks.push_back(std::move(to));
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (layout.runs[r].block >= 0) {
      fillBlock(layout, layout.runs[r], runs[r]);
    }
  }
}

/// Where the coefficients of a link lie; those of one diagonal and element add up.
template <class Real>
void CoefficientsOf<Real>::fillBlock(const Layout& layout,
                                     const LinkRun& run,
                                     const RunCoefficients<Real>& from) {
  const Block& block = layout.blocks[at(run.block)];
  BlockCoefficients<Real>& to = blocks[at(run.block)];
  const std::size_t links = run.ends.size();
  if (block.one_ratio) {
    to.ratio = from.fields[links] / from.fields[0];
  }
  for (std::size_t l = 0; l < links; ++l) {
    const Real k = from.fields[l];
    const Real z = from.fields[links + l];
    const int a = run.ends[l].a - block.first;
    const int b = run.ends[l].b - block.first;
    const int element = std::min(a, b);
    if (block.kind == Block::Kind::kSparse) {
      const SparseProgram::Sides& sides = block.program->sides[l];
      to.k[sides.a] = to.k[sides.b] = k;
      to.z[sides.a] = to.z[sides.b] = z;
    } else if (block.per_lane) {
      to.k[at(element % kLanes)] = k;
      to.z[at(element % kLanes)] = z;
    } else if (!to.k.empty()) {
      const std::size_t place = placeOf(block, element, std::abs(a - b));
      to.k[place] += k;
      if (!to.z.empty()) {
        to.z[place] += z;
      }
    }
    if (!to.bias.empty()) {
      const Real force = k * from.fields[2 * links + l];
      to.bias[at(a)] -= force;
      to.bias[at(b)] += force;
    }
  }
}

template void CoefficientsOf<float>::fillBlocks(const scene::Scene&, const Rates&, const Layout&);
template void CoefficientsOf<float>::fillBlock(const Layout&,
                                               const LinkRun&,
                                               const RunCoefficients<float>&);
template void CoefficientsOf<double>::fillBlocks(const scene::Scene&, const Rates&, const Layout&);
template void CoefficientsOf<double>::fillBlock(const Layout&,
                                                const LinkRun&,
                                                const RunCoefficients<double>&);

}  // namespace ergotic::physics
