// SPDX-License-Identifier: BSD-3-Clause
// What watches real-time threads in other tests.
#include "support/realtime_scope.hpp"

#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <mutex>

#include <sys/syscall.h>

#include "ergotic/rt/clock.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

class RealtimeScopeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!RealtimeScope::isAvailable()) {
      GTEST_SKIP() << "under a sanitizer nothing is seen";
    }
  }
};

/// What is said of it, and how many system calls it made.
template <class Body>
std::pair<std::string, std::int64_t> seenOf(Body&& body) {
  std::int64_t calls = -1;
  ::testing::internal::CaptureStderr();
  onTickThread([&] {
    const RealtimeScope scope;
    body();
    calls = scope.systemCalls();
  });
  return {::testing::internal::GetCapturedStderr(), calls};
}

TEST_F(RealtimeScopeTest, TrapsWhatATickMayNotCall) {
  const std::vector<std::pair<std::string, std::function<void()>>> forbidden = {
      {"sched_yield", [] { sched_yield(); }},
      {"getpid", [] { syscall(SYS_getpid); }},
      {"read", [] { EXPECT_EQ(read(-1, nullptr, 0), -1); }},
      {"write", [] { EXPECT_EQ(write(STDERR_FILENO, "", 0), 0); }},
      {"futex", [] { syscall(SYS_futex, nullptr, -1, 0, nullptr, nullptr, 0); }},
      {"clock_nanosleep",  // for a while, not until a time
       [] {
         const timespec nothing{};
         clock_nanosleep(CLOCK_MONOTONIC, 0, &nothing, nullptr);
       }},
  };
  for (const auto& [name, body] : forbidden) {
    const auto [told, calls] = seenOf(body);
    EXPECT_EQ(calls, 1) << name;
    EXPECT_THAT(told, HasSubstr("system call " + name + "\n"));
    EXPECT_THAT(told, HasSubstr("ergotic_rt_live_test")) << "who called it";
  }
}

TEST_F(RealtimeScopeTest, TrapsALockThatAnotherThreadHas) {
  std::mutex mutex;
  std::atomic<bool> is_locked{false};
  std::thread owner([&] {
    const std::lock_guard lock(mutex);
    is_locked = true;
    rt::sleepUntilNs(rt::monotonicNs() + 50'000'000);
  });
  while (!is_locked) {
  }
  const auto [told, calls] = seenOf([&] { const std::lock_guard lock(mutex); });
  EXPECT_GT(calls, 0);
  EXPECT_THAT(told, HasSubstr("system call futex\n"));
  owner.join();
}

TEST_F(RealtimeScopeTest, LetsPassWhatATickMayCall) {
  const auto [told, calls] = seenOf([] {
    for (int n = 0; n < 100; ++n) {
      rt::sleepUntilNs(rt::monotonicNs() + 1000);
    }
  });
  EXPECT_EQ(calls, 0) << told;
  EXPECT_EQ(told, "");
}

TEST_F(RealtimeScopeTest, TellsOfHeapCalls) {
  const std::string told = seenOf([] {
                             void* volatile block = std::malloc(100);  // or it is left out
                             std::free(block);
                           }).first;
  EXPECT_THAT(told, HasSubstr("heap call malloc\n"));
  EXPECT_THAT(told, HasSubstr("heap call free\n"));
}

TEST_F(RealtimeScopeTest, SeesOnlyItsThreadAndOnlyWhileItLives) {
  onTickThread([] {
    std::atomic<int> phase{0};
    std::thread other([&] {
      while (phase == 0) {
      }
      std::free(std::malloc(100));
      sched_yield();
      phase = 2;
    });
    {
      const RealtimeScope scope;
      phase = 1;
      while (phase == 1) {
      }
      EXPECT_EQ(scope.systemCalls(), 0);
      EXPECT_EQ(scope.heapCalls(), 0);
    }
    EXPECT_EQ(sched_yield(), 0) << "takes its course";
    EXPECT_EQ(syscall(SYS_getpid), getpid());
    EXPECT_EQ(close(-1), -1);
    EXPECT_EQ(errno, EBADF) << "with its answer";
    other.join();
    const RealtimeScope again;
    EXPECT_EQ(again.systemCalls(), 0);
  });
}

TEST(AllocationScopeTest, CountsTheHeapCallsOfItsThreadOnly) {
  if (!AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the sanitizer has its own heap";
  }
  const AllocationScope scope;
  EXPECT_EQ(scope.calls(), 0);
  auto block = std::make_unique<std::vector<double>>(1000);
  EXPECT_EQ(scope.calls(), 2);
  block.reset();
  EXPECT_EQ(scope.calls(), 4);
  void* volatile aligned = std::aligned_alloc(64, 128);  // or the compiler leaves the pair out
  EXPECT_EQ(scope.calls(), 5);
  std::free(aligned);
}

}  // namespace
}  // namespace ergotic::test
