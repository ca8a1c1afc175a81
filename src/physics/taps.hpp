// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coefficients.hpp"
#include "layout.hpp"
#include "state.hpp"

namespace ergotic::physics {

/// What is heard.
template <class Real>
class Taps {
 public:
  explicit Taps(const Layout& layout) : layout_(layout) {}

  void takePositions(const CoefficientsOf<Real>& c,
                     State<Real>& state,
                     double* out) const noexcept {
    for (std::size_t k = 0; k < layout_.taps.size(); ++k) {
      const Tap& tap = layout_.taps[k];
      const double gain = static_cast<double>(c.tap_gains[k]);
      if (tap.quantity == scene::Quantity::kPosition) {
        out[tap.channel] += gain * (read(state.x(), tap) + tap.rest);
      } else if (tap.quantity == scene::Quantity::kVelocity) {
        out[tap.channel] += gain * tap.velocity * read(state.d(), tap);
      }
    }
  }

  /// The force on a slow module is whole only at the end of its step: it is held until the next.
  void takeForces(const CoefficientsOf<Real>& c,
                  std::int64_t now,
                  State<Real>& state,
                  double* out) const noexcept {
    Real* held = state.held();
    for (std::size_t k = 0; k < layout_.taps.size(); ++k) {
      const Tap& tap = layout_.taps[k];
      if (tap.quantity != scene::Quantity::kForce) {
        continue;
      }
      if ((now + 1) % tap.divisor == 0) {
        held[k] = static_cast<Real>(read(state.f(), tap));
      }
      out[tap.channel] += static_cast<double>(c.tap_gains[k]) * static_cast<double>(held[k]);
    }
  }

 private:
  /// A quantity at a tap, between two modules if it lies there.
  double read(const Real* values, const Tap& tap) const noexcept {
    const double here = static_cast<double>(values[tap.slot]);
    if (tap.next < 0) {
      return here;
    }
    return here + tap.fraction * (static_cast<double>(values[tap.next]) - here);
  }

  const Layout& layout_;
};

}  // namespace ergotic::physics
