// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/thread.hpp"

#include <pthread.h>
#include <unistd.h>

#include <cfloat>
#include <cstring>
#include <fstream>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>

#include "support/alloc_count.hpp"
#include "support/test.hpp"

namespace ergotic::rt {
namespace {

/// Products through memory: the compiler may neither fold nor move them.
double half(double value) {
  volatile double factor = 0.5;
  volatile double in = value;
  volatile double out = in * factor;
  return out;
}

TEST(FlushDenormalsTest, DenormalResultsAreZeroWhileItLives) {
  EXPECT_GT(half(DBL_MIN), 0.0);
  {
    const FlushDenormals flush;
    EXPECT_EQ(half(DBL_MIN), 0.0);
    EXPECT_EQ(half(4.0 * DBL_MIN), 2.0 * DBL_MIN);
  }
  EXPECT_GT(half(DBL_MIN), 0.0);
}

TEST(FlushDenormalsTest, DenormalInputsAreZeroWhileItLives) {
  volatile double denormal = DBL_MIN / 1024.0;
  volatile double large = 1e300;
  volatile double product = denormal * large;
  EXPECT_GT(product, 0.0);
  const FlushDenormals flush;
  product = denormal * large;
  EXPECT_EQ(product, 0.0);
}

TEST(FlushDenormalsTest, DoesNotReachAThreadThatRunsAlready) {
  std::promise<void> flushed;
  double elsewhere = 0.0;
  std::thread other([&] {
    flushed.get_future().wait();
    elsewhere = half(DBL_MIN);
  });
  const FlushDenormals flush;
  flushed.set_value();
  other.join();
  const double zero = 0.0;
  // By its bits: in this thread a denormal compares as zero.
  EXPECT_NE(std::memcmp(&elsewhere, &zero, sizeof zero), 0);
}

/// Runs a check as an unprivileged child without real-time limits; what it returns, or -1.
template <class Check>
int asUnprivileged(const Check& check) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    const bool bare = setrlimit(RLIMIT_RTPRIO, &none) == 0 &&
                      setrlimit(RLIMIT_MEMLOCK, &none) == 0 &&
                      (geteuid() != 0 || setuid(65534) == 0);
    _exit(bare ? check() : 99);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool explains(const Outcome& outcome, const char* limit) {
  return !outcome.ok && outcome.message.find(limit) != std::string::npos &&
         outcome.message.find("limits.d") != std::string::npos;
}

TEST(MakeRealtimeTest, SaysWhatToDoWhereItIsNotPermitted) {
  EXPECT_EQ(asUnprivileged([] { return explains(makeRealtime(50), "ulimit -r") ? 7 : 8; }), 7);
}

TEST(MakeRealtimeTest, NamesTheRangeOfAWrongPriority) {
  std::thread([] {
    const Outcome outcome = makeRealtime(1000);
    EXPECT_FALSE(outcome.ok);
    EXPECT_THAT(outcome.message, HasSubstr("1...99"));
  }).join();
}

TEST(MakeRealtimeTest, EitherGivesThePriorityOrAReason) {
  std::thread([] {
    const Outcome outcome = makeRealtime(20);
    int policy = 0;
    sched_param parameters{};
    ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
    EXPECT_EQ(outcome.ok, policy == SCHED_FIFO);
    EXPECT_EQ(outcome.ok, parameters.sched_priority == 20);
    EXPECT_EQ(outcome.ok, outcome.message.empty()) << outcome.message;
  }).join();
}

TEST(LockMemoryTest, SaysWhatToDoWhereItIsNotPermitted) {
  EXPECT_EQ(asUnprivileged([] { return explains(lockMemory(), "ulimit -l") ? 7 : 8; }), 7);
}

long residentKb() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("VmRSS:", 0) == 0) {
      return std::stol(line.substr(6));
    }
  }
  return 0;
}

/// In a thread, whose heap is another than that of `main`; what is kept lies behind what is freed.
long freedButResidentKb() {
  long resident_kb = 0;
  std::thread([&] {
    std::vector<std::string> texts;
    for (int i = 0; i < 200'000; ++i) {
      texts.emplace_back(1000, 'x');
    }
    static const std::string kept = texts.back();
    resident_kb = residentKb();
  }).join();
  return resident_kb;
}

// This program counts calls of the heap of the C library, so mimalloc cannot take its place here.
TEST(TrimHeapTest, GivesBackWhatIsFree) {
  if (!test::AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the sanitizer has its own heap";
  }
  const long used_kb = freedButResidentKb();
  const long freed_kb = residentKb();
  trimHeap();
  EXPECT_GT(freed_kb, used_kb - 20'000) << "it is given back by itself: the test shows nothing";
  EXPECT_LT(residentKb(), used_kb - 150'000);
}

TEST(PrefaultStackTest, MakesItsBytesOfStackResident) {
  // In a thread of its own, whose stack is untouched so far.
  std::thread([] {
    rusage before{};
    rusage after{};
    getrusage(RUSAGE_THREAD, &before);
    prefaultStack();
    getrusage(RUSAGE_THREAD, &after);
    EXPECT_GT(after.ru_minflt - before.ru_minflt, 0);
    before = after;
    prefaultStack();
    getrusage(RUSAGE_THREAD, &after);
    EXPECT_EQ(after.ru_minflt - before.ru_minflt, 0);
  }).join();
}

}  // namespace
}  // namespace ergotic::rt
