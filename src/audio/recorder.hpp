// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/audio_processor.hpp"
#include "ergotic/rt/ring.hpp"

namespace ergotic::audio {

/// Takes blocks in a real-time thread, writes them to a file in another, each at its frame time.
///
/// A client that an asynchronous JACK server did not wait for may run a cycle late: it gets the
/// frame time of the next cycle, and the same again in that next one. So a block is held back until
/// its successor has confirmed its position.
class Recorder : public rt::AudioProcessor {
 public:
  /// \param ring_frames  how far the file may lag behind
  Recorder(int channels, std::size_t ring_frames);

  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  void audioStopped() noexcept override {}
  void process(const rt::Period& period) noexcept override;
  void xrun() noexcept override {}

  // Thread: the file's
  /// Writes what has arrived but the newest block, zeros where blocks are missing.
  /// \param limit  frames that the file shall have at most
  /// \throws Exception from the file, or if the frame time jumps by more than a minute
  void drain(WavWriter& file, std::int64_t limit);
  /// Writes the newest block too. \pre nothing arrives any more
  void finish(WavWriter& file, std::int64_t limit);
  std::int64_t firstFrame() const noexcept { return first_.value_or(0); }
  /// Frames that arrived and are not in the file: the ring was full, or two claim one frame time.
  std::int64_t droppedFrames() const noexcept { return dropped_ + displaced_; }
  /// Frames that never reached us, as far as written.
  std::int64_t lostFrames() const noexcept { return lost_; }

 private:
  struct Header {
    std::int64_t start = 0;
    std::int64_t nframes = 0;
    std::int64_t dropped = 0;  ///< frames dropped so far
  };

  void place(WavWriter& file, std::int64_t limit);
  void fillGap(WavWriter& file, std::int64_t gap);

  std::size_t channels_;
  rt::Ring<float> samples_;
  rt::Ring<Header> headers_;
  std::vector<float> interleaved_;  // the real-time thread's
  std::atomic<std::int64_t> dropped_{0};

  std::optional<Header> held_;  // the file's thread's, as all below
  std::vector<float> block_;    // samples of held_
  std::int64_t max_gap_ = 0;
  std::optional<std::int64_t> first_;
  std::int64_t dropped_before_ = 0;
  std::int64_t lost_ = 0;
  std::int64_t displaced_ = 0;
};

}  // namespace ergotic::audio
