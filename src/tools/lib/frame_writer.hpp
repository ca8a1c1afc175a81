// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ergotic/audio/wav.hpp"

namespace ergotic::tools {

/// Where a rendered sound goes: a WAV file that appears under its name only when it is whole.
class FrameWriter {
 public:
  /// \param path      empty: the sound is measured, not kept
  /// \param channels  of the sound; a sound without channels cannot be kept
  /// \throws Exception with path and reason
  FrameWriter(std::string path, double sample_rate, int channels, audio::WavFormat format);
  ~FrameWriter();  ///< removes what was not finished
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// \param frames  [nframes][channels]
  /// \throws Exception naming the frame if a sample is not finite; or if the disk is full
  void write(const double* frames, std::int64_t nframes);

  /// Gives the file its name. \throws Exception with path and reason
  void finish();

  std::int64_t frames() const noexcept { return frames_; }
  double peak() const noexcept { return peak_; }  ///< largest magnitude so far
  /// Beyond full scale, 24-bit files only.
  std::int64_t clippedSamples() const noexcept { return file_ ? file_->clippedSamples() : 0; }

 private:
  std::string path_;
  std::string unfinished_path_;
  std::unique_ptr<audio::WavWriter> file_;
  int channels_;
  std::int64_t frames_ = 0;
  double peak_ = 0.0;
  bool finished_ = false;
};

}  // namespace ergotic::tools
