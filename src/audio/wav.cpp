// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/wav.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "audio/wav_header.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::audio {

namespace {

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

/// Finds an unfinished file; not in a pipe, which can be read but once.
std::optional<UnfinishedWav> unfinishedAt(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return std::nullopt;
  }
  std::ifstream file(path, std::ios::binary);
  return findUnfinished(file);
}

int subtypeOf(const WavShape& shape) {
  switch (shape.sample_bytes) {
    case 1:
      return SF_FORMAT_PCM_U8;
    case 2:
      return SF_FORMAT_PCM_16;
    case 3:
      return SF_FORMAT_PCM_24;
    case 4:
      return shape.is_float ? SF_FORMAT_FLOAT : SF_FORMAT_PCM_32;
    default:
      return SF_FORMAT_DOUBLE;
  }
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
  bool is_unfinished = false;
  sf_count_t left = 0;  // frames: libsndfile goes beyond the end of a raw file

  void open();
  void open(const UnfinishedWav& unfinished);
};

void WavReader::File::open() {
  errno = 0;
  handle = sf_open(path.c_str(), SFM_READ, &info);
  if (handle == nullptr) {
    failOn(path, "cannot read: " + reason(nullptr, errno));
  }
  left = info.frames;
}

/// libsndfile believes a header that says 0.
void WavReader::File::open(const UnfinishedWav& unfinished) {
  is_unfinished = true;
  info.samplerate = unfinished.shape.rate;
  info.channels = unfinished.shape.channels;
  info.format = SF_FORMAT_RAW | SF_ENDIAN_LITTLE | subtypeOf(unfinished.shape);
  open();
  sf_count_t begin = unfinished.begin;
  if (sf_command(handle, SFC_SET_RAW_START_OFFSET, &begin, sizeof begin) != 0 ||
      sf_seek(handle, 0, SEEK_SET) != 0) {
    failOn(path, "cannot read: " + reason(handle, 0));
  }
  info.frames = unfinished.frames;
  left = unfinished.frames;
}

WavReader::WavReader(const std::string& path) : file_(new File{path}) {
  const std::optional<UnfinishedWav> unfinished = unfinishedAt(path);
  unfinished ? file_->open(*unfinished) : file_->open();
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

bool WavReader::isUnfinished() const noexcept {
  return file_->is_unfinished;
}

std::int64_t WavReader::read(double* to, std::int64_t nframes) {
  const sf_count_t got =
      sf_readf_double(file_->handle, to, std::min<sf_count_t>(nframes, file_->left));
  file_->left -= got;
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

}  // namespace ergotic::audio
