// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/frame_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::tools {

FrameWriter::FrameWriter(std::string path,
                         double sample_rate,
                         int channels,
                         audio::WavFormat format)
    : path_(std::move(path)), channels_(channels) {
  if (path_.empty()) {
    return;
  }
  if (channels_ < 1) {
    throw Exception(path_ + ": the scene has no outputs, there is nothing to write");
  }
  // In the same folder, so that the rename is one step; named by process, so that two do not meet.
  unfinished_path_ = path_ + "." + std::to_string(getpid()) + ".part";
  file_ = std::make_unique<audio::WavWriter>(unfinished_path_, sample_rate, channels_, format);
}

FrameWriter::~FrameWriter() {
  if (file_ && !finished_) {
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

void FrameWriter::finish() {
  if (!file_) {
    return;
  }
  file_->finish();
  if (std::rename(unfinished_path_.c_str(), path_.c_str()) != 0) {
    throw Exception(path_ + ": cannot be written: " + std::strerror(errno));
  }
  finished_ = true;
}

}  // namespace ergotic::tools
