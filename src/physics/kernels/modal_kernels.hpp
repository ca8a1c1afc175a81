// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Cells, modes among them, and the weighted sums of taps (taps.hpp). One translation unit
/// per level of vector instructions compiles the same source (modal_kernels.cpp); all give
/// the same bits.
namespace ergotic::physics::kernels {

/// The modes of one place, `count` in each array.
template <class Real>
struct ModalArguments {
  const Real* weights;
  int count;
  const Real* x;
  const Real* d;
  const Real* f;
  // The step to come is d <- d - (lose d + pull x) + inverse_mass f + drift.
  const Real* lose;
  const Real* pull;
  const Real* inverse_mass;
  const Real* drift;
};

/// Cells, `count` in each array. They move by d <- d - (lose d + pull x) + inverse_mass f + drift.
template <class Real>
struct CellArguments {
  int count;
  Real* x;
  Real* d;
  Real* d_last;
  const Real* f;
  const Real* lose;
  const Real* pull;
  const Real* inverse_mass;
  const Real* drift;
  const Real* loss;  ///< lose / inverse_mass; null: nobody asks
};

/// The kernels of one level. All are real-time.
template <class Real>
struct ModalKernels {
  /// Moves the cells by one step. \return twice the energy dissipated in it, 0 if there is no
  /// `loss`
  double (*step)(const CellArguments<Real>&) noexcept;
  /// sums[0] = weights . x, sums[1] = weights . d
  void (*gather)(const ModalArguments<Real>&, Real* sums) noexcept;
  /// f += weights force
  void (*scatter)(const Real* weights, int count, Real force, Real* f) noexcept;
  /// weights . the step to come
  Real (*stepAhead)(const ModalArguments<Real>&) noexcept;
};

}  // namespace ergotic::physics::kernels
