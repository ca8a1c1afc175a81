// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/sparse_program.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

/// Energies that follow from positions, steps and forces alone, in the scene's unit.
namespace ergotic::physics {

/// Calls `visit(slot)` for the modules that forces move, and for grounds in blocks.
template <class Visit>
void forEachFree(const SectionRange& range, const Visit& visit) noexcept {
  for (int k = 0; k < range.dimensions; ++k) {
    for (int slot = range.first; slot < range.fixed; ++slot) {
      visit(slot + k * range.stride);
    }
  }
}

/// M v^2 / 2 with the velocity of this instant: that of the last step and half of what the present
/// force adds.
template <class Real>
double kineticOf(const SectionRange& range,
                 const MassCoefficients<Real>& c,
                 const State<Real>& state) noexcept {
  double energy = 0.0;
  forEachFree(range, [&](int s) {
    const auto i = static_cast<std::size_t>(s);
    if (c.inverse_mass[i] == Real(0)) {
      return;  // a ground
    }
    const auto d = static_cast<double>(state.d()[s]);
    const auto x = static_cast<double>(state.x()[s]);
    const auto inverse = static_cast<double>(c.inverse_mass[i]);
    const double gain = inverse * static_cast<double>(state.f()[s]) +
                        static_cast<double>(c.drift[i]) - static_cast<double>(c.pull[i]) * x -
                        static_cast<double>(c.lose[i]) * d;
    energy += d * (d + gain) / inverse;
  });
  return 0.5 * energy;
}

/// Springs of cells, gravity and constant forces.
template <class Real>
double potentialOf(const SectionRange& range,
                   const MassCoefficients<Real>& c,
                   const State<Real>& state) noexcept {
  double energy = 0.0;
  forEachFree(range, [&](int s) {
    const auto i = static_cast<std::size_t>(s);
    if (c.inverse_mass[i] == Real(0)) {
      return;
    }
    const auto x = static_cast<double>(state.x()[s]);
    energy += x * (0.5 * static_cast<double>(c.pull[i]) * x - static_cast<double>(c.drift[i])) /
              static_cast<double>(c.inverse_mass[i]);
  });
  return energy;
}

/// K e^2 / 2, which scalar springs inside one section store exactly; those in the plane and in
/// space as long as e changes little in a step. \pre the law is kSpringDamper, no block has them
template <class Real>
double springsOf(const LinkRun& run,
                 const RunCoefficients<Real>& c,
                 const State<Real>& state) noexcept {
  const std::size_t links = run.ends.size();
  const Real* x = state.x();
  double energy = 0.0;
  for (std::size_t l = 0; l < links; ++l) {
    const LinkEnds& ends = run.ends[l];
    Real apart = x[ends.a] - x[ends.b];
    if (run.dimensions > 0) {
      Real square(0);
      for (int k = 0; k < run.dimensions; ++k) {
        const Real along = x[ends.a + k * run.stride_a] - x[ends.b + k * run.stride_b] +
                           c.rests[static_cast<std::size_t>(k) * links + l];
        square += along * along;
      }
      apart = std::sqrt(square);
    }
    const auto e = static_cast<double>(apart + c.fields[2 * links + l]);
    energy += static_cast<double>(c.fields[l]) * e * e;
  }
  return 0.5 * energy;
}

/// Indices of the coefficients of a link of a block.
struct BlockLink {
  std::size_t place = 0;     ///< sparse: the link; else as k lies, element by element
  std::size_t diagonal = 0;  ///< unless sparse: index of the diagonal
  int element = 0;           ///< unless sparse: index of the element
};

/// Calls `visit(link, slot of a, slot of b)` for the links of a block. \param run those links
template <class Real, class Visit>
void forEachLink(const Block& block,
                 const LinkRun& run,
                 const MassCoefficients<Real>& masses,
                 const Visit& visit) {
  if (block.kind == Block::Kind::kSparse) {
    for (std::size_t l = 0; l < run.ends.size(); ++l) {
      visit(BlockLink{l, 0, 0}, run.ends[l].a, run.ends[l].b);
    }
    return;
  }
  const Real* inverse_mass = masses.inverse_mass.data() + block.first;
  std::size_t place = 0;  // as k lies: after the guard, element by element
  for (std::size_t i = 0; i < block.offsets.size(); ++i) {
    place += static_cast<std::size_t>(block.guard);
    for (int e = 0; e < block.elements; ++e, ++place) {
      const int next = e + block.offsets[i];
      // Among what never moves there are no links, even where all have the same coefficients.
      if (next < block.elements && (inverse_mass[e] != Real(0) || inverse_mass[next] != Real(0))) {
        visit(BlockLink{place, i, e}, block.first + e, block.first + next);
      }
    }
  }
}

template <class Real>
Real stiffnessOf(const Block& block,
                 const BlockCoefficients<Real>& c,
                 const BlockLink& link) noexcept {
  return block.kind == Block::Kind::kSparse ? c.k[block.program->sides[link.place].a]
         : block.per_lane                   ? c.k[static_cast<std::size_t>(link.element % kLanes)]
         : c.k.empty()                      ? c.uniform_k[link.diagonal]
                                            : c.k[link.place];
}

/// Energy of the springs of a block. \param run  its links
template <class Real>
double springsOf(const Block& block,
                 const LinkRun& run,
                 const BlockCoefficients<Real>& c,
                 const MassCoefficients<Real>& masses,
                 const State<Real>& state) noexcept {
  double energy = 0.0;
  forEachLink(block, run, masses, [&](const BlockLink& link, int a, int b) {
    const Real apart = state.x()[a] - state.x()[b];
    const auto e = static_cast<double>(c.rest.empty() ? apart : apart + c.rest[link.place]);
    energy += static_cast<double>(stiffnessOf(block, c, link)) * e * e;
  });
  return 0.5 * energy;
}

}  // namespace ergotic::physics
