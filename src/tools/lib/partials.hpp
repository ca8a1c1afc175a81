// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "constants.hpp"

namespace ergotic::tools {

/// A partial of a sound.
struct Partial {
  double frequency_hz = 0.0;
  double amplitude = 0.0;
};

/// The partial of a sound next to `guess_hz`: how far its phase turns in 100 samples, through a
/// window of half a second whose side lobes fall below 1e-12 within 50 Hz.
/// \pre at least 0.5 s and 100 samples of sound from `begin` on; other partials at least 50 Hz away
inline Partial partialAt(const std::vector<double>& sound,
                         double guess_hz,
                         double rate_hz,
                         std::size_t begin = 0) {
  constexpr std::size_t kLater = 100;
  const auto length = static_cast<std::size_t>(rate_hz / 2.0);
  const double omega = 2.0 * kPi * guess_hz / rate_hz;
  std::complex<double> first;
  std::complex<double> later;
  double weights = 0.0;
  for (std::size_t k = 0; k < length; ++k) {
    const double place = static_cast<double>(k);
    const double square = std::pow(std::sin(kPi * place / static_cast<double>(length)), 2);
    const double window = square * square * square * square;
    const std::complex<double> turn = std::polar(window, -omega * place);
    first += turn * sound[begin + k];
    later += turn * sound[begin + k + kLater];
    weights += window;
  }
  const double expected = omega * static_cast<double>(kLater);
  const double beyond = std::arg(later / first * std::polar(1.0, -expected));
  return {guess_hz * (1.0 + beyond / expected), 2.0 * std::abs(first) / weights};
}

/// The level of the partial that differs most, dB. Of those that count: at least 3 % of the
/// strongest. \param right     what should sound \param partials  Hz. \pre as of partialAt()
inline double worstPartialDb(const std::vector<double>& sound,
                             const std::vector<double>& right,
                             const std::vector<double>& partials,
                             double rate_hz,
                             std::size_t begin) {
  constexpr double kFaintest = 0.03;
  const auto levelsOf = [&](const std::vector<double>& of) {
    std::vector<double> levels;
    for (const double hz : partials) {
      levels.push_back(partialAt(of, hz, rate_hz, begin).amplitude);
    }
    return levels;
  };
  const std::vector<double> is = levelsOf(sound);
  const std::vector<double> should = levelsOf(right);
  const double strongest = *std::max_element(should.begin(), should.end());
  double worst = 0.0;
  for (std::size_t k = 0; k < partials.size(); ++k) {
    if (should[k] > kFaintest * strongest) {
      worst = std::max(worst, std::abs(20.0 * std::log10(is[k] / should[k])));
    }
  }
  return worst;
}

/// Interval from b up to a, cents.
inline double cents(double a, double b) {
  return 1200.0 * std::log2(a / b);
}

}  // namespace ergotic::tools
