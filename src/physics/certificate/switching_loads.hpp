// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Explicit links whose stiffness comes and goes: what a module feels is their sum.
class SwitchingLoads {
 public:
  /// Links whose scheme is open count, too. \param networks  must outlive it
  explicit SwitchingLoads(const RatedNetwork& networks);

  /// h^2 (K_a / Ma + K_b / Mb), with K_a and K_b the steepest slopes of all that may act on an end
  /// together; 0 if no force moves an end.
  double kappa(const scene::Lia& lia) const;
  /// The least damping with which a link loses more in a hit than its step may give, N s/m.
  double leastDamping(const scene::Lia& lia) const;
  /// True if it has that.
  bool losesMore(const scene::Lia& lia) const;

 private:
  double loadOn(int end) const;

  const RatedNetwork& networks_;
  std::vector<double> load_;  // [mats] h^2 K / M
};

}  // namespace ergotic::physics
