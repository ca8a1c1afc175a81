// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace ergotic::panel {

/// The amplitudes of the sines that a block is made of, by a Hann window: a sine of amplitude 1
/// that has a whole number of periods in it shows 1 at its frequency.
/// \param block  of at least 4 samples \return [block / 2 + 1], from 0 to half the rate, evenly
std::vector<double> spectrumOf(const std::vector<float>& block);

/// A spectrum as it is drawn, by the logarithm of the frequency.
struct SpectrumScale {
  static constexpr double kLowestHz = 30.0;
  static constexpr double kHighestHz = 20000.0;
  static constexpr double kLowestDb = -90.0;  ///< relative to full scale

  /// \return 0...1 for a frequency between the lowest and the highest
  static double shareOf(double hz);
  static double frequencyAt(double share);
};

/// The largest level within each of so many columns, dB of full scale, no lower than kLowestDb.
/// \param rate_hz  of the block that the spectrum is of
std::vector<double> columnsOf(const std::vector<double>& spectrum, double rate_hz, int columns);

/// Begin of a wave's picture, at which a periodic wave stands still: the steepest rise through zero
/// of those samples after which `shown` more follow. 0 if there is none.
std::size_t beginOfWave(const std::vector<float>& block, std::size_t shown);

}  // namespace ergotic::panel
