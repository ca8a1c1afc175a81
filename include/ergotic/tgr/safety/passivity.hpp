// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace ergotic::tgr {

/// Never lets a force give out energy that its port does not have. Realtime: yes
///
///   F dx > max(Ep, 0):  F <- max(Ep, 0) / dx
///
/// with Ep = PortEnergy::predicted(dx). It only ever makes |F| smaller.
struct EnergyClamp {
  /// \param force     N
  /// \param dx        m, of the last tick, taken for that of the next
  /// \param energy_j  Ep
  static double limited(double force, double dx, double energy_j) noexcept {
    const double available = std::max(energy_j, 0.0);
    return force * dx > available ? available / dx : force;
  }
};

/// Damps a port that has given out energy (Hannaford & Ryu 2002). Realtime: yes
///
///   E < 0:  F <- F - alpha v,  alpha = min(-E / (T v^2), 0.15 m / T),  v = dx / T
class PassivityController {
 public:
  PassivityController(double mass_kg, double tick_s) noexcept
      : most_n_per_m_(kShare * mass_kg / (tick_s * tick_s)) {}

  /// \param force     N
  /// \param dx        m, of the last tick
  /// \param energy_j  E
  double damped(double force, double dx, double energy_j) const noexcept {
    if (energy_j >= 0.0 || dx == 0.0) {
      return force;
    }
    const double alpha_per_tick = std::min(-energy_j / (dx * dx), most_n_per_m_);
    return force - alpha_per_tick * dx;
  }

 private:
  static constexpr double kShare = 0.15;
  double most_n_per_m_;  // alpha / T
};

}  // namespace ergotic::tgr
