// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <type_traits>

#include <boost/lockfree/spsc_queue.hpp>

namespace ergotic::rt {

/// Lock-free ring between exactly one writing and one reading thread.
/// A full ring is an answer, not an error: the writer counts what it could not push.
template <class T>
class Ring {
  static_assert(std::is_trivially_copyable_v<T>, "a ring moves plain data only");

 public:
  /// Realtime: no (allocates).
  explicit Ring(std::size_t capacity) : queue_(capacity) {}

  /// \return items taken in, from the front of `items`. Realtime: yes. Thread: writer
  std::size_t push(const T* items, std::size_t count) noexcept { return queue_.push(items, count); }
  bool push(const T& item) noexcept { return queue_.push(item); }

  /// \return items given out. Realtime: yes. Thread: reader
  std::size_t pop(T* items, std::size_t count) noexcept { return queue_.pop(items, count); }
  bool pop(T& item) noexcept { return queue_.pop(item); }
  /// \return the item that `pop` gives next; null if there is none. Realtime: yes. Thread: reader
  const T* front() const noexcept {
    return queue_.read_available() > 0 ? &queue_.front() : nullptr;
  }

  std::size_t readable() const noexcept { return queue_.read_available(); }   // Thread: reader
  std::size_t writable() const noexcept { return queue_.write_available(); }  // Thread: writer

 private:
  boost::lockfree::spsc_queue<T> queue_;
};

}  // namespace ergotic::rt
