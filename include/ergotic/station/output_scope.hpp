// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"

namespace ergotic::station {

/// Copies blocks of the output for displays, whole frames in a row. While there is no display, it
/// costs one atomic read per frame. Two threads: the one that plays, and one that displays.
class OutputScope {
 public:
  static constexpr std::size_t kFrames = 2048;

  /// Realtime: no
  explicit OutputScope(int channels)
      : channels_(static_cast<std::size_t>(channels)),
        blocks_(std::vector<float>(kFrames * channels_)) {}

  /// Whether frames are copied from now on. Realtime: yes. Thread: that looks
  void watch(bool is_wanted) noexcept { is_wanted_.store(is_wanted, std::memory_order_relaxed); }
  /// \return whether `latest` is another block now. Realtime: yes. Thread: that looks
  bool refresh() noexcept { return blocks_.refresh(); }
  /// [channels][kFrames] of full scale, oldest first. Thread: that looks
  const std::vector<float>& latest() const noexcept { return blocks_.latest(); }

  /// The next frame that sounds, or what is seen of it, times a gain. \param channels  of the
  /// frame, others are silent; null: silence. Realtime: yes. Thread: that plays
  ERGOTIC_REALTIME void take(const float* frame, int channels, float gain) noexcept {
    if (!is_wanted_.load(std::memory_order_relaxed)) {
      filled_ = 0;
      return;
    }
    const std::size_t given =
        frame != nullptr ? std::min(static_cast<std::size_t>(channels), channels_) : 0;
    std::vector<float>& block = blocks_.draft();
    for (std::size_t c = 0; c < channels_; ++c) {
      block[c * kFrames + filled_] = c < given ? gain * frame[c] : 0.0F;
    }
    if (++filled_ == kFrames) {
      blocks_.publish();
      filled_ = 0;
    }
  }

 private:
  std::size_t channels_;
  std::atomic<bool> is_wanted_{false};
  rt::Mailbox<std::vector<float>> blocks_;
  std::size_t filled_ = 0;  // frames of the draft. Thread: that plays
};

}  // namespace ergotic::station
