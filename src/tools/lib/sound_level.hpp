// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/audio/wav.hpp"

namespace ergotic::tools {

/// Default loudness of `render --normalize`, LUFS.
constexpr double kUsualLoudness = -18.0;
/// True peak that a normalized sound never exceeds, dBTP.
constexpr double kHighestPeakDb = -1.0;

/// Level of a whole sound.
struct SoundLevel {
  /// Integrated loudness by ITU-R BS.1770-4, LUFS; none if all of it lies below the gate of -70
  /// LUFS.
  std::optional<double> loudness;
  double true_peak_db = 0.0;  ///< maximum over all channels, also between samples; dBTP
  std::vector<double> peaks;  ///< [channels] largest magnitude of a sample, full scale is 1
};

/// Measures a sound file. Two channels are left and right; each of another number counts as a
/// speaker in front. Realtime: no. \throws Exception with path and reason
SoundLevel levelOf(const std::string& path);

/// `-18.2 LUFS, true peak -3.4 dBTP; channel 2 clips: its peak is 1.31, allowed 1`
std::string describe(const SoundLevel& level);

/// The gain that makes a sound as loud as is wanted, or less, so that its true peak stays at
/// kHighestPeakDb or below. 1 for a silent sound.
double normalizingGain(const SoundLevel& level, double wanted_loudness);

/// Processing of a finished sound.
struct SoundFinish {
  double gain = 1.0;
  double fade_s =
      0.0;  ///< at the end: half a period of a cosine from 1 to 0; cut to the length of the sound
};

/// Copies a sound file. \return samples clipped to full scale, in 24-bit files only
/// \throws Exception with path and reason
std::int64_t finishSound(const std::string& from,
                         const std::string& to,
                         audio::WavFormat format,
                         const SoundFinish& finish);

}  // namespace ergotic::tools
