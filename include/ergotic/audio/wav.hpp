// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ergotic::audio {

enum class WavFormat {
  kFloat,   ///< 32-bit float
  kDouble,  ///< 64-bit float
  k24       ///< 24-bit integer, full scale 1, clipped beyond
};

/// \throws Exception if `name` is not one of float, double, 24
WavFormat wavFormatOf(const std::string& name);

/// Reads a sound file of any format that libsndfile knows; a WAV file whose header does not say how
/// long it is, up to its end. Realtime: no. Thread: one
class WavReader {
 public:
  /// \throws Exception with path and reason
  explicit WavReader(const std::string& path);
  ~WavReader();
  WavReader(const WavReader&) = delete;
  WavReader& operator=(const WavReader&) = delete;

  double sampleRate() const noexcept;  ///< Hz
  int channels() const noexcept;
  std::int64_t frames() const noexcept;
  bool isUnfinished() const noexcept;  ///< the header does not say how long it is

  /// \param[out] to  [nframes][channels], integer formats scaled to full scale 1
  /// \return frames read, less than `nframes` only at the end of the file
  /// \throws Exception with path and reason
  std::int64_t read(double* to, std::int64_t nframes);

  /// Reads all remaining frames, [frames][channels].
  /// \throws Exception with path and reason
  std::vector<double> readAll();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Writes a WAV file, with format tag 1 or 3 for up to two channels and WAVE_FORMAT_EXTENSIBLE for
/// more, which becomes RF64 if it grows beyond 4 GiB. What is there can be read if this process is
/// killed. Realtime: no. Thread: one
class WavWriter {
 public:
  /// \param sample_rate  Hz, a whole number: the format knows no other
  /// \throws Exception with path and reason
  WavWriter(const std::string& path, double sample_rate, int channels, WavFormat format);
  ~WavWriter();  ///< completes the file; what goes wrong then is lost, hence `finish`
  WavWriter(const WavWriter&) = delete;
  WavWriter& operator=(const WavWriter&) = delete;

  /// \param frames  [nframes][channels]
  /// \throws Exception if a sample is not finite (nothing of the block is written), or with the
  ///         system's reason if the disk did not take all
  void write(const double* frames, std::int64_t nframes);
  void write(const float* frames, std::int64_t nframes);

  /// Completes the file: afterwards it is whole, on the disk.
  /// \throws Exception with path and reason
  void finish();

  std::int64_t frames() const noexcept;          ///< written so far
  std::int64_t clippedSamples() const noexcept;  ///< beyond full scale, k24 only

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace ergotic::audio
