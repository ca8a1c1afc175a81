// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ergotic/audio/wav.hpp"
#include "tools/lib/sound_level.hpp"

namespace ergotic::tools {

/// Requests for the processing of a finished sound.
struct SoundWish {
  std::optional<double> loudness;  ///< LUFS, as far as the true peak allows; none: unchanged
  double fade_s = 0.0;             ///< duration of the fade at its end, s

  bool isAny() const noexcept { return loudness || fade_s > 0.0; }
};

/// Writer of a rendered sound: a WAV file that appears under its name only when it is whole.
class FrameWriter {
 public:
  /// \param path      empty: the sound is measured, not kept
  /// \param channels  number of channels; a sound without channels cannot be kept
  ///
  /// A symbolic link is followed. \throws Exception with path and reason; also for a device, a pipe
  /// and whatever else is no regular file, as the header of a WAV file is written last
  FrameWriter(std::string path,
              double sample_rate,
              int channels,
              audio::WavFormat format,
              const SoundWish& wish = {});
  ~FrameWriter();  ///< removes what was not finished
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// \param frames  [nframes][channels]
  /// \throws Exception naming the frame if a sample is not finite; or if the disk is full
  void write(const double* frames, std::int64_t nframes);

  /// Processes the sound as wished, measures it, and gives the file its name.
  /// \throws Exception with path and reason
  void finish();

  std::int64_t frames() const noexcept { return frames_; }
  double peak() const noexcept { return peak_; }  ///< largest magnitude so far
  /// Number of samples beyond full scale, in 24-bit files only. \pre finished
  std::int64_t clippedSamples() const noexcept { return clipped_; }
  /// Level of the finished file; none if nothing is kept.
  const std::optional<SoundLevel>& level() const noexcept { return level_; }
  double gain() const noexcept { return gain_; }  ///< gain of the normalization

 private:
  void grantWish();

  std::string path_;
  std::string unfinished_path_;
  audio::WavFormat format_;
  SoundWish wish_;
  std::unique_ptr<audio::WavWriter> file_;
  int channels_;
  std::int64_t frames_ = 0;
  double peak_ = 0.0;
  double gain_ = 1.0;
  std::int64_t clipped_ = 0;
  std::optional<SoundLevel> level_;
};

}  // namespace ergotic::tools
