// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/workers.hpp"

#include <sched.h>

#include <algorithm>
#include <utility>

#include <sys/prctl.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::physics {
namespace {

constexpr std::int64_t kSpinNs = 20'000;   // how long a thread that has nothing to do stays awake
constexpr std::int64_t kEarlyNs = 30'000;  // it wakes that much before the next block
constexpr std::int64_t kShortestNs = 50'000;  // not worth a sleep
constexpr std::int64_t kLongestNs = 10'000'000;
constexpr unsigned long kTimerSlackNs = 1'000;  // of sleeps without a real-time priority
constexpr int kSpinsPerLook = 64;               // at the clock

/// Lets the other thread of the core go on.
inline void relax() noexcept {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Spins until `done()` says so. \return false if it did not before `deadline_ns`
template <class Done>
bool spinUntil(std::int64_t deadline_ns, const Done& done) noexcept {
  for (;;) {
    for (int spin = 0; spin < kSpinsPerLook; ++spin) {
      if (done()) {
        return true;
      }
      relax();
    }
    if (rt::monotonicNs() >= deadline_ns) {
      return done();
    }
  }
}

}  // namespace

/// Predicts when the next block comes, from the times of the last ones.
class Workers::Rest {
 public:
  void blockCame() noexcept {
    const std::int64_t now = rt::monotonicNs();
    interval_ns_ = std::min(kLongestNs, now - came_ns_);
    came_ns_ = now;
    expected_ns_ = now + interval_ns_;
    missed_ = 0;
  }

  /// Time until which to look for the next block before sleeping again.
  std::int64_t awakeUntilNs() const noexcept {
    const std::int64_t now = rt::monotonicNs();
    const bool is_soon = expected_ns_ > now && expected_ns_ - now <= kEarlyNs;
    return (is_soon ? expected_ns_ : now) + kSpinNs;
  }

  /// Sleeps until shortly before the next block. One that does not come is expected later and
  /// later.
  void sleep() noexcept {
    const std::int64_t now = rt::monotonicNs();
    if (expected_ns_ - kEarlyNs < now) {
      missed_ = std::min(missed_ + 1, 16);
      expected_ns_ = now + kEarlyNs + std::clamp(interval_ns_ << missed_, kShortestNs, kLongestNs);
    }
    if (expected_ns_ - kEarlyNs - now > kSpinNs) {
      rt::sleepUntilNs(expected_ns_ - kEarlyNs);
    }
  }

 private:
  std::int64_t came_ns_ = rt::monotonicNs();
  std::int64_t interval_ns_ = kLongestNs;
  std::int64_t expected_ns_ = came_ns_;
  int missed_ = 0;
};

Workers::Workers(int threads,
                 std::size_t items,
                 std::int64_t limit_ns,
                 std::function<void(std::size_t)> step)
    : items_count_(items),
      items_(std::make_unique<Item[]>(items)),
      limit_ns_(limit_ns),
      step_(std::move(step)) {
  for (int t = 1; t < threads; ++t) {
    threads_.emplace_back([this] { work(); });
  }
}

int Workers::useful(int threads, std::size_t items) {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int processors = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  return std::max(1, std::min({threads, static_cast<int>(items), processors}));
}

Workers::~Workers() {
  ends_.store(true, std::memory_order_relaxed);
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

/// An item can be claimed in a block only if it was in the one before: a thread that is late by a
/// block or more claims nothing.
bool Workers::claim(Item& item, std::uint64_t block) noexcept {
  std::uint64_t before = block - 1;
  return item.claimed.compare_exchange_strong(before, block, std::memory_order_relaxed);
}

ERGOTIC_REALTIME bool Workers::run() noexcept {
  const std::uint64_t block = block_.load(std::memory_order_relaxed) + 1;
  priority_.store(rt::realtimePriority(), std::memory_order_relaxed);
  block_.store(block, std::memory_order_release);
  for (std::size_t i = 0; i < items_count_; ++i) {
    if (claim(items_[i], block)) {
      step_(i);
      items_[i].done.store(block, std::memory_order_relaxed);
    }
  }
  return spinUntil(rt::monotonicNs() + limit_ns_, [this]() noexcept { return areDone(); });
}

ERGOTIC_REALTIME bool Workers::areDone() const noexcept {
  const std::uint64_t block = block_.load(std::memory_order_relaxed);
  const auto is_done = [block](const Item& item) noexcept {
    return item.done.load(std::memory_order_acquire) == block;
  };
  return std::all_of(items_.get(), items_.get() + items_count_, is_done);
}

void Workers::takeLast(std::uint64_t block) noexcept {
  for (std::size_t i = items_count_; i-- > 0;) {
    if (claim(items_[i], block)) {
      step_(i);
      items_[i].done.store(block, std::memory_order_release);
    }
  }
}

void Workers::work() noexcept {
  const rt::FlushDenormals flush_denormals;
  rt::prefaultStack();
  prctl(PR_SET_TIMERSLACK, kTimerSlackNs);
  Rest rest;
  int priority = 0;
  std::uint64_t last = 0;
  const auto has_come = [&]() noexcept {
    return block_.load(std::memory_order_acquire) != last || ends_.load(std::memory_order_relaxed);
  };
  while (!ends_.load(std::memory_order_relaxed)) {
    if (!spinUntil(rest.awakeUntilNs(), has_come)) {
      rest.sleep();
      continue;
    }
    last = block_.load(std::memory_order_acquire);
    rest.blockCame();
    const int wanted = priority_.load(std::memory_order_relaxed);
    if (wanted > 0 && wanted != priority) {
      rt::makeRealtime(wanted);  // refused: it goes on without
      priority = wanted;
    }
    takeLast(last);
  }
}

}  // namespace ergotic::physics
