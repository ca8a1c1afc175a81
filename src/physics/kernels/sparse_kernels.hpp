// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "ergotic/rt/isa.hpp"

/// Kernels of sweeps over irregular networks (sparse_program.hpp). One translation unit per level
/// of vector instructions compiles the same source (sparse_kernels.cpp); all give the same bits.
namespace ergotic::physics::kernels {

/// Forces of links as assignment: f = sum K (x' - x) + Z (d' - d) over the neighbours of each node.
/// Arrays of nodes begin with the first node of the program, have SparseProgram::reach() elements,
/// and begin best with a cache line.
template <class Real>
struct SparseArguments {
  const std::uint32_t* first_window;  ///< as in SparseProgram
  const std::uint32_t* first_pick;
  const std::uint32_t* window;
  const std::uint8_t* lane;
  const std::uint32_t* pick;
  const std::uint16_t* present;
  Real k;  ///< of uniform networks
  Real z;
  const Real* ks;  ///< [slots][16], begins with a cache line; null: uniform
  const Real* zs;
  const Real* x;
  const Real* d;
  const Real* d_last;  ///< d of the step before; null: nobody asks
  const Real* pairs;   ///< [nodes][2] x, d, where sparseNeedsPairs
  Real* f;
};

/// The kernels of one level, for nodes of groups first...last-1. All are real-time.
template <class Real>
struct SparseKernels {
  /// \return if d_last is there, twice the energy that dampers took in the last step: sum
  /// Z v (v + v_last) over the links, half of it with either end
  double (*forces)(const SparseArguments<Real>&, int first, int last) noexcept;
  /// Fills pairs from x and d.
  void (*pair)(const SparseArguments<Real>&, Real* pairs, int first, int last) noexcept;
};

/// True if `forces` reads pairs, which must then be filled for all nodes before. AVX-512 picks
/// neighbours in windows from registers; all others come from memory, x and d at one go.
inline bool sparseNeedsPairs(rt::Isa isa, std::size_t picks) noexcept {
  return isa != rt::Isa::kAvx512 || picks > 0;
}

}  // namespace ergotic::physics::kernels
