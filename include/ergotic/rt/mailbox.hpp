// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace ergotic::rt {

/// Latest value from one writing to one reading thread (triple buffer): neither ever waits.
/// The writer fills `draft()` in place and publishes it; the reader sees whole values only.
template <class T>
class Mailbox {
 public:
  Mailbox() = default;
  /// Every slot starts as `initial` (set sizes of vectors here, outside the real-time thread).
  explicit Mailbox(const T& initial) : slots_{initial, initial, initial} {}

  /// The slot to fill; holds an older value. Realtime: yes. Thread: writer
  T& draft() noexcept { return slots_[static_cast<std::size_t>(writing_)]; }

  /// Hands the draft over. Realtime: yes. Thread: writer
  void publish() noexcept {
    writing_ = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Takes the newest value if there is one that was not yet seen.
  /// \return true if `latest()` is now another value. Realtime: yes. Thread: reader
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
      return false;
    }
    reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  const T& latest() const noexcept { return slots_[static_cast<std::size_t>(reading_)]; }

 private:
  static constexpr int kFresh = 4;
  static constexpr int kIndex = 3;
  std::array<T, 3> slots_{};
  int writing_ = 0;
  int reading_ = 1;
  std::atomic<int> middle_{2};
};

}  // namespace ergotic::rt
