// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

enum class Verdict {
  kPassive,   ///< stable for any motion
  kBounded,   ///< active but saturating elements (pluck, bow) over a passive network
  kUnproven,  ///< explicit where no bound holds: played only if asked
  kUnstable,  ///< refused
};
const char* toString(Verdict verdict);

/// One section under the explicit scheme: stable if `lambda` < 4.
struct SectionCertificate {
  int section = 0;
  double rate_hz = 0.0;
  double lambda = 0.0;        ///< upper bound of the largest eigenvalue of M^-1 (h^2 K + 2 h Z)
  double link_bound = 0.0;    ///< the cheaper bound, max over links of S_i/M_i + S_j/M_j
  int worst_lia = -1;         ///< link with the largest bound, -1: none (a cell, or no link)
  int worst_mat = -1;         ///< module with the largest bound, -1: none
  double stable_rate_hz = 0;  ///< lowest section rate at which the bound would be 4
};

struct Certificate {
  Verdict verdict = Verdict::kPassive;
  std::vector<SectionCertificate> sections;
  /// In plain words, worst first: what was found, where (`file:line:col`), what to change.
  std::vector<std::string> findings;
  double margin() const;  ///< 1 - max(lambda)/4, dimensionless; negative if unstable
};

/// Tells before running whether a scene can blow up at these rates.
///
/// Linear part: link bound, then 20 Collatz-Wielandt iterations, with every parameter at the worst
/// end of its range. Nonlinear links enter with their largest slope where it is bounded.
/// Coupled rates: the same bound at the slow step over slow masses, coupling links and the fast
/// masses that they touch.
/// Realtime: no. Cost: O(links).
/// Source: docs/physics.md, "Stability".
Certificate certify(const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
