// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "physics/kernels/levels.hpp"
#include "physics/kernels/modal_kernels.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"

namespace ergotic::physics {

/// Points that are weighted sums of modules. All are real-time but the constructor.
/// Cost: O(modules of the tap)
template <class Real>
class Taps {
 public:
  Taps(const Layout& layout, rt::Isa isa)
      : layout_(layout), kernels_(kernels::kernelsOf<kernels::ModalKernels<Real>>(isa)) {
    for (const TapPoint& tap : layout.taps) {
      first_weight_.push_back(weights_.size());
      for (const double weight : tap.weights) {
        weights_.push_back(static_cast<Real>(weight));
      }
    }
  }

  /// Position and motion from those of the modules.
  void gather(std::size_t t, Real* x, Real* d) const noexcept {
    const TapPoint& tap = layout_.taps[t];
    for (int k = 0; k < tap.dimensions; ++k) {
      Real position = static_cast<Real>(k == 0 ? tap.offset : 0.0);
      Real velocity(0);
      forEachSpan(t, k, [&](const Real* weights, int first, int count) noexcept {
        Real sums[2] = {Real(0), Real(0)};
        if (count < kShort) {
          for (int i = 0; i < count; ++i) {
            sums[0] += weights[i] * x[first + i];
            sums[1] += weights[i] * d[first + i];
          }
        } else {
          kernels::ModalArguments<Real> modules{};
          modules.weights = weights;
          modules.count = count;
          modules.x = x + first;
          modules.d = d + first;
          kernels_.gather(modules, sums);
        }
        position += sums[0];
        velocity += sums[1];
      });
      x[tap.slot + k] = position;
      d[tap.slot + k] = velocity;
    }
  }

  /// Hands the force on a tap to its modules, if there is one. \param f  added to
  void scatter(std::size_t t, const Real* forces, Real* f) const noexcept {
    const TapPoint& tap = layout_.taps[t];
    for (int k = 0; k < tap.dimensions; ++k) {
      const Real force = forces[tap.slot + k];
      if (force != Real(0)) {
        forEachSpan(t, k, [&](const Real* weights, int first, int count) noexcept {
          kernels_.scatter(weights, count, force, f + first);
        });
      }
    }
  }

  /// How far a coordinate of the tap will go in the step to come.
  /// \param f  all forces on the modules
  Real stepAhead(std::size_t t,
                 int coordinate,
                 const MassCoefficients<Real>& c,
                 const Real* x,
                 const Real* d,
                 const Real* f) const noexcept {
    Real step(0);
    forEachSpan(t, coordinate, [&](const Real* weights, int first, int count) noexcept {
      step += kernels_.stepAhead({weights, count, x + first, d + first, f + first,
                                  c.lose.data() + first, c.pull.data() + first,
                                  c.inverse_mass.data() + first, c.drift.data() + first});
    });
    return step;
  }

 private:
  /// Sums of fewer modules have no lanes, and are taken here, in the order of the kernels.
  static constexpr int kShort = 16;

  /// Calls `visit(weights, slot of the first, count)` for modules that lie side by side.
  template <class Visit>
  void forEachSpan(std::size_t t, int coordinate, const Visit& visit) const noexcept {
    const TapPoint& tap = layout_.taps[t];
    const Real* weights = weights_.data() + first_weight_[t];
    for (const TapPoint::Span& span : tap.spans) {
      visit(weights, span.first + coordinate * tap.stride, span.count);
      weights += span.count;
    }
  }

  const Layout& layout_;
  const kernels::ModalKernels<Real>& kernels_;
  std::vector<Real> weights_;
  std::vector<std::size_t> first_weight_;  // [taps]
};

}  // namespace ergotic::physics
