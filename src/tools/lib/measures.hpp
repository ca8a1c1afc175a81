// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace ergotic::tools {

/// Measurements of a sound. All are exact within their definitions, as far as windows separate
/// components: four terms of Blackman and Harris, whose side lobes lie 92 dB below. \throws
/// Exception if the sound is too short, or lacks the measured quantity

/// Samples of one channel.
struct Sound {
  std::vector<double> samples;
  double rate_hz = 44100.0;
  double seconds() const { return static_cast<double>(samples.size()) / rate_hz; }
};

struct Line {
  double hz = 0.0;
  double amplitude = 0.0;  ///< amplitude as the mean of the window gives it
};

/// The highest line of a stretch within a share of a frequency: the top of a parabola through the
/// logarithm of its windowed spectrum, taken closer and closer.
/// \param span  of `near_hz`, < 1
Line lineNear(const Sound& sound, double begin_s, double length_s, double near_hz, double span);

/// T60 of all of a sound from some time on, by backward integration (Schroeder 1965, Journal of the
/// Acoustical Society of America 37): the line through -5...-25 dB of the energy that is left, what
/// is beyond the end of the sound included as it decays there.
/// \param near_hz  of what lies within a ninth of this frequency; 0: of all
double decayOf(const Sound& sound, double begin_s, double near_hz);

struct Pole {
  double hz = 0.0;
  double t60_s = 0.0;
  double amplitude = 0.0;  ///< amplitude at the beginning
};

/// The strongest decaying lines next to a frequency, by frequency: how the dominant space of their
/// Hankel matrix shifts (ESPRIT; Roy and Kailath 1989, IEEE Transactions on ASSP 37).
std::vector<Pole> polesNear(const Sound& sound, double begin_s, double near_hz, int count);

/// Mean frequency of the energy of 46 ms.
double centroidAt(const Sound& sound, double begin_s);

/// Largest sample from a time on, of the largest of all.
double levelAfter(const Sound& sound, double begin_s);

/// Longest continuous time for which a distance is below 0, s, with linear interpolation of
/// samples.
double longestBelow(const std::vector<double>& distance, double rate_hz);

}  // namespace ergotic::tools
