// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program that plays, it watches all its real-time threads, as they are deployed:
// what each of them does from when it has asked for a real-time priority, and as long as it flushes
// denormals, which all of them do, and nothing else, between the first tick and the last.
#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

#include "ergotic/rt/thread.hpp"
#include "support/realtime_scope.hpp"

namespace ergotic {
namespace {

using test::RealtimeScope;

thread_local bool is_realtime = false;
thread_local bool is_told = false;
thread_local int flushes = 0;  // one inside the other
thread_local RealtimeScope* scope = nullptr;

void watchIfDue() {
  if (is_realtime && flushes > 0 && scope == nullptr) {
    if (!std::exchange(is_told, true)) {
      test::report("watched: a thread");
    }
    scope = new RealtimeScope;
  }
}

/// With this in the environment every thread commits in its second scope what it may not.
void offendIfAsked() {
  static const bool is_asked = std::getenv("ERGOTIC_REALTIME_OFFEND") != nullptr;
  if (is_asked && scope != nullptr && scope->systemCalls() == 0) {
    sched_yield();
    void* volatile block = std::malloc(1);  // or the compiler leaves the pair out
    std::free(block);
  }
}

/// What this library stands before.
struct Real {
  using Function = void (*)(void*);
  static Function named(const char* name) {
    void* const core = dlopen("libergotic_core.so", RTLD_LAZY | RTLD_NOLOAD);
    return reinterpret_cast<Function>(dlsym(core, name));
  }
  const Function construct = named("_ZN7ergotic2rt14FlushDenormalsC1Ev");
  const Function destroy = named("_ZN7ergotic2rt14FlushDenormalsD1Ev");
};
const Real& real() {
  static const Real real;
  return real;
}

}  // namespace

namespace rt {

FlushDenormals::FlushDenormals() noexcept : saved_(0) {
  real().construct(this);
  ++flushes;
  watchIfDue();
  offendIfAsked();
}

FlushDenormals::~FlushDenormals() {
  if (--flushes == 0) {
    delete std::exchange(scope, nullptr);
  }
  real().destroy(this);
}

}  // namespace rt
}  // namespace ergotic

/// A thread plays as one of real time where it may not be one, too.
extern "C" int pthread_setschedparam(pthread_t thread, int policy, const sched_param* wanted) {
  using Real = int (*)(pthread_t, int, const sched_param*);
  static const Real real = reinterpret_cast<Real>(dlsym(RTLD_NEXT, "pthread_setschedparam"));
  const int error = real(thread, policy, wanted);
  if (policy == SCHED_FIFO && pthread_equal(thread, pthread_self()) != 0) {
    ergotic::is_realtime = true;
    ergotic::watchIfDue();
    return 0;
  }
  return error;
}
