// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "physics/layout/blocks/lanes.hpp"

/// Kernels of sweeps over blocks of consecutive slots. One translation unit per level of vector
/// instructions compiles the same source (block_kernels.cpp); all give the same bits, as nothing is
/// contracted and every sum keeps `kLanes` lanes.
namespace ergotic::physics::kernels {

/// Modules move: d <- d + inverse_mass f, or of cells d <- d - (lose d + pull x) + inverse_mass f +
/// drift; x <- x + d. All arrays are indexed by slot.
template <class Real>
struct MoveArguments {
  Real* x;
  Real* d;
  Real* d_last;  ///< d of the step before; null: nobody asks
  Real* y;       ///< x + ratio d; null: not needed
  Real ratio;
  const Real* f;
  const Real* inverse_mass;
  const Real* drift;  ///< null: none
  const Real* lose;   ///< null: no cells
  const Real* pull;
  const Real* loss;  ///< lose / inverse_mass
};

/// Forces of links that join s and s + offset, for all s, as assignment: f = sum K (u' - u) +
/// Z (d' - d) over both neighbours on each diagonal. u is x, or x + ratio d, then without Z.
template <class Real>
struct LatticeArguments {
  const Real* u;
  const Real* d;       ///< null: u has it all
  const Real* d_last;  ///< for `viscous` alone
  Real* f;
  int diagonals;
  std::ptrdiff_t offset[kMaxDiagonals];
  Real k[kMaxDiagonals];  ///< of uniform lattices
  Real z[kMaxDiagonals];
  const Real* ks[kMaxDiagonals];  ///< [slots] of the link that begins there; null: uniform
  const Real* zs[kMaxDiagonals];
  bool adds;  ///< to f, which other passes have written
};

/// Uniform plates: diagonals 1 and `pitch`, with corners also pitch - 1 and pitch + 1.
template <class Real>
struct PlateArguments {
  const Real* u;
  const Real* d;  ///< null: u has it all
  Real* f;
  std::ptrdiff_t pitch;
  bool corners;
  Real k_along, k_across, k_corner;
  Real z_along, z_across, z_corner;
};

/// Chains side by side, one per lane: modules move and the links of diagonal kLanes follow in the
/// same pass. Coefficients lie `stride` apart from row to row: 0, if they are those of a lane.
template <class Real>
struct ChainArguments {
  MoveArguments<Real> modules;  ///< y and drift of masses are not looked at
  Real* f;
  const Real* k;  ///< [rows or 1][kLanes] of the link to the next row
  const Real* z;
  std::ptrdiff_t stride;
};

/// The kernels of one level. Ranges are slots, multiples of kLanes. All are real-time.
template <class Real>
struct BlockKernels {
  /// \return twice the energy that cells dissipated, if d_last is asked for
  double (*move)(const MoveArguments<Real>&, std::ptrdiff_t first, std::ptrdiff_t last) noexcept;
  void (*lattice)(const LatticeArguments<Real>&,
                  std::ptrdiff_t first,
                  std::ptrdiff_t last) noexcept;
  void (*plate)(const PlateArguments<Real>&, std::ptrdiff_t first, std::ptrdiff_t last) noexcept;
  /// \return twice the energy that dampers took in the last step: sum Z v (v + v_last) over the
  /// links, worked out module by module
  double (*viscous)(const LatticeArguments<Real>&,
                    std::ptrdiff_t first,
                    std::ptrdiff_t last) noexcept;
  /// \return as of move and viscous together
  double (*chains)(const ChainArguments<Real>&, std::ptrdiff_t first, std::ptrdiff_t last) noexcept;
};

}  // namespace ergotic::physics::kernels
