// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/measures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "constants.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::tools {
namespace {

using Complex = std::complex<double>;
constexpr double kLobe = 4.0;           // half width of the main lobe of the window, of 1/length
constexpr double kBand = 1.0 / 9.0;     // of a frequency: two semitones
constexpr std::size_t kMaxPoles = 360;  // samples of a band from which poles are taken
constexpr std::size_t kSpectrum = 2048;
constexpr double kFirstDb = -5.0;
constexpr double kLastDb = -25.0;

std::size_t indexOf(const Sound& sound, double time_s) {
  return static_cast<std::size_t>(std::llround(time_s * sound.rate_hz));
}

[[noreturn]] void tooShort(const Sound& sound, double needed_s) {
  throw Exception("the sound has " + std::to_string(sound.seconds()) +
                  " s, needed: " + std::to_string(needed_s) + " s");
}

/// Four terms of Blackman and Harris (1978), of the sum 1.
std::vector<double> windowOf(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t k = 0; k < length; ++k) {
    const double turn = 2.0 * kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(length);
    window[k] = 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2.0 * turn) -
                0.01168 * std::cos(3.0 * turn);
  }
  const double sum = std::accumulate(window.begin(), window.end(), 0.0);
  for (double& w : window) {
    w /= sum;
  }
  return window;
}

/// Amplitude of a windowed stretch at a frequency.
double levelAt(const std::vector<double>& stretch, double omega) {
  const Complex turn = std::polar(1.0, -omega);
  Complex phase = 1.0;
  Complex sum = 0.0;
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    sum += stretch[k] * phase;
    phase *= turn;
    if (k % 1024 == 1023) {  // rounding
      phase = std::polar(1.0, -omega * static_cast<double>(k + 1));
    }
  }
  return 2.0 * std::abs(sum);
}

/// Samples of a band around a frequency, as often as it needs.
struct Band {
  std::vector<Complex> samples;
  double rate_hz = 0.0;
};

Band bandOf(const Sound& sound, double begin_s, double near_hz, double half_width_hz) {
  const std::vector<double> window =
      windowOf(static_cast<std::size_t>(std::ceil(kLobe * sound.rate_hz / half_width_hz)));
  const std::size_t begin = indexOf(sound, begin_s);
  const auto hop =
      static_cast<std::size_t>(std::max(1.0, std::floor(sound.rate_hz / (4.0 * half_width_hz))));
  if (begin + window.size() + 16 * hop > sound.samples.size()) {
    tooShort(sound, static_cast<double>(begin + window.size() + 16 * hop) / sound.rate_hz);
  }
  Band band;
  band.rate_hz = sound.rate_hz / static_cast<double>(hop);
  const double omega = 2.0 * kPi * near_hz / sound.rate_hz;
  for (std::size_t first = begin; first + window.size() <= sound.samples.size(); first += hop) {
    Complex sum = 0.0;
    for (std::size_t k = 0; k < window.size(); ++k) {
      sum += std::polar(window[k] * sound.samples[first + k], -omega * static_cast<double>(k));
    }
    // The phase of its own time, so that a line turns by its distance alone.
    band.samples.push_back(sum * std::polar(1.0, -omega * static_cast<double>(first - begin)));
  }
  return band;
}

/// T60 of an energy per sample.
double decayOf(const std::vector<double>& energy, double rate_hz) {
  double slope = 0.0;  // of the logarithm of the energy that is left, per sample
  for (int pass = 0; pass < 8; ++pass) {
    // What goes on beyond the end, as it does before.
    const double tail = slope < 0.0 ? energy.back() / -std::expm1(slope) * std::exp(slope) : 0.0;
    std::vector<double> left(energy.size());
    double sum = tail;
    for (std::size_t i = energy.size(); i-- > 0;) {
      sum += energy[i];
      left[i] = sum;
    }
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double lowest = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double level = 10.0 * std::log10(left[i] / left[0]);
      lowest = std::min(lowest, level);
      if (level <= kFirstDb && level >= kLastDb) {
        const double place = static_cast<double>(i);
        n += 1.0;
        x += place;
        y += level;
        xx += place * place;
        xy += place * level;
      }
    }
    if (!(lowest < kLastDb) || n < 3.0) {
      throw Exception("it does not decay by 25 dB in " +
                      std::to_string(static_cast<double>(energy.size()) / rate_hz) +
                      " s, of which T60 is told");
    }
    slope = (n * xy - x * y) / (n * xx - x * x) * std::log(10.0) / 10.0;
  }
  return -std::log(1e6) / slope / rate_hz;
}

