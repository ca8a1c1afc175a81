// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/hand_loop.hpp"
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

/// One section under the explicit scheme, which is stable if `lambda` < 4.
struct SectionCertificate {
  int section = 0;
  double rate_hz = 0.0;
  double lambda = 0.0;        ///< upper bound of the largest eigenvalue of M^-1 (h^2 K + 2 h Z)
  bool exact = false;         ///< `lambda` is that eigenvalue, to 1e-6 of it
  double link_bound = 0.0;    ///< the cheaper bound, max over links of S_i/M_i + S_j/M_j
  int worst_lia = -1;         ///< link that stresses it most, -1: none (a cell, or no link)
  int worst_mat = -1;         ///< module that is stressed most, -1: none
  double stable_rate_hz = 0;  ///< lowest section rate known to be stable; exact as `lambda` is
};

/// Loads that a hand meets at a port, along its coordinate, if a slice moves it by itself; all at
/// the device. Ports of agents have none. Ports with a slice that no end-effector takes are judged;
/// the others are left to station::judgeHands.
struct PortCertificate {
  int port = 0;                ///< index in Scene::ports
  double stiffness = 0.0;      ///< the largest, N/m
  double stiffness_limit = 0;  ///< largest that no hand makes unstable by itself, N/m
  double damping = 0.0;        ///< the largest, N s/m
  double damping_limit = 0.0;  ///< largest that no hand makes unstable by itself, N s/m
  double interpolated_stiffness =
      0.0;                            ///< of the largest, of what sees the slice interpolated, N/m
  double interpolated_damping = 0.0;  ///< the same, N s/m
  bool is_judged = false;             ///< the verdict and the findings count it
  HandLevel level = HandLevel::kSilent;  ///< judgement on a slice that moves it, judged or not
  std::string finding;  ///< in words, `file:line:col: error|warning: ...`; empty: nothing to say
};

inline HandLoad loadOf(const PortCertificate& met) {
  return {met.stiffness, met.damping, met.interpolated_stiffness, met.interpolated_damping};
}

struct Certificate {
  Verdict verdict = Verdict::kPassive;
  std::vector<SectionCertificate> sections;
  std::vector<PortCertificate> ports;
  /// Findings in plain words, worst first: what was found, where (`file:line:col`), what to change.
  std::vector<std::string> findings;
  double margin() const;  ///< 1 - max(lambda)/4, dimensionless; negative if unstable
};

/// Tells before running whether a scene can blow up at these rates.
///
/// Linear part: link bound, Collatz-Wielandt bound, then the exact eigenvalue by sparse LDL^T, with
/// every parameter at the worst end of its range and moving points at their worst places. Nonlinear
/// links enter with their largest slope where it is bounded; energy-stable ones make no energy.
/// Coupled rates: the eigenvalues of one period of the slowest section, up to 300 masses.
/// \param scene   settled
/// \param device  that it will be played on
/// Realtime: no. Cost: some tens of sparse factorisations, below 1 s for 7,000 masses; coupled
/// rates: the eigenvalues of twice as many numbers as there are masses, 0.5 s for 280. \throws
/// std::logic_error if `settle` has left something to choose Source: docs/physics/stability.md,
/// "How a scene is certified".
Certificate certify(const scene::Scene& scene, const Rates& rates, const DeviceTraits& device = {});

}  // namespace ergotic::physics
