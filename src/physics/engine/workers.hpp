// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace ergotic::physics {

/// Threads that take a share of the items of a block from the thread that runs it.
///
/// Every item is claimed once per block, by whoever comes first: the running thread from the first
/// on, the others from the last. The running thread never waits for anybody to begin: what nobody
/// has claimed it does itself. Only for items that another thread has begun it waits, within a
/// limit, once. It neither locks nor calls the system.
///
/// Between blocks the threads spin for a short while, then sleep until shortly before they expect
/// the next one. They flush denormals, and take the real-time priority of the running thread.
class Workers {
 public:
  /// \param threads   that work on a block, the running one included; 1: no other is made
  /// \param limit_ns  longest wait for items that others have begun
  /// \param step      does an item, in any of the threads; must not throw
  /// Realtime: no
  Workers(int threads,
          std::size_t items,
          std::int64_t limit_ns,
          std::function<void(std::size_t)> step);
  /// Waits for items under way.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Number of these threads for which there are items and processors.
  static int useful(int threads, std::size_t items);

  int threads() const noexcept { return static_cast<int>(threads_.size()) + 1; }

  /// Does every item once. \return false if some are still under way at the limit: areDone() tells
  /// when they are done. \pre none is under way. Thread: one at a time. Realtime: yes
  bool run() noexcept;

  /// Whether all items of the last run() are done. Realtime: yes
  bool areDone() const noexcept;

 private:
  struct alignas(64) Item {
    std::atomic<std::uint64_t> claimed{0};  // the last block it was claimed in
    std::atomic<std::uint64_t> done{0};
  };
  class Rest;

  void work() noexcept;
  void takeLast(std::uint64_t block) noexcept;
  static bool claim(Item& item, std::uint64_t block) noexcept;

  const std::size_t items_count_;
  const std::unique_ptr<Item[]> items_;
  const std::int64_t limit_ns_;
  const std::function<void(std::size_t)> step_;
  alignas(64) std::atomic<std::uint64_t> block_{0};
  std::atomic<int> priority_{0};  // of the running thread; 0: none
  std::atomic<bool> ends_{false};
  std::vector<std::thread> threads_;
};

}  // namespace ergotic::physics
