// SPDX-License-Identifier: BSD-3-Clause
#include "audio/recorder.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "ergotic/exception.hpp"

namespace ergotic::audio {

namespace {

constexpr std::size_t kSmallestBlock = 16;  // frames, JACK's shortest period
constexpr double kMaxGapSeconds = 60.0;

}  // namespace

Recorder::Recorder(int channels, std::size_t ring_frames)
    : channels_(static_cast<std::size_t>(channels)),
      samples_(ring_frames * channels_),
      headers_(ring_frames / kSmallestBlock + 1) {}

void Recorder::audioStarted(double sample_rate_hz, std::uint32_t period_frames) {
  interleaved_.resize(period_frames * channels_);
  max_gap_ = static_cast<std::int64_t>(kMaxGapSeconds * sample_rate_hz);
}

void Recorder::process(const rt::Period& period) noexcept {
  const std::size_t count = period.nframes * channels_;
  if (samples_.writable() < count || headers_.writable() == 0) {
    dropped_ += period.nframes;
    return;
  }
  for (std::size_t channel = 0; channel < channels_; ++channel) {
    for (std::size_t frame = 0; frame < period.nframes; ++frame) {
      interleaved_[frame * channels_ + channel] = period.inputs[channel][frame];
    }
  }
  samples_.push(interleaved_.data(), count);
  headers_.push({period.start.frames, period.nframes, dropped_});
}

void Recorder::drain(WavWriter& file, std::int64_t limit) {
  Header header;
  while (headers_.pop(header)) {
    if (held_) {
      if (header.start == held_->start) {
        held_->start -= held_->nframes;  // it was late: the newer block belongs there
      }
      place(file, limit);
    }
    held_ = header;
    block_.resize(static_cast<std::size_t>(header.nframes) * channels_);
    samples_.pop(block_.data(), block_.size());
  }
}

void Recorder::finish(WavWriter& file, std::int64_t limit) {
  drain(file, limit);
  if (held_) {
    place(file, limit);
    held_.reset();
  }
}

void Recorder::place(WavWriter& file, std::int64_t limit) {
  if (!first_) {
    first_ = held_->start;
  }
  const std::int64_t gap = held_->start - (*first_ + file.frames());
  if (file.frames() == limit) {
    return;
  }
  if (std::abs(gap) > max_gap_) {
    throw Exception("JACK's frame time jumped by " + std::to_string(gap) + " frames, allowed: +-" +
                    std::to_string(max_gap_) + "; the recording ends before the jump");
  }
  if (gap < 0) {
    displaced_ += held_->nframes;
    return;
  }
  fillGap(file, std::min(gap, limit - file.frames()));
  file.write(block_.data(), std::min(held_->nframes, limit - file.frames()));
}

void Recorder::fillGap(WavWriter& file, std::int64_t gap) {
  const std::vector<float> silence(static_cast<std::size_t>(gap) * channels_, 0.0F);
  file.write(silence.data(), gap);
  lost_ += std::max<std::int64_t>(0, gap - (held_->dropped - dropped_before_));
  dropped_before_ = held_->dropped;
}

}  // namespace ergotic::audio
