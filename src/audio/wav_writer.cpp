// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <utility>

#include "audio/wav_header.hpp"
#include "ergotic/audio/wav.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::audio {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "samples are written as they are in memory");

constexpr double kFullScale24 = 8388608.0;  // 2^23
constexpr int kMaxRate = 1'000'000;
constexpr int kMaxChannels = 1024;

/// \throws Exception if there is no such file
WavShape shapeOf(const std::string& path, double sample_rate, int channels, WavFormat format) {
  if (!(sample_rate >= 1.0 && sample_rate <= kMaxRate) || sample_rate != std::floor(sample_rate)) {
    std::ostringstream message;
    message << path << ": sample rate " << sample_rate << " Hz, allowed: whole numbers in 1..."
            << kMaxRate;
    throw Exception(message.str());
  }
  if (channels < 1 || channels > kMaxChannels) {
    throw Exception(path + ": " + std::to_string(channels) + " channels, allowed: 1..." +
                    std::to_string(kMaxChannels));
  }
  const int bytes = format == WavFormat::kDouble ? 8 : format == WavFormat::kFloat ? 4 : 3;
  return {static_cast<int>(sample_rate), channels, bytes, format != WavFormat::k24};
}

template <class Wanted, class Sample>
void appendAs(const Sample* samples, std::size_t count, std::vector<char>& bytes) {
  bytes.resize(count * sizeof(Wanted));
  for (std::size_t i = 0; i < count; ++i) {
    const auto sample = static_cast<Wanted>(samples[i]);
    std::memcpy(bytes.data() + i * sizeof sample, &sample, sizeof sample);
  }
}

/// \return samples beyond full scale
template <class Sample>
std::int64_t appendAs24(const Sample* samples, std::size_t count, std::vector<char>& bytes) {
  std::int64_t clipped = 0;
  bytes.resize(count * 3);
  for (std::size_t i = 0; i < count; ++i) {
    const auto sample = static_cast<double>(samples[i]);
    clipped += std::abs(sample) > 1.0 ? 1 : 0;
    const double rounded = std::nearbyint(sample * kFullScale24);
    const auto integer =
        static_cast<std::int32_t>(std::clamp(rounded, -kFullScale24, kFullScale24 - 1.0));
    std::memcpy(bytes.data() + 3 * i, &integer, 3);
  }
  return clipped;
}

}  // namespace

struct WavWriter::File {
  std::string path;
  WavShape shape;
  WavFormat format;
  std::FILE* handle = nullptr;
  std::int64_t frames = 0;
  std::int64_t clipped = 0;
  std::vector<char> bytes{};  // scratch

  ~File() {
    if (handle != nullptr) {
      std::fclose(handle);
    }
  }
  template <class Sample>
  void requireFinite(const Sample* samples, std::int64_t count) const;
  template <class Sample>
  void write(const Sample* samples, std::int64_t nframes);
  bool complete();
  [[noreturn]] void fail(const std::string& what) const { throw Exception(path + ": " + what); }
};

template <class Sample>
void WavWriter::File::requireFinite(const Sample* samples, std::int64_t count) const {
  const Sample* end = samples + count;
  const Sample* bad = std::find_if(samples, end, [](Sample s) { return !std::isfinite(s); });
  if (bad != end) {
    std::ostringstream message;
    message << "sample " << frames + (bad - samples) / shape.channels << " of channel "
            << (bad - samples) % shape.channels + 1 << " is " << *bad
            << "; only finite samples can be written";
    fail(message.str());
  }
}

template <class Sample>
void WavWriter::File::write(const Sample* samples, std::int64_t nframes) {
  if (handle == nullptr) {
    fail("is finished already");
  }
  requireFinite(samples, nframes * shape.channels);
  const auto count = static_cast<std::size_t>(nframes * shape.channels);
  if (count == 0) {
    return;
  }
  if (format == WavFormat::kFloat) {
    appendAs<float>(samples, count, bytes);
  } else if (format == WavFormat::kDouble) {
    appendAs<double>(samples, count, bytes);
  } else {
    clipped += appendAs24(samples, count, bytes);
  }
  const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), handle);
  const int error = errno;
  frames += static_cast<std::int64_t>(written) / shape.frameBytes();
  if (written != bytes.size()) {
    fail("only " + std::to_string(frames) + " frames could be written: " + std::strerror(error));
  }
}

/// \return false if something went wrong, which errno says
bool WavWriter::File::complete() {
  const std::string padding(static_cast<std::size_t>(wavPadding(shape, frames)), '\0');
  const std::string header = wavHeader(shape, frames);
  return std::fwrite(padding.data(), 1, padding.size(), handle) == padding.size() &&
         std::fseek(handle, 0, SEEK_SET) == 0 &&
         std::fwrite(header.data(), 1, header.size(), handle) == header.size() &&
         std::fflush(handle) == 0 && fsync(fileno(handle)) == 0;
}

WavWriter::WavWriter(const std::string& path, double sample_rate, int channels, WavFormat format)
    : file_(new File{path, shapeOf(path, sample_rate, channels, format), format}) {
  file_->handle = std::fopen(path.c_str(), "wbe");
  const std::string header = wavHeader(file_->shape, kUnknownFrames);
  if (file_->handle == nullptr ||
      std::fwrite(header.data(), 1, header.size(), file_->handle) != header.size()) {
    file_->fail(std::string("cannot write: ") + std::strerror(errno));
  }
}

WavWriter::~WavWriter() {
  if (file_->handle != nullptr) {
    file_->complete();
  }
}

void WavWriter::write(const double* frames, std::int64_t nframes) {
  file_->write(frames, nframes);
}
void WavWriter::write(const float* frames, std::int64_t nframes) {
  file_->write(frames, nframes);
}

void WavWriter::finish() {
  if (file_->handle == nullptr) {
    return;
  }
  const bool is_complete = file_->complete();
  const int error = errno;
  const bool is_closed = std::fclose(std::exchange(file_->handle, nullptr)) == 0;
  if (!is_complete || !is_closed) {
    file_->fail(std::string("cannot complete: ") + std::strerror(is_complete ? errno : error));
  }
}

std::int64_t WavWriter::frames() const noexcept {
  return file_->frames;
}
std::int64_t WavWriter::clippedSamples() const noexcept {
  return file_->clipped;
}

}  // namespace ergotic::audio
