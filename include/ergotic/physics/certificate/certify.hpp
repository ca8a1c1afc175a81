// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

struct Proof;  // ergotic/physics/certificate/proof.hpp

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
  bool exact = false;         ///< `lambda` is that eigenvalue, to 1e-6 of it
  double link_bound = 0.0;    ///< the cheaper bound, max over links of S_i/M_i + S_j/M_j
  int worst_lia = -1;         ///< link that stresses it most, -1: none (a cell, or no link)
  int worst_mat = -1;         ///< module that is stressed most, -1: none
  double stable_rate_hz = 0;  ///< lowest section rate known to be stable; exact as `lambda` is
};

/// What a hand meets at a port, along its coordinate, if a slice moves it by itself. Ports of
/// agents have none. Findings are on ports with a slice; end-effectors are for
/// tgr::renderedStiffness.
struct PortCertificate {
  int port = 0;             ///< index in Scene::ports
  double stiffness = 0.0;   ///< the largest, at the device, N/m
  double limit = 0.0;       ///< passive below, N/m
  bool is_refused = false;  ///< a slice moves it, and it is above twice the limit
};

struct Certificate {
  Verdict verdict = Verdict::kPassive;
  std::vector<SectionCertificate> sections;
  std::vector<PortCertificate> ports;
  /// In plain words, worst first: what was found, where (`file:line:col`), what to change.
  std::vector<std::string> findings;
  double margin() const;  ///< 1 - max(lambda)/4, dimensionless; negative if unstable
};

/// What passivity at the ports depends on.
struct DeviceTraits {
  double damping = 2.0;      ///< of each slice by itself, N s/m, > 0
  double delay_ticks = 1.0;  ///< from a position to the force that answers it
  /// Indices in Scene::ports: their slice does not move them by itself, whatever the scene says.
  std::vector<int> taken_ports = {};
};

/// Tells before running whether a scene can blow up at these rates.
///
/// Linear part: link bound, Collatz-Wielandt bound, then the exact eigenvalue by sparse LDL^T, with
/// every parameter at the worst end of its range and moving points at their worst places. Nonlinear
/// links enter with their largest slope where it is bounded; guarded ones make no energy.
/// Coupled rates: the eigenvalues of one period of the slowest section, up to 300 masses.
/// \param scene   settled
/// \param device  that it will be played on
/// \param proof   takes what proves the verdict, if it is passive or bounded; nullptr: not wanted
/// Realtime: no. Cost: some tens of sparse factorisations, below 1 s for 7,000 masses; coupled
/// rates: the eigenvalues of twice as many numbers as there are masses, 0.5 s for 280. \throws
/// std::logic_error if `settle` has left something to choose Source: docs/physics.md, "Stability".
Certificate certify(const scene::Scene& scene,
                    const Rates& rates,
                    const DeviceTraits& device = {},
                    Proof* proof = nullptr);

}  // namespace ergotic::physics
