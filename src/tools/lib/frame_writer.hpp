// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ergotic/audio/wav.hpp"
#include "tools/lib/sound_level.hpp"

namespace ergotic::tools {

/// What is wanted of a sound beyond its being written.
struct SoundWish {
  std::optional<double> loudness;  ///< LUFS, as far as the true peak allows; none: as it was played
  double fade_s = 0.0;             ///< how long its end fades away, s

  bool isAny() const noexcept { return loudness || fade_s > 0.0; }
};

/// Where a rendered sound goes: a WAV file that appears under its name only when it is whole.
class FrameWriter {
 public:
  /// \param path      empty: the sound is measured, not kept
  /// \param channels  of the sound; a sound without channels cannot be kept
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

  /// Does what is wished, measures the sound, and gives the file its name.
  /// \throws Exception with path and reason
  void finish();

  std::int64_t frames() const noexcept { return frames_; }
  double peak() const noexcept { return peak_; }  ///< largest magnitude so far
  /// Beyond full scale, 24-bit files only. \pre finished
  std::int64_t clippedSamples() const noexcept { return clipped_; }
  /// Of the finished file; none if nothing is kept.
  const std::optional<SoundLevel>& level() const noexcept { return level_; }
  double gain() const noexcept { return gain_; }  ///< by which it was normalized

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
