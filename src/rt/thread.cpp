// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/thread.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <pthread.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include <sys/mman.h>
#include <sys/resource.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ergotic::rt {

namespace {

constexpr int kCapIpcLock = 14;  // CAP_IPC_LOCK of linux/capability.h
constexpr const char* kLimitsHelp =
    "add the line `@audio - rtprio 95` and the line `@audio - memlock unlimited` to "
    "/etc/security/limits.d/audio.conf (Debian's jackd2 offers to), add yourself to the group "
    "`audio`, and log in again";

// Initial-exec: it is there with the thread. What a library that is loaded later has else, would be
// allocated when a tick first looks at it.
[[gnu::tls_model("initial-exec")]] thread_local int own_priority = 0;

Outcome notLocked() {
  return {false, std::string("memory is not locked: mlockall: ") + std::strerror(errno)};
}

bool hasCapability(int capability) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("CapEff:", 0) == 0) {
      const std::uint64_t effective = std::stoull(line.substr(7), nullptr, 16);
      return ((effective >> static_cast<unsigned>(capability)) & 1U) != 0;
    }
  }
  return false;
}

/// Raises a soft limit as far as the hard one. \return the limit now
rlim_t raisedLimit(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) {
    return 0;
  }
  if (limit.rlim_cur != limit.rlim_max) {
    const rlimit wanted{limit.rlim_max, limit.rlim_max};
    if (setrlimit(resource, &wanted) == 0) {
      return wanted.rlim_cur;
    }
  }
  return limit.rlim_cur;
}

}  // namespace

Outcome lockMemory() {
  const rlim_t limit = raisedLimit(RLIMIT_MEMLOCK);
  if (limit != RLIM_INFINITY && !hasCapability(kCapIpcLock)) {
    std::ostringstream message;
    message << "memory is not locked: `ulimit -l` is " << limit / 1024
            << " kB, needed: unlimited. Page faults can make ticks late; " << kLimitsHelp;
    return {false, message.str()};
  }
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? Outcome{} : notLocked();
}

void trimHeap() {
  using Collect = void (*)(bool force);
  static const auto collect = reinterpret_cast<Collect>(::dlsym(RTLD_DEFAULT, "mi_collect"));
  if (collect != nullptr) {
    collect(true);
  } else {
    malloc_trim(0);
  }
}

Outcome makeRealtime(int priority) {
  raisedLimit(RLIMIT_RTPRIO);
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) {
    own_priority = priority;
    return {};
  }
  std::ostringstream message;
  message << "no real-time priority " << priority
          << " (SCHED_FIFO, 1...99): " << std::strerror(error);
  if (error == EPERM) {
    message << "; `ulimit -r` is " << raisedLimit(RLIMIT_RTPRIO)
            << ". Ticks can be late under load; " << kLimitsHelp;
  }
  return {false, message.str()};
}

void makeOrdinary() noexcept {
  const sched_param none{};
  if (pthread_setschedparam(pthread_self(), SCHED_OTHER, &none) == 0) {
    own_priority = 0;
  }
}

int realtimePriority() noexcept {
  return own_priority;
}

__attribute__((noinline)) void prefaultStack() noexcept {
  char stack[kPrefaultBytes];
  std::memset(stack, 0, sizeof stack);
  asm volatile("" : : "r"(stack) : "memory");  // the compiler may not drop the writes
}

#if defined(__x86_64__)

FlushDenormals::FlushDenormals() noexcept : saved_(_mm_getcsr()) {
  constexpr unsigned kFlushToZero = 0x8000;
  constexpr unsigned kDenormalsAreZero = 0x0040;
  _mm_setcsr(static_cast<unsigned>(saved_) | kFlushToZero | kDenormalsAreZero);
}

FlushDenormals::~FlushDenormals() {
  _mm_setcsr(static_cast<unsigned>(saved_));
}

#elif defined(__aarch64__)

FlushDenormals::FlushDenormals() noexcept : saved_(0) {
  constexpr unsigned long long kFlushToZero = 1ULL << 24U;
  asm volatile("mrs %0, fpcr" : "=r"(saved_));
  asm volatile("msr fpcr, %0" : : "r"(saved_ | kFlushToZero));
}

FlushDenormals::~FlushDenormals() {
  asm volatile("msr fpcr, %0" : : "r"(saved_));
}

#else
#error "FlushDenormals: say how this processor flushes denormals"
#endif

}  // namespace ergotic::rt
