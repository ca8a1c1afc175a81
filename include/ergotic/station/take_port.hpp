// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::station {

/// Port through which the sound of a recorded take enters the audio host, in addition to that of
/// the instrument. One thread plays the take and writes, ahead of time; the host's real-time thread
/// reads. If the writer is late the take pauses, so that no frame is lost.
class TakePort {
 public:
  /// \param rate_hz  of the sound. Realtime: no. Thread: setup
  TakePort(std::size_t capacity_frames, int channels, double rate_hz);

  /// Begins another take. \pre isSilent(). Realtime: yes. Thread: writer
  void open() noexcept { open_.store(true, std::memory_order_release); }
  /// Ends the take: it fades out within kFadeS, and its remaining frames are dropped.
  /// Realtime: yes. Thread: any
  void close() noexcept { open_.store(false, std::memory_order_release); }
  /// \return whether nothing of a take is left. Realtime: yes. Thread: writer
  bool isSilent() const noexcept {
    return read_.load(std::memory_order_acquire) == written_.load(std::memory_order_relaxed);
  }

  /// \param frames  [nframes][channels]
  /// \return false if there is no room (none is taken). Realtime: yes. Thread: writer
  bool push(const float* frames, int nframes) noexcept;
  /// Frames that have sounded or were dropped since the port was made. Realtime: yes. Thread: any
  std::int64_t sounded() const noexcept {
    return static_cast<std::int64_t>(read_.load(std::memory_order_acquire));
  }
  int channels() const noexcept { return static_cast<int>(channels_); }

  /// The next frame and what it is to be multiplied by: 1 but where it fades in or out.
  /// \return [channels], valid until the next call; null: there is none
  /// Realtime: yes. Thread: reader
  ERGOTIC_REALTIME const float* next(float& gain) noexcept;

  static constexpr double kFadeS = 0.005;

 private:
  std::size_t capacity_;
  std::size_t channels_;
  float step_;  // of the gain, per frame
  std::vector<float> samples_;
  std::atomic<bool> open_{false};
  std::atomic<std::size_t> written_{0};
  std::atomic<std::size_t> read_{0};
  float gain_ = 0.0F;      // the reader's
  bool is_given_ = false;  // the reader still has the frame at read_
};

}  // namespace ergotic::station
