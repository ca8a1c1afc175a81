// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/sound_level.hpp"

#include <ebur128.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "constants.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::tools {
namespace {

constexpr std::int64_t kSoundBlock = 8192;  // frames

struct Release {
  void operator()(ebur128_state* state) const noexcept { ebur128_destroy(&state); }
};
using Meter = std::unique_ptr<ebur128_state, Release>;

Meter meterFor(const audio::WavReader& sound, const std::string& path) {
  const auto channels = static_cast<unsigned>(sound.channels());
  Meter meter(ebur128_init(channels, static_cast<unsigned long>(std::lround(sound.sampleRate())),
                           EBUR128_MODE_I | EBUR128_MODE_TRUE_PEAK));
  if (!meter) {
    throw Exception(path + ": its loudness cannot be measured, allowed: 1...64 channels");
  }
  for (unsigned c = 0; c < channels && channels > 2; ++c) {
    ebur128_set_channel(meter.get(), c, EBUR128_CENTER);
  }
  return meter;
}

double decibels(double ratio) {
  return 20.0 * std::log10(ratio);
}

double fadeAt(double seconds_left, double fade_s) {
  return seconds_left >= fade_s ? 1.0 : 0.5 - 0.5 * std::cos(kPi * seconds_left / fade_s);
}

}  // namespace

SoundLevel levelOf(const std::string& path) {
  audio::WavReader sound(path);
  const Meter meter = meterFor(sound, path);
  const auto channels = static_cast<std::size_t>(sound.channels());
  SoundLevel level;
  level.peaks.resize(channels);
  std::vector<double> block(static_cast<std::size_t>(kSoundBlock) * channels);
  while (const std::int64_t frames = sound.read(block.data(), kSoundBlock)) {
    if (ebur128_add_frames_double(meter.get(), block.data(), static_cast<std::size_t>(frames)) !=
        EBUR128_SUCCESS) {
      throw Exception(path + ": its loudness cannot be measured: there is no memory for it");
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(frames) * channels; ++i) {
      level.peaks[i % channels] = std::max(level.peaks[i % channels], std::abs(block[i]));
    }
  }
  double true_peak = 0.0;
  for (std::size_t c = 0; c < channels; ++c) {
    double of_channel = 0.0;
    ebur128_true_peak(meter.get(), static_cast<unsigned>(c), &of_channel);
    true_peak = std::max({true_peak, of_channel, level.peaks[c]});
  }
  level.true_peak_db = decibels(true_peak);
  double loudness = 0.0;
  if (ebur128_loudness_global(meter.get(), &loudness) == EBUR128_SUCCESS &&
      std::isfinite(loudness)) {
    level.loudness = loudness;
  }
  return level;
}

std::string describe(const SoundLevel& level) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  if (level.loudness) {
    text << *level.loudness << " LUFS";
  } else {
    text << "softer than -70 LUFS";
  }
  if (std::isfinite(level.true_peak_db)) {
    text << ", true peak " << level.true_peak_db << " dBTP";
  } else {
    text << ", silent";
  }
  text.precision(2);
  for (std::size_t c = 0; c < level.peaks.size(); ++c) {
    if (level.peaks[c] > 1.0) {
      text << "; channel " << c + 1 << " clips: its peak is " << level.peaks[c] << ", allowed 1";
    }
  }
  return text.str();
}

double normalizingGain(const SoundLevel& level, double wanted_loudness) {
  if (!level.loudness) {
    return 1.0;
  }
  const double louder_db =
      std::min(wanted_loudness - *level.loudness, kHighestPeakDb - level.true_peak_db);
  return std::pow(10.0, louder_db / 20.0);
}

std::int64_t finishSound(const std::string& from,
                         const std::string& to,
                         audio::WavFormat format,
                         const SoundFinish& finish) {
  audio::WavReader sound(from);
  const auto channels = static_cast<std::size_t>(sound.channels());
  const std::int64_t length = sound.frames();
  const double fade_s = std::min(finish.fade_s, static_cast<double>(length) / sound.sampleRate());
  audio::WavWriter out(to, sound.sampleRate(), sound.channels(), format);
  std::vector<double> block(static_cast<std::size_t>(kSoundBlock) * channels);
  while (const std::int64_t frames = sound.read(block.data(), kSoundBlock)) {
    for (std::int64_t n = 0; n < frames; ++n) {
      const std::int64_t left = length - 1 - out.frames() - n;
      const double gain =
          finish.gain * fadeAt(static_cast<double>(left) / sound.sampleRate(), fade_s);
      double* const frame = &block[static_cast<std::size_t>(n) * channels];
      std::transform(frame, frame + channels, frame, [gain](double x) { return gain * x; });
    }
    out.write(block.data(), frames);
  }
  out.finish();
  return out.clippedSamples();
}

}  // namespace ergotic::tools
