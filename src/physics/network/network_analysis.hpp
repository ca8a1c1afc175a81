// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "physics/network/network_bound.hpp"

namespace ergotic::physics {

/// How far a network is from its limit, by the cheapest means that tell.
struct NetworkAnalysis {
  double link_bound = 0.0;
  double lambda = 0.0;       ///< upper bound of the largest eigenvalue; to 1e-6 if `is_exact`
  double stable_step = 0.0;  ///< known to be stable up to here, time units
  int worst_link = -1;       ///< label
  int worst_owner = -1;
  bool is_exact = false;  ///< lambda is the eigenvalue
  bool is_bound = false;  ///< it may be stable although lambda >= 4: moving points at their worst
  bool is_too_large = false;  ///< the same, because the exact test was left out
  /// True if it is stable, also with its coefficients rounded to float.
  bool isProven() const { return lambda < kProven; }

  static constexpr double kRoundingOfFloat = 1e-6;  ///< of h^2 K/M and h Z/M, with some to spare
  static constexpr double kProven = NetworkBound::kLimit * (1.0 - kRoundingOfFloat);
};

/// Link bound; where that does not prove it, the bound of the cells of its grids, then 20
/// Collatz-Wielandt iterations. The exact test follows where it costs little, and where these prove
/// nothing and 60 power iterations do not refute it, but not in components of more than 200,000
/// nodes. Realtime: no.
NetworkAnalysis analyse(const NetworkBound& network);

/// Modules that are joined with a negative load, if the softest case of stiffness and of damping is
/// all the same positive definite there by 1e-6 of its norm; nullopt if not. The bounds above
/// suppose it to be positive semidefinite. Costs nothing unless something is negative.
std::optional<std::vector<int>> semidefiniteBesideNegative(const NetworkBound& network);

/// True if the softest case of damping takes energy from every motion: Z is positive definite.
bool losesInEveryMotion(const NetworkBound& network);

}  // namespace ergotic::physics
