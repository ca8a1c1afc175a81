// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/frame_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::tools {

namespace {

namespace fs = std::filesystem;

/// The file that `path` means.
std::string regularFile(const std::string& path) {
  std::error_code error;
  const fs::path file =
      fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    throw Exception(path +
                    ": is no regular file, and the header of a WAV file is written last, which "
                    "devices and pipes do not bear. Give the name of a file, or leave out --out to "
                    "play without writing");
  }
  return file.string();
}

}  // namespace

FrameWriter::FrameWriter(std::string path,
                         double sample_rate,
                         int channels,
                         audio::WavFormat format,
                         const SoundWish& wish)
    : path_(std::move(path)), format_(format), wish_(wish), channels_(channels) {
  if (path_.empty()) {
    return;
  }
  path_ = regularFile(path_);
  if (channels_ < 1) {
    throw Exception(path_ + ": the scene has no outputs, there is nothing to write");
  }
  // In the same folder, so that the rename is one step; named by process, so that two do not meet.
  unfinished_path_ = path_ + "." + std::to_string(getpid()) + ".part";
  file_ = std::make_unique<audio::WavWriter>(unfinished_path_, sample_rate, channels_,
                                             wish_.isAny() ? audio::WavFormat::kDouble : format_);
}

FrameWriter::~FrameWriter() {
  if (!unfinished_path_.empty()) {
    file_.reset();
    std::remove(unfinished_path_.c_str());
  }
}

void FrameWriter::write(const double* frames, std::int64_t nframes) {
  const std::int64_t samples = nframes * channels_;
  for (std::int64_t i = 0; i < samples; ++i) {
    if (!std::isfinite(frames[i])) {
      throw Exception("the sound is not finite from frame " +
                      std::to_string(frames_ + i / channels_) + " on, output channel " +
                      std::to_string(i % channels_ + 1) + ": the model blows up; nothing is kept");
    }
    peak_ = std::max(peak_, std::abs(frames[i]));
  }
  if (file_) {
    file_->write(frames, nframes);
  }
  frames_ += nframes;
}

void FrameWriter::grantWish() {
  if (wish_.loudness) {
    gain_ = normalizingGain(levelOf(unfinished_path_), *wish_.loudness);
  }
  const std::string played = unfinished_path_;
  unfinished_path_ += ".2";
  clipped_ = finishSound(played, unfinished_path_, format_, {gain_, wish_.fade_s});
  std::remove(played.c_str());
}

void FrameWriter::finish() {
  if (!file_) {
    return;
  }
  file_->finish();
  clipped_ = file_->clippedSamples();
  if (wish_.isAny()) {
    grantWish();
  }
  level_ = levelOf(unfinished_path_);
  if (std::rename(unfinished_path_.c_str(), path_.c_str()) != 0) {
    throw Exception(path_ + ": cannot be written: " + std::strerror(errno));
  }
  unfinished_path_.clear();
}

}  // namespace ergotic::tools
