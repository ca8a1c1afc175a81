// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/block_io.hpp"
#include "ergotic/rt/ring.hpp"

namespace ergotic::audio {

/// Takes blocks in a real-time thread, writes them to a file in another, each at its frame time.
class Recorder : public rt::BlockProcessor {
 public:
  /// \param ring_frames  how far the file may lag behind
  Recorder(int channels, std::size_t ring_frames);

  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  void audioStopped() noexcept override {}
  void process(const rt::Block& block) noexcept override;
  void xrun() noexcept override {}

  // Thread: the file's
  /// Writes what has arrived, zeros where blocks are missing.
  /// \param limit  frames that the file shall have at most
  /// \throws Exception from the file, or if the frame time jumps back or by more than a minute
  void drain(WavWriter& file, std::int64_t limit);
  std::int64_t firstFrame() const noexcept { return first_.value_or(0); }
  /// Frames that found the ring full. Thread: any
  std::int64_t droppedFrames() const noexcept { return dropped_; }
  /// Frames that never reached us, as far as written.
  std::int64_t lostFrames() const noexcept { return lost_; }

 private:
  struct Header {
    std::int64_t start = 0;
    std::int64_t nframes = 0;
    std::int64_t dropped = 0;  ///< frames dropped so far
  };

  void fillGap(WavWriter& file, const Header& header, std::int64_t limit);

  std::size_t channels_;
  rt::Ring<float> samples_;
  rt::Ring<Header> headers_;
  std::vector<float> interleaved_;  // the real-time thread's
  std::atomic<std::int64_t> dropped_{0};

  std::vector<float> block_;  // the file's thread's, as all below
  std::int64_t max_gap_ = 0;
  std::optional<std::int64_t> first_;
  std::int64_t dropped_before_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace ergotic::audio
