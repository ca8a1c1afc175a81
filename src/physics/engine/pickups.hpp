// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Pickups: outputs that read positions, velocities or forces.
template <class Real>
class Pickups {
 public:
  explicit Pickups(const Layout& layout) : layout_(layout) {}

  /// \param out  [group.channels], here and below
  void takePositions(const Group& group,
                     const CoefficientsOf<Real>& c,
                     State<Real>& state,
                     double* out) const noexcept {
    for (std::size_t i = 0; i < group.pickups.size(); ++i) {
      out[group.pickup_columns[i]] += position(group.pickups[i], c, state);
    }
  }

  void takeForces(const Group& group,
                  const CoefficientsOf<Real>& c,
                  std::int64_t now,
                  State<Real>& state,
                  double* out) const noexcept {
    for (std::size_t i = 0; i < group.pickups.size(); ++i) {
      out[group.pickup_columns[i]] += force(group.pickups[i], c, now, state);
    }
  }

  /// Output of a pickup of a position or velocity; 0 for pickups of forces. Once in a frame.
  double position(std::size_t k, const CoefficientsOf<Real>& c, State<Real>& state) const noexcept {
    const Pickup& pickup = layout_.pickups[k];
    const double gain = static_cast<double>(c.pickup_gains[k]);
    switch (pickup.quantity) {
      case scene::Quantity::kPosition:
        return gain * (read(state.x(), pickup) + pickup.rest);
      case scene::Quantity::kVelocity:
        return gain * radiated(pickup, pickup.velocity * read(state.d(), pickup), state);
      default:
        return 0.0;
    }
  }

  /// Output of a pickup of a force; 0 for other pickups. The force on a slow module is complete
  /// only at the end of its step: it is held until the next.
  double force(std::size_t k,
               const CoefficientsOf<Real>& c,
               std::int64_t now,
               State<Real>& state) const noexcept {
    const Pickup& pickup = layout_.pickups[k];
    if (pickup.quantity != scene::Quantity::kForce) {
      return 0.0;
    }
    Real& last = state.lastForces()[k];
    if ((now + 1) % pickup.divisor == 0) {
      last = static_cast<Real>(read(state.f(), pickup));
    }
    return static_cast<double>(c.pickup_gains[k]) * static_cast<double>(last);
  }

  int slotOf(std::size_t k) const noexcept { return layout_.pickups[k].slot; }

 private:
  double radiated(const Pickup& pickup, double velocity, State<Real>& state) const noexcept {
    if (pickup.radiation < 0) {
      return velocity;
    }
    double& memory = state.radiated()[pickup.radiation];
    const double heard = 0.5 * (1.0 + pickup.pole) * velocity;
    const double sound = heard + memory;
    memory = pickup.pole * sound - heard;
    return sound;
  }

  /// A quantity at a pickup, between two modules if it lies there.
  double read(const Real* values, const Pickup& pickup) const noexcept {
    const double here = static_cast<double>(values[pickup.slot]);
    if (pickup.next < 0) {
      return here;
    }
    return here + pickup.fraction * (static_cast<double>(values[pickup.next]) - here);
  }

  const Layout& layout_;
};

}  // namespace ergotic::physics
