// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ergotic::test {

/// Ways of joining two rates that are not adjoint, so that energy is made. No instrument has them.
enum class Joining { kHoldLast, kHoldSum, kDecimateHold };

/// A slow mass on a spring to the ground, joined by a spring to a fast string with fixed ends.
/// Everything in units of the fast step and the mass of one module of the string.
struct JoinedMass {
  Joining joining = Joining::kHoldSum;
  int ratio = 14;           ///< R
  double slow_mass = 1.0;   ///< M
  double slow_kappa = 0.0;  ///< of its spring to the ground, (R h)^2 K / M
  double string_kappa = 0.9;
  double coupling = 0.0;  ///< stiffness
  int masses = 24;
  int at = 9;  ///< module of the string, from 0

  /// Largest kinetic energy over all energy at the start, of a slow mass that starts to move.
  /// Stops at 1e6.
  double growth(int periods) const;
};

/// Figures for which every way of joining two rates grows but a filtered one. The string has modes
/// above half the slower rate; where there can be a chaplet the slow mass can carry it.
inline JoinedMass joinedMass(int ratio, Joining joining = Joining::kHoldSum) {
  JoinedMass joined;
  joined.joining = joining;
  joined.ratio = ratio;
  switch (ratio) {
    case 2:
      joined.slow_mass = 20.0;
      joined.slow_kappa = 1.0;
      joined.string_kappa = 0.9;
      joined.coupling = 0.5;
      break;
    case 14:
      joined.slow_mass = 1e4;
      joined.slow_kappa = 2.33;
      joined.string_kappa = 0.13;
      joined.coupling = 0.7;
      break;
    default:
      joined.slow_mass = 1e4;
      joined.slow_kappa = 3.0;
      joined.string_kappa = 0.02;
      joined.coupling = 1.0;
  }
  return joined;
}

inline double JoinedMass::growth(int periods) const {
  const auto place = static_cast<std::size_t>(at);
  std::vector<double> x(static_cast<std::size_t>(masses), 0.0);
  std::vector<double> d(x.size(), 0.0);
  double slow_x = 0.0;
  double slow_d = 1.0;  // in one of its own steps
  const double start = 0.5 * slow_mass * slow_d * slow_d / (ratio * ratio);
  double largest = 0.0;
  for (int n = 0; n < periods && largest < 1e6; ++n) {
    const double seen = x[place];  // decimated
    double sum = 0.0;
    double last = 0.0;
    for (int r = 0; r < ratio; ++r) {
      last = coupling * (slow_x - (joining == Joining::kDecimateHold ? seen : x[place]));
      sum += last;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double left = i > 0 ? x[i - 1] : 0.0;
        const double right = i + 1 < x.size() ? x[i + 1] : 0.0;
        d[i] += string_kappa * (left - 2.0 * x[i] + right) + (i == place ? last : 0.0);
      }
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] += d[i];
      }
    }
    const double back = joining == Joining::kHoldSum ? sum : last;
    slow_d -= slow_kappa * slow_x + back * ratio * ratio / slow_mass;
    slow_x += slow_d;
    double kinetic = 0.5 * slow_mass * slow_d * slow_d / (ratio * ratio);
    for (const double v : d) {
      kinetic += 0.5 * v * v;
    }
    largest = std::max(largest, kinetic / start);
  }
  return largest;
}

}  // namespace ergotic::test