/// Fourier transform in place. \pre the length is a power of two. Source: Cooley and Tukey 1965
void transform(std::vector<Complex>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n / 2;
    for (; (j & bit) != 0; bit /= 2) {
      j ^= bit;
    }
    j |= bit;
    if (i < j) {
      std::swap(x[i], x[j]);
    }
  }
  std::vector<Complex> turns(n / 2);
  for (std::size_t k = 0; k < turns.size(); ++k) {
    turns[k] = std::polar(1.0, -2.0 * kPi * static_cast<double>(k) / static_cast<double>(n));
  }
  for (std::size_t length = 2; length <= n; length *= 2) {
    for (std::size_t first = 0; first < n; first += length) {
      for (std::size_t k = 0; k < length / 2; ++k) {
        const Complex a = x[first + k];
        const Complex b = turns[k * (n / length)] * x[first + k + length / 2];
        x[first + k] = a + b;
        x[first + k + length / 2] = a - b;
      }
    }
  }
}

}  // namespace

Line lineNear(const Sound& sound, double begin_s, double length_s, double near_hz, double span) {
  const std::size_t begin = indexOf(sound, begin_s);
  const std::size_t length = indexOf(sound, length_s);
  if (begin + length > sound.samples.size() || length < 16) {
    tooShort(sound, begin_s + length_s);
  }
  std::vector<double> stretch = windowOf(length);
  for (std::size_t k = 0; k < length; ++k) {
    stretch[k] *= sound.samples[begin + k];
  }
  const auto levelOf = [&](double hz) { return levelAt(stretch, 2.0 * kPi * hz / sound.rate_hz); };
  std::size_t padded = 32;
  while (padded < 2 * length) {
    padded *= 2;
  }
  std::vector<Complex> spectrum(stretch.begin(), stretch.end());
  spectrum.resize(padded);
  transform(spectrum);
  double step_hz = sound.rate_hz / static_cast<double>(padded);
  Line best{near_hz, -1.0};
  const auto first = static_cast<std::size_t>(std::floor((1.0 - span) * near_hz / step_hz));
  const auto last = static_cast<std::size_t>(std::ceil((1.0 + span) * near_hz / step_hz));
  for (std::size_t k = std::max<std::size_t>(first, 1); k <= std::min(last, padded / 2 - 1); ++k) {
    const double level = 2.0 * std::abs(spectrum[k]);
    best = level > best.amplitude ? Line{static_cast<double>(k) * step_hz, level} : best;
  }
  if (!(best.amplitude > 0.0)) {
    throw Exception("there is no sound to find a line in");
  }
  for (int round = 0; round < 5; ++round) {
    const double low = std::log(levelOf(best.hz - step_hz));
    const double top = std::log(levelOf(best.hz));
    const double high = std::log(levelOf(best.hz + step_hz));
    const double bend = low - 2.0 * top + high;
    const double shift = bend < 0.0 ? 0.5 * (low - high) / bend : 0.0;
    best.hz += std::clamp(shift, -1.0, 1.0) * step_hz;
    step_hz *= 0.5;
  }
  best.amplitude = levelOf(best.hz);
  return best;
}

double decayOf(const Sound& sound, double begin_s, double near_hz) {
  std::vector<double> energy;
  double rate_hz = sound.rate_hz;
  if (near_hz > 0.0) {
    const Band band = bandOf(sound, begin_s, near_hz, kBand * near_hz);
    rate_hz = band.rate_hz;
    std::transform(band.samples.begin(), band.samples.end(), std::back_inserter(energy),
                   [](const Complex& z) { return std::norm(z); });
  } else {
    for (std::size_t i = indexOf(sound, begin_s); i < sound.samples.size(); ++i) {
      energy.push_back(sound.samples[i] * sound.samples[i]);
    }
    // The energy of a line goes to and fro: its end is judged by the mean of the last 50 ms.
    const std::size_t last = std::min(energy.size() / 2, indexOf(sound, 0.05));
    if (last == 0) {
      tooShort(sound, begin_s + 0.1);
    }
    energy.back() =
        std::accumulate(energy.end() - static_cast<std::ptrdiff_t>(last), energy.end(), 0.0) /
        static_cast<double>(last);
  }
  return decayOf(energy, rate_hz);
}

