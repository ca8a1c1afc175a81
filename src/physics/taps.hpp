// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coefficients.hpp"
#include "groups.hpp"
#include "layout.hpp"
#include "state.hpp"

namespace ergotic::physics {

/// What is heard.
template <class Real>
class Taps {
 public:
  explicit Taps(const Layout& layout) : layout_(layout) {}

  /// \param out  [group.channels], here and below
  void takePositions(const Group& group,
                     const CoefficientsOf<Real>& c,
                     const State<Real>& state,
                     double* out) const noexcept {
    for (std::size_t i = 0; i < group.taps.size(); ++i) {
      const Tap& tap = layout_.taps[group.taps[i]];
      const double gain = static_cast<double>(c.tap_gains[group.taps[i]]);
      if (tap.quantity == scene::Quantity::kPosition) {
        out[group.tap_columns[i]] += gain * (read(state.x(), tap) + tap.rest);
      } else if (tap.quantity == scene::Quantity::kVelocity) {
        out[group.tap_columns[i]] += gain * tap.velocity * read(state.d(), tap);
      }
    }
  }

  /// The force on a slow module is whole only at the end of its step: it is held until the next.
  void takeForces(const Group& group,
                  const CoefficientsOf<Real>& c,
                  std::int64_t now,
                  State<Real>& state,
                  double* out) const noexcept {
    for (std::size_t i = 0; i < group.taps.size(); ++i) {
      const std::size_t k = group.taps[i];
      const Tap& tap = layout_.taps[k];
      if (tap.quantity != scene::Quantity::kForce) {
        continue;
      }
      Real& held = state.held()[k];
      if ((now + 1) % tap.divisor == 0) {
        held = static_cast<Real>(read(state.f(), tap));
      }
      out[group.tap_columns[i]] += static_cast<double>(c.tap_gains[k]) * static_cast<double>(held);
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
