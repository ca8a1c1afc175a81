// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/hand_loop.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// A slice that nobody holds, and the masses that always hang on its links: contacts open, other
/// slices held, Euclidean sections as scalar ones.
/// Realtime: no. Source: docs/physics.md, "At the device".
class FreeSlice {
 public:
  /// \param links_of  [nodes] of the network
  /// \param port      index in Scene::ports
  FreeSlice(const RatedNetwork& networks, const std::vector<std::vector<int>>& links_of, int port);

  /// What hangs there moves by itself, and is few enough, at no slower rate, to be worked out.
  bool isJudged() const { return !cases_.empty(); }

  /// Largest absolute eigenvalue of a tick, the worst of the present values of the parameters and
  /// both ends of their ranges. \pre isJudged()
  /// Cost: some 20 ms for 50 masses
  double radius(const DeviceTraits& device) const;

 private:
  /// What a tick makes of the state of the masses, the last position of the slice and the present
  /// one, all of them lengths.
  struct Case {
    Eigen::MatrixXd state;     // [numbers][numbers + 1]
    Eigen::RowVectorXd force;  // on the slice, at the device, N
  };
  Case caseOf(const scene::Scene& linear, const Rates& rates, double gain) const;
  double radius(const Case& one, const DeviceTraits& device) const;

  std::vector<Case> cases_;
  double tick_s_;
};

}  // namespace ergotic::physics
