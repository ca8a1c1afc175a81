// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::tgr {

/// Detects whether a model gives out more energy than it may. It takes the raw force of one slice,
/// cut to what the hand may meet, and the hand's path. Realtime: yes
///
///   E <- min(E - F[n-1] dx + supply, limit of F times range of x),   dx = x[n] - x[n-1]
///
/// F and x are the model's own, without the delays of the device, so that a passive model stays
/// above minus what it had stored, but for what sampling adds. Within a second it forgets what was
/// given out, and of what was taken in all but `cap_j` and |F| |x - x0|: the most that any spring
/// can have stored since the force was last 0, at x0. After `restart` it starts from that value if
/// F points to x0, as the energy that the model stored meanwhile is unknown.
class EnergyDetector {
 public:
  struct Rules {
    double force_limit_n = 0.0;
    double range_m = 0.0;
    double limit_j = 0.0;   ///< limit of the energy that the model gives out
    double cap_j = 0.0;     ///< limit of the remembered intake, without what a spring stores
    double supply_w = 0.0;  ///< permitted supply of the model itself
  };
  EnergyDetector(const Rules& rules, double tick_s) noexcept;

  /// \param force  N, raw, at this position
  /// \param dx     m, from the last position to this one
  /// \return false if too much was given out
  bool look(double force, double dx) noexcept;
  /// The next look judges nothing.
  void restart() noexcept { anew_ = true; }
  void forget() noexcept;
  double energy() const noexcept { return energy_; }  ///< J

 private:
  Rules rules_;
  double supply_j_;  // per tick
  double kept_;      // of what is forgotten, per tick
  double most_j_;    // taken in
  double energy_ = 0.0;
  double way_ = 0.0;  // since the force was 0, m
  double last_force_ = 0.0;
  bool anew_ = false;
};

}  // namespace ergotic::tgr
