// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

/// Coarse strings: few masses, with springs to three neighbours whose sum gives the partials of an
/// ideal string. Beyond the fixed ends the string is continued by its mirror image, so that the
/// modes stay sines.
///
/// With N moving masses 1...N and fixed ends 0 and N+1, the links are, in this order:
///   N+1  to the next neighbour, (0, 1), (1, 2) ... (N, N+1): stiffness k1 and the damping
///   N    to the second, (0, 2), (1, 3) ... (N-1, N+1): k2
///   N-1  to the third, (0, 3), (1, 4) ... (N-2, N+1): k3
///   3    of the mirror at the first end, (0, 1): 2 k2 + 2 k3, (0, 2): 2 k3, (1, 2): -k3
///   3    of the mirror at the last end, (N+1, N): 2 k2 + 2 k3, (N+1, N-1): 2 k3, (N, N-1): -k3
/// The mode n has then the stiffness 4 (k1 sin^2(t/2) + k2 sin^2(t) + k3 sin^2(3t/2)) with
/// t = n pi/(N+1). k2 is in general negative.
namespace ergotic::scene {

constexpr int kFewestCoarseMasses = 3;

constexpr int coarseLinks(int masses) {
  return 3 * masses + 6;
}

/// One link of a coarse string: its ends, counted from the first fixed one, and the weights of its
/// stiffness, sum of weights[i] k(i+1).
struct CoarseLink {
  int a = 0;
  int b = 0;
  std::array<double, 3> weights{};
  double stiffness(const std::array<double, 3>& k) const {
    return weights[0] * k[0] + weights[1] * k[1] + weights[2] * k[2];
  }
};

/// \param masses  N, at least kFewestCoarseMasses
/// \param index   0...coarseLinks(masses) - 1
CoarseLink coarseLink(int masses, int index);

}  // namespace ergotic::scene
