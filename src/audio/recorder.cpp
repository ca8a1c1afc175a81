// SPDX-License-Identifier: BSD-3-Clause
#include "audio/recorder.hpp"

#include <algorithm>
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

void Recorder::process(const rt::Block& block) noexcept {
  const std::size_t count = block.nframes * channels_;
  if (samples_.writable() < count || headers_.writable() == 0) {
    dropped_ += block.nframes;
    return;
  }
  for (std::size_t channel = 0; channel < channels_; ++channel) {
    for (std::size_t frame = 0; frame < block.nframes; ++frame) {
      interleaved_[frame * channels_ + channel] = block.inputs[channel][frame];
    }
  }
  samples_.push(interleaved_.data(), count);
  headers_.push({block.start.frames, block.nframes, dropped_});
}

void Recorder::drain(WavWriter& file, std::int64_t limit) {
  Header header;
  while (headers_.pop(header)) {
    block_.resize(static_cast<std::size_t>(header.nframes) * channels_);
    samples_.pop(block_.data(), block_.size());
    fillGap(file, header, limit);
    file.write(block_.data(), std::min(header.nframes, limit - file.frames()));
  }
}

void Recorder::fillGap(WavWriter& file, const Header& header, std::int64_t limit) {
  if (!first_) {
    first_ = header.start;
  }
  const std::int64_t gap = header.start - (*first_ + file.frames());
  const std::int64_t room = limit - file.frames();
  if (room == 0) {
    return;
  }
  if (gap < 0 || gap > max_gap_) {
    throw Exception("JACK's frame time jumped by " + std::to_string(gap) +
                    " frames, allowed: 0..." + std::to_string(max_gap_) +
                    "; the recording ends before the jump");
  }
  const std::int64_t zeros = std::min(gap, room);
  const std::vector<float> silence(static_cast<std::size_t>(zeros) * channels_, 0.0F);
  file.write(silence.data(), zeros);
  lost_ += std::max<std::int64_t>(0, zeros - (header.dropped - dropped_before_));
  dropped_before_ = header.dropped;
}

}  // namespace ergotic::audio
