// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "ergotic/physics/options.hpp"
#include "physics/kernels/block_kernels.hpp"
#include "physics/kernels/sparse_kernels.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/aligned.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Steps blocks: modules move, then the forces of the links among them are known.
template <class Real>
class Sweeper {
 public:
  Sweeper(const Layout& layout, const CompileOptions& options);

  /// Steps a block once; f is overwritten. Realtime: yes
  /// \return energy that cells, medium and dampers took in it; 0 if nobody asks (unmetered)
  double sweep(std::size_t block, const CoefficientsOf<Real>& c, State<Real>& state) const noexcept;

  /// Several steps of a block that nothing else touches meanwhile. Large lattices go in waves: band
  /// after band, and behind each the same bands of the next steps while they are in the cache.
  /// Calls `visit(step, first, last)` for ranges of slots at which all of that step is known.
  /// \return as sweep. Realtime: yes
  template <class Visit>
  double advance(std::size_t b,
                 int steps,
                 const CoefficientsOf<Real>& c,
                 State<Real>& state,
                 const Visit& visit) const noexcept {
    const Block& block = layout_.blocks[b];
    double lost = 0.0;
    if (!goesInWaves(block)) {
      for (int t = 0; t < steps; ++t) {
        lost += sweep(b, c, state);
        visit(t, block.first, block.first + block.elements);
      }
      return lost;
    }
    const int band = bandOf(block, kBandInWaves);
    const int at_once = std::max(2, kWave / band);
    for (int t = 0; t < steps; t += at_once) {
      lost += wave(b, band, t, std::min(steps, t + at_once), c, state, visit);
    }
    return lost;
  }

 private:
  // Elements whose forces follow while their positions are still in the first-level cache.
  static constexpr int kBand = 128 * kLanes;
  // In waves the bands of all steps together, kWave, lie in the second-level cache.
  static constexpr int kBandInWaves = 64 * kLanes;
  static constexpr int kWave = 512 * kLanes;
  static constexpr int kFitsBytes = 1'000'000;  // into that cache, with room for others

  /// The arrays of a block from its first element on, and what its links are.
  struct Arrays;

  static bool goesInWaves(const Block& block) noexcept;
  /// Elements that move together: at least twice as many as a link can span.
  static int bandOf(const Block& block, int wanted) noexcept {
    return std::max(wanted, 2 * block.guard);
  }
  /// Elements whose forces are known once band number `index` has moved.
  static Block::Segment knownAfter(const Block& block, int band, int index) noexcept;

  /// Steps `from`...`to` - 1. A band moves once the one behind it knows its forces of the step
  /// before.
  template <class Visit>
  double wave(std::size_t b,
              int band,
              int from,
              int to,
              const CoefficientsOf<Real>& c,
              State<Real>& state,
              const Visit& visit) const noexcept {
    const Block& block = layout_.blocks[b];
    const int bands = (block.elements + band - 1) / band;
    const int steps = to - from;
    double lost = 0.0;
    for (int front = 0; front < bands + steps - 1; ++front) {
      for (int t = std::max(0, front - bands + 1); t < std::min(steps, front + 1); ++t) {
        const Block::Segment known = knownAfter(block, band, front - t);
        lost += sweepBand(b, band, front - t, c, state);
        visit(from + t, block.first + known.begin, block.first + known.end);
      }
    }
    return lost;
  }
  double sweepBand(std::size_t b,
                   int band,
                   int index,
                   const CoefficientsOf<Real>& c,
                   State<Real>& state) const noexcept;
  double stepBand(const Block& block,
                  const BlockCoefficients<Real>& c,
                  const Arrays& a,
                  int band,
                  int index) const noexcept;

  Arrays arraysOf(std::size_t block,
                  const CoefficientsOf<Real>& c,
                  State<Real>& state) const noexcept;
  double chains(const Block& block,
                const BlockCoefficients<Real>& c,
                const Arrays& a) const noexcept;
  double sparse(const Block& block,
                const BlockCoefficients<Real>& c,
                const Arrays& a) const noexcept;
  double lattice(const Block& block,
                 const BlockCoefficients<Real>& c,
                 const Arrays& a) const noexcept;
  double links(const Block& block,
               const BlockCoefficients<Real>& c,
               const Arrays& a,
               int begin,
               int end) const noexcept;
  double forces(const Block& block,
                const BlockCoefficients<Real>& c,
                const Arrays& a,
                const Block::Segment& range) const noexcept;
  kernels::LatticeArguments<Real> diagonalsOf(const Block& block,
                                              const BlockCoefficients<Real>& c,
                                              const Arrays& a,
                                              std::size_t from,
                                              bool uniform) const noexcept;
  kernels::PlateArguments<Real> plateOf(const Block& block,
                                        const BlockCoefficients<Real>& c,
                                        const Arrays& a) const noexcept;

  const Layout& layout_;
  const kernels::BlockKernels<Real>& kernels_;
  const kernels::SparseKernels<Real>& sparse_kernels_;
  rt::Isa isa_;
  bool metered_;
  mutable AlignedVector<Real> sums_;   // [slots] x + ratio d, known anew in each sweep
  mutable AlignedVector<Real> pairs_;  // [slots][2] x, d, where sparse kernels read them
};

extern template class Sweeper<float>;
extern template class Sweeper<double>;

}  // namespace ergotic::physics
