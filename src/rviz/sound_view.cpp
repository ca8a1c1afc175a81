// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/sound_view.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <unsupported/Eigen/FFT>

namespace ergotic::panel {
namespace {

constexpr double kMeanOfWindow = 0.5;

std::size_t indexOf(double hz, double step_hz, std::size_t count) {
  const double index = std::max(hz / step_hz, 0.0);
  return std::min(static_cast<std::size_t>(std::lround(index)), count - 1);
}

}  // namespace

std::vector<double> spectrumOf(const std::vector<float>& block) {
  const auto count = static_cast<double>(block.size());
  std::vector<double> windowed;
  windowed.reserve(block.size());
  for (const float sample : block) {
    const double turn = 2.0 * M_PI * static_cast<double>(windowed.size()) / count;
    const double clean = std::isfinite(sample) ? static_cast<double>(sample) : 0.0;
    windowed.push_back((0.5 - 0.5 * std::cos(turn)) * clean);
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> lines;
  fft.fwd(lines, windowed);
  std::vector<double> spectrum;
  spectrum.reserve(lines.size());
  for (const std::complex<double>& line : lines) {
    spectrum.push_back(2.0 * std::abs(line) / (kMeanOfWindow * count));
  }
  return spectrum;
}

double SpectrumScale::shareOf(double hz) {
  return std::log(hz / kLowestHz) / std::log(kHighestHz / kLowestHz);
}

double SpectrumScale::frequencyAt(double share) {
  return kLowestHz * std::pow(kHighestHz / kLowestHz, share);
}

std::vector<double> columnsOf(const std::vector<double>& spectrum, double rate_hz, int columns) {
  std::vector<double> levels;
  if (spectrum.size() < 2 || !(rate_hz > 0.0)) {
    return levels;
  }
  const double step_hz = 0.5 * rate_hz / static_cast<double>(spectrum.size() - 1);
  for (int c = 0; c < columns; ++c) {
    const double from_hz = SpectrumScale::frequencyAt(static_cast<double>(c) / columns);
    const double to_hz = SpectrumScale::frequencyAt(static_cast<double>(c + 1) / columns);
    const std::size_t first = indexOf(from_hz, step_hz, spectrum.size());
    const std::size_t last = std::max(first, indexOf(to_hz, step_hz, spectrum.size()));
    const auto begin = spectrum.begin() + static_cast<std::ptrdiff_t>(first);
    const double largest =
        *std::max_element(begin, spectrum.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const bool is_heard = from_hz < 0.5 * rate_hz && largest > 0.0;
    levels.push_back(is_heard ? std::max(20.0 * std::log10(largest), SpectrumScale::kLowestDb)
                              : SpectrumScale::kLowestDb);
  }
  return levels;
}

std::size_t beginOfWave(const std::vector<float>& block, std::size_t shown) {
  std::size_t begin = 0;
  float steepest = 0.0F;
  for (std::size_t i = 1; i + shown <= block.size(); ++i) {
    const float rise = block[i] - block[i - 1];
    if (block[i - 1] < 0.0F && block[i] >= 0.0F && rise > steepest) {
      steepest = rise;
      begin = i;
    }
  }
  return begin;
}

}  // namespace ergotic::panel
