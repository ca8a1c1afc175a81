// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/wav.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <sstream>

#include "ergotic/exception.hpp"

namespace ergotic::audio {

namespace {

constexpr double kFullScale24 = 8388608.0;  // 2^23
constexpr int kMaxRate = 1'000'000;

[[noreturn]] void failOn(const std::string& path, const std::string& what) {
  throw Exception(path + ": " + what);
}

/// libsndfile's reason, with the system's where libsndfile does not name it itself.
std::string reason(SNDFILE* file, int system_error) {
  std::string text = sf_strerror(file);
  if (system_error != 0 && text.find(std::strerror(system_error)) == std::string::npos) {
    text += std::string(" (") + std::strerror(system_error) + ")";
  }
  return text;
}

int sndfileFormat(WavFormat format) {
  switch (format) {
    case WavFormat::kFloat:
      return SF_FORMAT_RF64 | SF_FORMAT_FLOAT;
    case WavFormat::kDouble:
      return SF_FORMAT_RF64 | SF_FORMAT_DOUBLE;
    case WavFormat::k24:
      return SF_FORMAT_RF64 | SF_FORMAT_PCM_24;
  }
  throw Exception("no such WAV format");
}

sf_count_t put(SNDFILE* file, const double* frames, sf_count_t nframes) {
  return sf_writef_double(file, frames, nframes);
}
sf_count_t put(SNDFILE* file, const float* frames, sf_count_t nframes) {
  return sf_writef_float(file, frames, nframes);
}

}  // namespace

WavFormat wavFormatOf(const std::string& name) {
  if (name == "float") {
    return WavFormat::kFloat;
  }
  if (name == "double") {
    return WavFormat::kDouble;
  }
  if (name == "24") {
    return WavFormat::k24;
  }
  throw Exception("WAV format `" + name + "`, allowed: float, double, 24");
}

struct WavReader::File {
  std::string path;
  SF_INFO info{};
  SNDFILE* handle = nullptr;
};

WavReader::WavReader(const std::string& path) : file_(new File{path, {}, nullptr}) {
  errno = 0;
  file_->handle = sf_open(path.c_str(), SFM_READ, &file_->info);
  if (file_->handle == nullptr) {
    failOn(path, "cannot read: " + reason(nullptr, errno));
  }
}

WavReader::~WavReader() {
  sf_close(file_->handle);
}

double WavReader::sampleRate() const noexcept {
  return file_->info.samplerate;
}
int WavReader::channels() const noexcept {
  return file_->info.channels;
}
std::int64_t WavReader::frames() const noexcept {
  return file_->info.frames;
}

std::int64_t WavReader::read(double* to, std::int64_t nframes) {
  const sf_count_t got = sf_readf_double(file_->handle, to, nframes);
  if (sf_error(file_->handle) != SF_ERR_NO_ERROR) {
    failOn(file_->path, "cannot read: " + reason(file_->handle, 0));
  }
  return got;
}

std::vector<double> WavReader::readAll() {
  constexpr std::int64_t kBlock = 1 << 14;  // the header's length is not to be trusted
  const auto width = static_cast<std::size_t>(channels());
  std::vector<double> all;
  for (std::int64_t got = kBlock; got == kBlock;) {
    const std::size_t before = all.size();
    all.resize(before + static_cast<std::size_t>(kBlock) * width);
    got = read(all.data() + before, kBlock);
    all.resize(before + static_cast<std::size_t>(got) * width);
  }
  return all;
}

struct WavWriter::File {
  std::string path;
  int channels;
  WavFormat format;
  SNDFILE* handle = nullptr;
  std::int64_t frames = 0;
  std::int64_t clipped = 0;
  std::vector<int> integers{};  // scratch

  template <class Sample>
  void requireFinite(const Sample* samples, std::int64_t count) const;
  template <class Sample>
  sf_count_t put24(const Sample* samples, std::int64_t nframes);
  template <class Sample>
  void write(const Sample* samples, std::int64_t nframes);
};

template <class Sample>
void WavWriter::File::requireFinite(const Sample* samples, std::int64_t count) const {
  const Sample* end = samples + count;
  const Sample* bad = std::find_if(samples, end, [](Sample s) { return !std::isfinite(s); });
  if (bad != end) {
    std::ostringstream message;
    message << "sample " << frames + (bad - samples) / channels << " of channel "
            << (bad - samples) % channels + 1 << " is " << *bad
            << "; only finite samples can be written";
    failOn(path, message.str());
  }
}

template <class Sample>
sf_count_t WavWriter::File::put24(const Sample* samples, std::int64_t nframes) {
  const auto count = static_cast<std::size_t>(nframes * channels);
  integers.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto sample = static_cast<double>(samples[i]);
    clipped += std::abs(sample) > 1.0 ? 1 : 0;
    // libsndfile would truncate; it keeps the upper 24 bits of an int.
    const double rounded = std::nearbyint(sample * kFullScale24);
    integers[i] = static_cast<int>(std::clamp(rounded, -kFullScale24, kFullScale24 - 1.0)) * 256;
  }
  return sf_writef_int(handle, integers.data(), nframes);
}

template <class Sample>
void WavWriter::File::write(const Sample* samples, std::int64_t nframes) {
  if (handle == nullptr) {
    failOn(path, "is finished already");
  }
  requireFinite(samples, nframes * channels);
  errno = 0;
  const sf_count_t written =
      format == WavFormat::k24 ? put24(samples, nframes) : put(handle, samples, nframes);
  frames += written;
  if (written != nframes) {
    failOn(path,
           "only " + std::to_string(frames) + " frames could be written: " + reason(handle, errno));
  }
}

WavWriter::WavWriter(const std::string& path, double sample_rate, int channels, WavFormat format)
    : file_(new File{path, channels, format}) {
  if (!(sample_rate >= 1.0 && sample_rate <= kMaxRate) || sample_rate != std::floor(sample_rate)) {
    std::ostringstream message;
    message << "sample rate " << sample_rate << " Hz, allowed: whole numbers in 1..." << kMaxRate;
    failOn(path, message.str());
  }
  SF_INFO info{};
  info.samplerate = static_cast<int>(sample_rate);
  info.channels = channels;
  info.format = sndfileFormat(format);
  errno = 0;
  file_->handle = sf_open(path.c_str(), SFM_WRITE, &info);
  if (file_->handle == nullptr) {
    failOn(path, "cannot write: " + reason(nullptr, errno));
  }
  sf_command(file_->handle, SFC_RF64_AUTO_DOWNGRADE, nullptr, SF_TRUE);
}

WavWriter::~WavWriter() {
  if (file_->handle != nullptr) {
    sf_close(file_->handle);
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
  errno = 0;
  sf_write_sync(file_->handle);
  const int error = sf_error(file_->handle);
  const std::string why = reason(file_->handle, errno);
  const int close_error = sf_close(file_->handle);
  file_->handle = nullptr;
  if (error != SF_ERR_NO_ERROR || close_error != SF_ERR_NO_ERROR) {
    failOn(file_->path, "cannot complete: " + (error != 0 ? why : sf_error_number(close_error)));
  }
}

std::int64_t WavWriter::frames() const noexcept {
  return file_->frames;
}
std::int64_t WavWriter::clippedSamples() const noexcept {
  return file_->clipped;
}

}  // namespace ergotic::audio
