// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ergotic::station {

/// Lock-free FIFO of audio frames between one writing and one reading thread, each frame under the
/// index it belongs to: what is missing or late can never shift what follows.
class FrameFifo {
 public:
  /// Realtime: no. Thread: setup
  FrameFifo(std::size_t capacity, int channels)
      : capacity_(capacity),
        channels_(static_cast<std::size_t>(channels)),
        index_(capacity),
        samples_(capacity * channels_) {}

  /// Frames `first`, `first` + 1, ...; indices never go back.
  /// \param frames  [nframes][channels]
  /// \return false if there is no room (none is taken). Realtime: yes. Thread: writer
  bool push(std::int64_t first, const float* frames, int nframes) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const auto count = static_cast<std::size_t>(nframes);
    if (head + count - tail_.load(std::memory_order_acquire) > capacity_) {
      return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t slot = (head + i) % capacity_;
      index_[slot] = first + static_cast<std::int64_t>(i);
      std::copy_n(frames + i * channels_, channels_, samples_.data() + slot * channels_);
    }
    head_.store(head + count, std::memory_order_release);
    return true;
  }

  /// The frame `wanted`, or null if it is not there; frames before it are discarded.
  /// \return [channels], valid until `release`. Realtime: yes. Thread: reader
  const float* take(std::int64_t wanted) noexcept {
    const std::size_t head = head_.load(std::memory_order_acquire);
    while (read_ != head && index_[read_ % capacity_] < wanted) {
      ++read_;
    }
    if (read_ == head || index_[read_ % capacity_] != wanted) {
      return nullptr;
    }
    return samples_.data() + (read_++ % capacity_) * channels_;
  }

  /// Gives back the room of all frames taken or discarded. Realtime: yes. Thread: reader
  void release() noexcept { tail_.store(read_, std::memory_order_release); }

  /// Discards all. Realtime: yes. Thread: reader
  void clear() noexcept {
    read_ = head_.load(std::memory_order_acquire);
    release();
  }

 private:
  std::size_t capacity_;
  std::size_t channels_;
  std::vector<std::int64_t> index_;
  std::vector<float> samples_;
  std::size_t read_ = 0;              // reader's own, ahead of tail_ until release
  std::atomic<std::size_t> head_{0};  // frames ever pushed
  std::atomic<std::size_t> tail_{0};  // frames ever given back
};

}  // namespace ergotic::station
