// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

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
      out[group.tap_columns[i]] += position(group.taps[i], c, state);
    }
  }

  void takeForces(const Group& group,
                  const CoefficientsOf<Real>& c,
                  std::int64_t now,
                  State<Real>& state,
                  double* out) const noexcept {
    for (std::size_t i = 0; i < group.taps.size(); ++i) {
      out[group.tap_columns[i]] += force(group.taps[i], c, now, state);
    }
  }

  /// What is heard of a position or velocity; 0 at taps of forces.
  double position(std::size_t k,
                  const CoefficientsOf<Real>& c,
                  const State<Real>& state) const noexcept {
    const Tap& tap = layout_.taps[k];
    const double gain = static_cast<double>(c.tap_gains[k]);
    switch (tap.quantity) {
      case scene::Quantity::kPosition:
        return gain * (read(state.x(), tap) + tap.rest);
      case scene::Quantity::kVelocity:
        return gain * tap.velocity * read(state.d(), tap);
      default:
        return 0.0;
    }
  }

  /// What is heard of a force; 0 at other taps. That on a slow module is whole only at the end of
  /// its step: it is held until the next.
  double force(std::size_t k,
               const CoefficientsOf<Real>& c,
               std::int64_t now,
               State<Real>& state) const noexcept {
    const Tap& tap = layout_.taps[k];
    if (tap.quantity != scene::Quantity::kForce) {
      return 0.0;
    }
    Real& last = state.lastForces()[k];
    if ((now + 1) % tap.divisor == 0) {
      last = static_cast<Real>(read(state.f(), tap));
    }
    return static_cast<double>(c.tap_gains[k]) * static_cast<double>(last);
  }

  int slotOf(std::size_t k) const noexcept { return layout_.taps[k].slot; }

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
