// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/hand_loop.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// A slice that nobody holds, and the masses that hang on its links: other slices held, Euclidean
/// sections as scalar ones. A link of the slice that is not linear counts as the springs and
/// dampers that it can be, from what always holds to its steepest slope (at 1 mm, if that grows);
/// others count with what always holds, contacts open.
/// Realtime: no. Source: docs/physics.md, "At the device".
class FreeSlice {
 public:
  /// \param port  index in Scene::ports
  FreeSlice(const RatedNetwork& networks, int port);

  /// What hangs there moves by itself, and is few enough, at no slower rate, to be worked out.
  bool isJudged() const { return !cases_.empty(); }

  /// Largest absolute eigenvalue of a tick, at least 1, the worst of the present values of the
  /// parameters and both ends of their ranges. \pre isJudged()
  /// Cost: some 20 ms for 50 masses, four times that if a link of the slice is not linear
  double radius(const DeviceTraits& device) const;

 private:
  /// What a tick makes of the state of the masses, the last position of the slice and the present
  /// one, all of them lengths.
  struct Case {
    Eigen::MatrixXd state;     // [numbers][numbers + 1]
    Eigen::RowVectorXd force;  // on the slice, at the device, N
  };
  void addCases(const RatedNetwork& networks, int port, double part);
  Case caseOf(const scene::Scene& linear, const Rates& rates, double gain) const;
  double radius(const Case& one, const DeviceTraits& device) const;
  static bool isOfSlice(const Case& one, double radius);

  std::vector<Case> cases_;
  double tick_s_;
};

}  // namespace ergotic::physics
