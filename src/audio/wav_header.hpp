// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

namespace ergotic::audio {

/// Format of the samples of a WAV file.
struct WavShape {
  int rate = 0;  ///< Hz
  int channels = 0;
  int sample_bytes = 0;
  bool is_float = false;  ///< otherwise whole numbers

  int frameBytes() const noexcept { return channels * sample_bytes; }
};

constexpr std::int64_t kUnknownFrames = -1;

/// Header before the samples, of equal length for any number of frames: format tag 1 or 3 for up to
/// two channels, WAVE_FORMAT_EXTENSIBLE for more; RF64 (EBU Tech 3306) where 32 bits do not hold
/// the size.
/// \param frames  kUnknownFrames while it is written: readers then go on to the end of the file
std::string wavHeader(const WavShape& shape, std::int64_t frames);

/// Bytes after the last frame that make their number even.
std::int64_t wavPadding(const WavShape& shape, std::int64_t frames);

/// Samples of a WAV file whose header does not give their number, because its writer was killed, or
/// wrote to a pipe.
struct UnfinishedWav {
  WavShape shape;
  std::int64_t begin = 0;   ///< position of the samples, bytes
  std::int64_t frames = 0;  ///< up to the end of the file
};

/// \return nothing of a file that is none, or whose samples are not understood
std::optional<UnfinishedWav> findUnfinished(std::istream& file);

}  // namespace ergotic::audio
