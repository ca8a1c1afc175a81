// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/workers.hpp"

#include <atomic>
#include <ctime>
#include <limits>
#include <thread>

#include "ergotic/rt/clock.hpp"
#include "support/realtime_scope.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

constexpr std::int64_t kPatienceNs = 60'000'000'000;

/// Something that takes a while.
void dawdle(int rounds) {
  for (volatile int i = 0; i < rounds; i = i + 1) {
  }
}

TEST(WorkersThreadsTest, EveryItemIsDoneOncePerBlockAndSeenAfterIt) {
  for (const int threads : {1, 2, 3, 8}) {
    std::vector<std::int64_t> done(13, 0);  // no atomics: run() must order everything
    Workers workers(threads, done.size(), kPatienceNs, [&done](std::size_t i) {
      dawdle(static_cast<int>(20 * i));
      ++done[i];
    });
    for (std::int64_t block = 1; block <= 5000; ++block) {
      ASSERT_TRUE(workers.run());
      ASSERT_EQ(done, std::vector<std::int64_t>(done.size(), block)) << threads << " threads";
    }
  }
}

TEST(WorkersThreadsTest, OthersTakeTheirShare) {
  const std::thread::id self = std::this_thread::get_id();
  std::atomic<int> by_others{0};
  Workers workers(2, 2, kPatienceNs, [&](std::size_t) {
    by_others += std::this_thread::get_id() == self ? 0 : 1;
    dawdle(2000);
  });
  const std::int64_t deadline = rt::monotonicNs() + kPatienceNs;
  while (by_others == 0 && rt::monotonicNs() < deadline) {
    ASSERT_TRUE(workers.run());
  }
  EXPECT_GT(by_others, 0);
}

/// Of the whole process.
double processorS() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

TEST(WorkersThreadsTest, SleepWhileThereIsNothingToDo) {
  Workers workers(3, 3, kPatienceNs, [](std::size_t) { dawdle(100); });
  for (int block = 0; block < 20; ++block) {
    ASSERT_TRUE(workers.run());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const double before_s = processorS();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_LT(processorS() - before_s, 0.05) << "of 1 s, if two were awake";
}

TEST(WorkersThreadsTest, SleepBetweenTheBlocks) {
  Workers workers(2, 2, kPatienceNs, [](std::size_t) { dawdle(100); });
  const double before_s = processorS();
  for (int block = 0; block < 250; ++block) {
    ASSERT_TRUE(workers.run());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_LT(processorS() - before_s, 0.25) << "of half a second, if it was awake";
}

/// A worker that is stuck in an item until it is let go.
class StuckWorker {
 public:
  /// Runs blocks until the worker is stuck.
  void getStuck() {
    while (workers.run()) {
    }
  }
  void letGo() { stuck_ = false; }

  std::vector<int> done = std::vector<int>(2, 0);
  Workers workers{2, 2, 1'000'000, [this](std::size_t i) {
                    if (std::this_thread::get_id() != self_) {
                      while (stuck_) {
                        std::this_thread::yield();
                      }
                    } else {
                      dawdle(2000);
                    }
                    ++done[i];
                  }};

 private:
  const std::thread::id self_ = std::this_thread::get_id();
  std::atomic<bool> stuck_{true};
};

TEST(WorkersThreadsTest, AStuckWorkerIsNotWaitedForForever) {
  StuckWorker stuck;
  stuck.getStuck();
  EXPECT_FALSE(stuck.workers.areDone());
  EXPECT_FALSE(stuck.workers.areDone());
  stuck.letGo();
  while (!stuck.workers.areDone()) {
  }
  EXPECT_EQ(stuck.done[0], stuck.done[1]);
  const int before = stuck.done[0];
  EXPECT_TRUE(stuck.workers.run() || stuck.workers.areDone());
  EXPECT_EQ(stuck.done[0], before + 1);
}

TEST(WorkersThreadsTest, AStuckWorkerIsWaitedForOnceAndOnlyAsLongAsAllowed) {
  StuckWorker stuck;
  stuck.getStuck();
  const std::int64_t from_ns = rt::monotonicNs();
  constexpr int kLooks = 1000;
  for (int n = 0; n < kLooks; ++n) {
    EXPECT_FALSE(stuck.workers.areDone());
  }
  EXPECT_LT(rt::monotonicNs() - from_ns, kLooks * 1'000'000 / 2) << "of 1 ms each, if it waited";
  stuck.letGo();
}

TEST(WorkersThreadsTest, NoMoreThreadsAreUsefulThanThereAreItemsOrProcessors) {
  EXPECT_EQ(Workers::useful(8, 1), 1);
  EXPECT_EQ(Workers::useful(8, 0), 1);
  EXPECT_EQ(Workers::useful(1, 9), 1);
  EXPECT_LE(Workers::useful(8, 2), 2);
  const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  EXPECT_LE(Workers::useful(100, 100), processors);
}

TEST(WorkersThreadsTest, DenormalsAreFlushedInEveryThread) {
  std::atomic<bool> flushed_by_other{false};
  std::atomic<bool> kept_by_other{false};
  const std::thread::id self = std::this_thread::get_id();
  Workers workers(2, 2, kPatienceNs, [&](std::size_t) {
    volatile float small = std::numeric_limits<float>::min();
    small = small * 0.5F;
    if (std::this_thread::get_id() != self) {
      (small == 0.0F ? flushed_by_other : kept_by_other) = true;
    }
    dawdle(2000);
  });
  const std::int64_t deadline = rt::monotonicNs() + kPatienceNs;
  while (!flushed_by_other && !kept_by_other && rt::monotonicNs() < deadline) {
    ASSERT_TRUE(workers.run());
  }
  EXPECT_TRUE(flushed_by_other);
  EXPECT_FALSE(kept_by_other);
}

TEST(WorkersThreadsTest, ABlockIsRunInRealTime) {
  Workers workers(3, 5, kPatienceNs, [](std::size_t) { dawdle(100); });
  ergotic::test::expectRealtime([&] {
    for (int block = 0; block < 1000; ++block) {
      workers.run();
    }
  });
}

}  // namespace
}  // namespace ergotic::physics
