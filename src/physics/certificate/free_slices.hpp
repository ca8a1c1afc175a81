// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/hand_loop.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Slices that nobody holds, and the masses that hang on their links: each with the others held,
/// and all free that links join, Euclidean sections as scalar ones. A link of a slice that is not
/// linear counts as the springs and dampers that it can be, from what always holds to its steepest
/// slope (at 1 mm, if that grows); others count with what always holds, contacts open. Realtime:
/// no. Source: docs/physics.md, "At the device".
class FreeSlices {
 public:
  struct Group;

  /// \param networks  must outlive it
  explicit FreeSlices(const RatedNetwork& networks);

  /// Something hangs on a slice that moves by itself, and is few enough, at no slower rate, to be
  /// worked out.
  bool areJudged() const { return !cases_.empty(); }

  /// Largest absolute eigenvalue of a tick of what each slice is part of, at least 1, the worst of
  /// the present values of the parameters and both ends of their ranges. [mats]
  /// Cost: some 20 ms for 50 masses and each slice, three times that if its links are not linear
  std::vector<double> radii(const DeviceTraits& device) const;

 private:
  /// What a tick makes of the state of the masses, the last positions of the slices and the present
  /// ones, all of them lengths.
  struct Case {
    std::vector<int> slices;
    Eigen::MatrixXd state;   // [numbers][numbers + slices]
    Eigen::MatrixXd forces;  // [slices][numbers + slices] at the device, N
  };
  void addGroups(const scene::Scene& now, double part);
  void addCase(const scene::Scene& joined, const Group& group, double part);
  Case caseOf(const scene::Scene& linear) const;
  double radius(const Case& one, const DeviceTraits& device) const;
  static bool isOfSlices(const Case& one, double radius);

  const RatedNetwork& networks_;
  std::vector<Case> cases_;
  double tick_s_;
};

}  // namespace ergotic::physics
