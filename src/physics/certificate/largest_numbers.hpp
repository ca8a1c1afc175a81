// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// How large the numbers become that a scene is played with: bounds by the energy it starts with,
/// by its weight, and by how far hands and inputs go. They are for numbers that single precision
/// cannot hold: close to the limit of stability, or in resonance, they may be some hundred times as
/// large.
class LargestNumbers {
 public:
  /// \param networks  must outlive this
  explicit LargestNumbers(const RatedNetwork& networks);

  /// Largest distance and slopes of a link if it alone holds all the energy.
  struct Steepest {
    double apart = 0.0;      ///< distance of its ends, m
    double stiffness = 0.0;  ///< kg/time_unit^2
    double damping = 0.0;    ///< kg/time_unit
  };
  Steepest steepestOf(const scene::Lia& lia) const;
  /// Largest force of a link, kg m/time_unit^2.
  double forceOf(const scene::Lia& lia) const;
  /// Largest energy that energy-stable links hold, kg m^2/time_unit^2.
  double energy() const;
  /// Largest distance of a module from the origin after so many seconds, m.
  double reach(double seconds) const;

 private:
  double stiffnessOf(const scene::Lia& lia, double elongation) const;
  double apartAtFirst(const scene::Lia& lia) const;

  const RatedNetwork& networks_;
  double farthest_ = 0.0;  // from the origin at the start, or where a hand goes, m
  double fastest_ = 0.0;   // at the start, m/time_unit
  double energy_ = 0.0;    // at the start
  double mass_ = 0.0;      // of all modules
  double weight_ = 0.0;    // of all modules, with what inputs push
  double fall_ = 0.0;      // the most that weight or an input speeds a module up, m/time_unit^2
  double leverage_ = 1.0;  // of taps, the largest either way
  double lightest_;        // kg
};

}  // namespace ergotic::physics
