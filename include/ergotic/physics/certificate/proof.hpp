// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/network/factor.hpp"

/// What proves a verdict, filled by those who judge. Source: docs/physics.md, "Proofs".
namespace ergotic::physics {

/// Of all that is computed at one rate, slower ends held.
struct RateProof {
  int divisor = 1;
  /// Of 4 (1 - 1e-6) I - M^-1/2 (h^2 K + 2 h Z) M^-1/2 at its stiffest, points that move left out.
  Factor limit;
  SignProof signs;
};

/// A quadratic form |G s|^2 that no period of an island raises by more than rounding: with s the
/// displacements of its modules and then what they are about to move by, m, G s becomes B G s.
struct PeriodProof {
  std::vector<double> parameters;  ///< values for which it holds, [Scene::parameters]
  int frames = 0;                  ///< of audio, in a period
  std::vector<int> modules;
  Eigen::MatrixXd form;  ///< G, shape (rows, 2 modules); of what a period keeps as it is, 0
  Eigen::MatrixXd turn;  ///< B, shape (rows, rows)
};

/// The rule by which a link that is not linear is vouched for.
struct LinkProof {
  int link = 0;      ///< in Scene::lias
  std::string rule;  ///< docs/physics.md names them
};

/// A place of a point: modules and their weights.
using PlaceProof = std::vector<std::pair<int, double>>;

struct Proof {
  /// All places that are judged, the worst among them, [Scene::connections], then [Scene::taps].
  std::vector<std::vector<PlaceProof>> places;
  std::vector<RateProof> rates;
  std::vector<PeriodProof> periods;
  /// Of islands that lose energy in every motion: of Z at its softest and for unit masses, less
  /// 1e-9 of its norm.
  std::vector<Factor> losses;
  std::vector<LinkProof> links;
};

}  // namespace ergotic::physics
