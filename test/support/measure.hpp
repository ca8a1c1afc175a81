// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <complex>
#include <vector>

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

/// Frequency of the partial of a sound next to `guess_hz`: how far its phase turns in 100 samples,
/// through a window of half a second whose side lobes fall below 1e-12 within 50 Hz.
/// \pre at least 0.5 s and 100 samples of sound; other partials at least 50 Hz away
inline double partialNear(const std::vector<double>& sound, double guess_hz, double rate_hz) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr std::size_t kLater = 100;
  const auto length = static_cast<std::size_t>(rate_hz / 2.0);
  const double omega = 2.0 * kPi * guess_hz / rate_hz;
  std::complex<double> first;
  std::complex<double> later;
  for (std::size_t k = 0; k < length; ++k) {
    const double place = static_cast<double>(k);
    const double window = std::pow(std::sin(kPi * place / static_cast<double>(length)), 8.0);
    const std::complex<double> turn = std::polar(window, -omega * place);
    first += turn * sound[k];
    later += turn * sound[k + kLater];
  }
  const double expected = omega * static_cast<double>(kLater);
  const double beyond = std::arg(later / first * std::polar(1.0, -expected));
  return guess_hz * (1.0 + beyond / expected);
}

/// How far a is above b.
inline double cents(double a, double b) {
  return 1200.0 * std::log2(a / b);
}

}  // namespace ergotic::test
