// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::tgr {

/// Does a model give out more energy than it may? Looks at the raw force of one slice, cut to what
/// the hand may meet, and at the hand's way. Realtime: yes
///
///   E <- min(E - F[n-1] (x[n] - x[n-1]) + supply, cap),   E < 0: E <- (1 - T / 1 s) E
///
/// F and x are the model's own, without the delays of the device, so that a passive model stays
/// above minus what it had stored, but for what sampling adds; the forgetting covers that. Under
/// the cut force no passive model can store more than the cap.
class EnergyDetector {
 public:
  struct Rules {
    double force_limit_n = 0.0;
    double limit_j = 0.0;   ///< given out
    double cap_j = 0.0;     ///< taken in
    double supply_w = 0.0;  ///< it may give
  };
  EnergyDetector(const Rules& rules, double tick_s) noexcept;

  /// \param force  N, raw, at this position
  /// \param dx     m, from the last position to this one
  /// \return false if too much was given out
  bool look(double force, double dx) noexcept;
  void forget() noexcept;
  double energy() const noexcept { return energy_; }  ///< J

 private:
  Rules rules_;
  double supply_j_;  // per tick
  double kept_;      // of what was given out
  double energy_ = 0.0;
  double last_force_ = 0.0;
};

}  // namespace ergotic::tgr
