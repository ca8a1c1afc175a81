// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "tools/lib/partials.hpp"

namespace ergotic::test {

/// The root with the positive angle of the recurrence x[n+1] = p x[n] - q x[n-1] that fits best.
/// One decaying mode moves by e^(i w - s), its frequency and decay per sample.
inline std::complex<double> poleOf(const std::vector<double>& x) {
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  double ac = 0.0;
  double bc = 0.0;
  for (std::size_t n = 1; n + 1 < x.size(); ++n) {
    aa += x[n] * x[n];
    ab += x[n] * x[n - 1];
    bb += x[n - 1] * x[n - 1];
    ac += x[n] * x[n + 1];
    bc += x[n - 1] * x[n + 1];
  }
  const double det = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / det;
  const double q = (ac * ab - bc * aa) / det;
  return (p + std::sqrt(std::complex<double>(p * p - 4.0 * q))) / 2.0;
}

using tools::cents;

/// Frequency of the partial of a sound next to `guess_hz`, see tools::partialAt.
inline double partialNear(const std::vector<double>& sound, double guess_hz, double rate_hz) {
  return tools::partialAt(sound, guess_hz, rate_hz).frequency_hz;
}

}  // namespace ergotic::test
