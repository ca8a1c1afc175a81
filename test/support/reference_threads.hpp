// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace ergotic::test {

/// A thread on each processor notes when the machine did not let it run: the host may take one
/// processor away and leave the others. Thread: any
class ReferenceThreads {
 public:
  /// For what has real-time priority: threads that nothing in a test outranks. For what goes
  /// through ordinary threads, as all messages of ROS do: one of these.
  enum class Rank { kAboveAll, kOrdinary };

  /// \param pause_ns  from one look at the clock to the next: each takes some us of a processor
  explicit ReferenceThreads(Rank rank = Rank::kAboveAll, std::int64_t pause_ns = kPauseNs);
  ~ReferenceThreads();
  ReferenceThreads(const ReferenceThreads&) = delete;
  ReferenceThreads& operator=(const ReferenceThreads&) = delete;

  /// For how long at a time one of the processors stood still between these times of
  /// CLOCK_MONOTONIC, ns, with the pause before. Less than kShortestNs is never seen, and what is
  /// longer by a pause always.
  std::int64_t longestStallNs(std::int64_t from_ns, std::int64_t to_ns) const;

  /// Of the processors that the process may run on.
  int firstCpu() const { return processors_.front()->number; }

  static constexpr std::int64_t kShortestNs = 200'000;
  static constexpr std::int64_t kPauseNs = 200'000;
  static constexpr std::int64_t kMinNs = kShortestNs + kPauseNs;
  static constexpr std::int64_t kFinePauseNs = 100'000;  // sees whatever makes a tick of 3 kHz late
  /// Of threads above all; what they judge stands next to them, so that other tests come after it.
  static constexpr int kPriority = 90;

 private:
  struct Stall {
    std::int64_t from_ns = 0;
    std::int64_t to_ns = 0;
  };
  struct Processor {
    int number = 0;
    std::atomic<std::int64_t> ran_ns{0};  // last
    std::thread thread;
  };

  void run(Processor& processor);

  Rank rank_;
  std::int64_t pause_ns_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Stall> stalls_;
  std::vector<std::unique_ptr<Processor>> processors_;
};

}  // namespace ergotic::test
