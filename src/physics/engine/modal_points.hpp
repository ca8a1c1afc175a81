// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "physics/kernels/levels.hpp"
#include "physics/kernels/modal_kernels.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"

namespace ergotic::physics {

/// Modules that are weighted sums of modes. All are real-time but the constructor.
template <class Real>
class ModalPoints {
 public:
  ModalPoints(const Layout& layout, rt::Isa isa)
      : layout_(layout), kernels_(kernels::kernelsOf<kernels::ModalKernels<Real>>(isa)) {
    for (const ModalPlace& point : layout.modal_places) {
      first_weight_.push_back(weights_.size());
      for (const double weight : point.weights) {
        weights_.push_back(static_cast<Real>(weight));
      }
    }
  }

  /// Position and motion from those of the modes. Cost: O(modes)
  void gather(std::size_t p, Real* x, Real* d) const noexcept {
    const ModalPlace& point = layout_.modal_places[p];
    kernels::ModalArguments<Real> modes = argumentsOf(p);
    modes.x = x + point.first;
    modes.d = d + point.first;
    Real sums[2];
    kernels_.gather(modes, sums);
    x[point.slot] = static_cast<Real>(point.offset) + sums[0];
    d[point.slot] = sums[1];
  }

  /// Hands the force on a point to its modes. Cost: O(modes) if there is one
  void scatter(std::size_t p, const Real* forces, Real* f) const noexcept {
    const ModalPlace& point = layout_.modal_places[p];
    if (forces[point.slot] != Real(0)) {
      kernels_.scatter(weightsOf(p), point.count, forces[point.slot], f + point.first);
    }
  }

  /// How far the point will go in the step to come. Cost: O(modes)
  /// \param f  all forces on the modes
  Real stepAhead(std::size_t p,
                 const MassCoefficients<Real>& c,
                 const Real* x,
                 const Real* d,
                 const Real* f) const noexcept {
    const int first = layout_.modal_places[p].first;
    kernels::ModalArguments<Real> modes = argumentsOf(p);
    modes.x = x + first;
    modes.d = d + first;
    modes.f = f + first;
    modes.lose = c.lose.data() + first;
    modes.pull = c.pull.data() + first;
    modes.inverse_mass = c.inverse_mass.data() + first;
    modes.drift = c.drift.data() + first;
    return kernels_.stepAhead(modes);
  }

 private:
  const Real* weightsOf(std::size_t p) const noexcept { return weights_.data() + first_weight_[p]; }
  kernels::ModalArguments<Real> argumentsOf(std::size_t p) const noexcept {
    kernels::ModalArguments<Real> modes{};
    modes.weights = weightsOf(p);
    modes.count = layout_.modal_places[p].count;
    return modes;
  }

  const Layout& layout_;
  const kernels::ModalKernels<Real>& kernels_;
  std::vector<Real> weights_;
  std::vector<std::size_t> first_weight_;  // [modal places]
};

}  // namespace ergotic::physics