std::vector<Pole> polesNear(const Sound& sound, double begin_s, double near_hz, int count) {
  const double seconds = sound.seconds() - begin_s;
  const double half_width_hz =
      std::min(kBand * near_hz, static_cast<double>(kMaxPoles) / 4.0 / std::max(seconds, 1e-9));
  const Band band = bandOf(sound, begin_s, near_hz, half_width_hz);
  const auto size = static_cast<Eigen::Index>(std::min(band.samples.size(), kMaxPoles));
  const Eigen::Index rows = size / 3;
  if (rows < 2 * count) {
    tooShort(sound, 2.0 * sound.seconds());
  }
  Eigen::MatrixXcd hankel(rows, size - rows + 1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < hankel.cols(); ++j) {
      hankel(i, j) = band.samples[static_cast<std::size_t>(i + j)];
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> powers_of(hankel * hankel.adjoint());
  const Eigen::MatrixXcd space = powers_of.eigenvectors().rightCols(count);
  const Eigen::MatrixXcd shift =
      space.topRows(rows - 1).colPivHouseholderQr().solve(space.bottomRows(rows - 1));
  const Eigen::VectorXcd values = Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(shift).eigenvalues();
  Eigen::MatrixXcd powers(size, count);
  Eigen::VectorXcd heard(size);
  for (Eigen::Index n = 0; n < size; ++n) {
    heard[n] = band.samples[static_cast<std::size_t>(n)];
    for (Eigen::Index p = 0; p < count; ++p) {
      powers(n, p) = std::pow(values[p], static_cast<double>(n));
    }
  }
  const Eigen::VectorXcd shares = powers.colPivHouseholderQr().solve(heard);
  std::vector<Pole> poles;
  for (Eigen::Index p = 0; p < count; ++p) {
    const double decay = -std::log(std::abs(values[p])) * band.rate_hz;
    poles.push_back({near_hz + std::arg(values[p]) / (2.0 * kPi) * band.rate_hz,
                     std::log(1000.0) / decay, 2.0 * std::abs(shares[p])});
  }
  std::sort(poles.begin(), poles.end(), [](const Pole& a, const Pole& b) { return a.hz < b.hz; });
  return poles;
}

double centroidAt(const Sound& sound, double begin_s) {
  const std::size_t begin = indexOf(sound, begin_s);
  if (begin + kSpectrum > sound.samples.size()) {
    tooShort(sound, static_cast<double>(begin + kSpectrum) / sound.rate_hz);
  }
  const std::vector<double> window = windowOf(kSpectrum);
  std::vector<Complex> x(kSpectrum);
  for (std::size_t k = 0; k < kSpectrum; ++k) {
    x[k] = window[k] * sound.samples[begin + k];
  }
  transform(x);
  double sum = 0.0;
  double energy = 0.0;
  for (std::size_t k = 1; k < kSpectrum / 2; ++k) {
    sum += std::norm(x[k]) * static_cast<double>(k) * sound.rate_hz / kSpectrum;
    energy += std::norm(x[k]);
  }
  if (!(energy > 0.0)) {
    throw Exception("it is silent at " + std::to_string(begin_s) + " s");
  }
  return sum / energy;
}

double levelAfter(const Sound& sound, double begin_s) {
  const std::size_t begin = indexOf(sound, begin_s);
  if (begin >= sound.samples.size()) {
    tooShort(sound, begin_s);
  }
  const auto highest = [](auto first, auto last) {
    return std::accumulate(first, last, 0.0,
                           [](double most, double x) { return std::max(most, std::abs(x)); });
  };
  const double of_all = highest(sound.samples.begin(), sound.samples.end());
  if (!(of_all > 0.0)) {
    throw Exception("it never sounds");
  }
  return highest(sound.samples.begin() + static_cast<std::ptrdiff_t>(begin), sound.samples.end()) /
         of_all;
}

double longestBelow(const std::vector<double>& distance, double rate_hz) {
  double longest = 0.0;
  double since = -1.0;  // samples; < 0: it is above
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const double place = static_cast<double>(i);
    const bool is_below = distance[i] < 0.0;
    const double crossed = i == 0 ? 0.0 : place - distance[i] / (distance[i] - distance[i - 1]);
    if (is_below && since < 0.0) {
      since = i == 0 ? 0.0 : crossed;
    } else if (!is_below && since >= 0.0) {
      longest = std::max(longest, crossed - since);
      since = -1.0;
    }
  }
  if (longest == 0.0) {
    throw Exception(since < 0.0 ? "it never touches" : "it touches and does not let go");
  }
  return longest / rate_hz;
}

}  // namespace ergotic::tools
