// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <iostream>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::test {

/// A thread that nothing in a test outranks notes when the machine did not let it run.
class ReferenceThread {
 public:
  ReferenceThread() : thread_([this] { run(); }) {}
  ~ReferenceThread() {
    stop_ = true;
    thread_.join();
  }
  ReferenceThread(const ReferenceThread&) = delete;
  ReferenceThread& operator=(const ReferenceThread&) = delete;

  /// Whether a gap of `kGapNs` or more began, went on or ended between these times of
  /// CLOCK_MONOTONIC.
  bool sawGap(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(mutex_);
    return std::any_of(gaps_.begin(), gaps_.end(), [=](const Gap& gap) {
      return gap.start_ns <= to_ns && gap.end_ns >= from_ns;
    });
  }

  /// How long such gaps lasted between these times of CLOCK_MONOTONIC, together.
  std::int64_t gapsNs(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(mutex_);
    return std::accumulate(gaps_.begin(), gaps_.end(), std::int64_t{0},
                           [=](std::int64_t sum, const Gap& gap) {
                             const std::int64_t within_ns =
                                 std::min(gap.end_ns, to_ns) - std::max(gap.start_ns, from_ns);
                             return sum + std::max(within_ns, std::int64_t{0});
                           });
  }

  static constexpr std::int64_t kGapNs = 5'000'000;

 private:
  struct Gap {
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;
  };

  void run() {
    constexpr std::int64_t kPauseNs = 1'000'000;
    if (const rt::Outcome outcome = rt::makeRealtime(90); !outcome.ok) {
      std::cerr << "reference thread: " << outcome.message << '\n';
    }
    std::int64_t last = rt::monotonicNs();
    while (!stop_) {
      rt::sleepUntilNs(last + kPauseNs);
      const std::int64_t now = rt::monotonicNs();
      if (now - last >= kGapNs) {
        const std::lock_guard lock(mutex_);
        gaps_.push_back({last, now});
      }
      last = now;
    }
  }

  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Gap> gaps_;
  std::thread thread_;
};

}  // namespace ergotic::test
