// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sched.h>

#include <atomic>
#include <iostream>
#include <mutex>
#include <thread>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// A thread on each processor that nothing in a test outranks notes when the machine did not let it
/// run: the host may take one processor away and leave the others.
class ReferenceThreads {
 public:
  ReferenceThreads() {
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (isOurs(cpu)) {
        threads_.emplace_back([this, cpu] { run(cpu); });
      }
    }
  }
  ~ReferenceThreads() {
    stop_ = true;
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }
  ReferenceThreads(const ReferenceThreads&) = delete;
  ReferenceThreads& operator=(const ReferenceThreads&) = delete;

  /// Whether a gap of `kGapNs` or more began, went on or ended between these times of
  /// CLOCK_MONOTONIC.
  bool sawGap(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(mutex_);
    return std::any_of(gaps_.begin(), gaps_.end(), [=](const Gap& gap) {
      return gap.start_ns <= to_ns && gap.end_ns >= from_ns;
    });
  }

  /// For how long there was such a gap between these times of CLOCK_MONOTONIC, on any processor.
  std::int64_t gapsNs(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::lock_guard lock(mutex_);
    std::vector<Gap> gaps = gaps_;
    std::sort(gaps.begin(), gaps.end(),
              [](const Gap& a, const Gap& b) { return a.start_ns < b.start_ns; });
    std::int64_t sum = 0;
    std::int64_t counted_to_ns = from_ns;
    for (const Gap& gap : gaps) {
      const std::int64_t end_ns = std::min(gap.end_ns, to_ns);
      sum += std::max(end_ns - std::max(gap.start_ns, counted_to_ns), std::int64_t{0});
      counted_to_ns = std::max(counted_to_ns, end_ns);
    }
    return sum;
  }

  static constexpr std::int64_t kGapNs = 5'000'000;

 private:
  struct Gap {
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;
  };

  static bool isOurs(int cpu) {
    cpu_set_t allowed;
    return sched_getaffinity(0, sizeof(allowed), &allowed) == 0 && CPU_ISSET(cpu, &allowed);
  }

  void run(int cpu) {
    constexpr std::int64_t kPauseNs = 1'000'000;
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(cpu, &only);
    if (sched_setaffinity(0, sizeof(only), &only) != 0) {
      std::cerr << "reference thread: not on processor " << cpu << '\n';
    }
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
  std::vector<std::thread> threads_;
};

}  // namespace ergotic::test
