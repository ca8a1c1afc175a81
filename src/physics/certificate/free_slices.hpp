// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/hand_loop.hpp"
#include "physics/certificate/attached.hpp"

namespace ergotic::physics {

/// Slices that nobody holds, and the masses that are attached to their links: each with the others
/// held, and all free that links join, Euclidean sections as scalar ones. A link of a slice that is
/// not linear counts as the springs and dampers that it can be, from what always holds to its
/// steepest slope (1 mm from the start, if that grows); others count with what always holds,
/// contacts open, and at their steepest, closed. Realtime: no. Source: docs/physics/stability.md,
/// "Passivity at the device".
class FreeSlices {
 public:
  struct Parts;

  /// \param networks  must outlive it
  explicit FreeSlices(const RatedNetwork& networks);

  /// True if a module that moves by itself is attached to a slice, and is worked out.
  bool areJudged() const { return !cases_.empty(); }
  /// Names what is attached to a slice but is not worked out; nullptr: nothing.
  const char* leftOut(int slice) const { return left_out_[static_cast<std::size_t>(slice)]; }

  /// Spectral radius, over a tick, of the network that each slice is part of, at least 1; the
  /// largest at some positions in the ranges of parameters and led points, see parameterCases().
  /// [mats]
  /// Cost: some 20 ms for 50 masses and each slice, six times that if its links are not linear
  std::vector<double> radii(const DeviceTraits& device) const;

 private:
  /// One tick as a linear map of the state of the masses, the last positions of the slices and the
  /// present ones, all of them lengths.
  struct Case {
    std::vector<int> slices;
    Eigen::MatrixXd state;   // [numbers][numbers + slices]
    Eigen::MatrixXd forces;  // [slices][numbers + slices] at the device, N
  };
  void addBody(const Attached& body);
  void addAll(const std::vector<int>& slices, const scene::Scene& now, const Parts& parts);
  void add(const scene::Scene& joined, const Attached& attached, const Parts& parts);
  Case caseOf(const scene::Scene& linear) const;
  double radius(const Case& one, const DeviceTraits& device) const;
  static double heldRadius(const Case& one);
  static bool isOfSlices(const Case& one, double radius);

  const RatedNetwork& networks_;
  std::vector<Case> cases_;
  double tick_s_;
  std::vector<const char*> left_out_;  // [mats]
};

}  // namespace ergotic::physics
