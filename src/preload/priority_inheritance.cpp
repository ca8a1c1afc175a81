// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into the process of a station: every mutex that is made by `pthread_mutex_init`, as
// those of boost are, inherits priority (PTHREAD_PRIO_INHERIT; Sha, Rajkumar and Lehoczky 1990).
//
// The threads that hear `stop` have a real-time priority, but roscpp guards its queues and
// connections by mutexes that its ordinary threads hold, too. On a busy machine such a thread waits
// for a processor for tens of milliseconds, and the stop with it; with inheritance it runs at the
// priority of who waits.
#include <dlfcn.h>
#include <pthread.h>

namespace {

using Init = int (*)(pthread_mutex_t*, const pthread_mutexattr_t*);

Init nextInit() noexcept {
  static const Init next = reinterpret_cast<Init>(::dlsym(RTLD_NEXT, "pthread_mutex_init"));
  return next;
}

/// Whether the protocol may be changed; mutexes that several processes share, and those with a
/// protocol of their own, stay as their owner made them.
bool mayInherit(const pthread_mutexattr_t& attributes) noexcept {
  int shared = PTHREAD_PROCESS_PRIVATE;
  int protocol = PTHREAD_PRIO_NONE;
  return ::pthread_mutexattr_getpshared(&attributes, &shared) == 0 &&
         ::pthread_mutexattr_getprotocol(&attributes, &protocol) == 0 &&
         shared == PTHREAD_PROCESS_PRIVATE && protocol == PTHREAD_PRIO_NONE;
}

}  // namespace

extern "C" int pthread_mutex_init(pthread_mutex_t* mutex,
                                  const pthread_mutexattr_t* attributes) noexcept {
  pthread_mutexattr_t inheriting;
  if (::pthread_mutexattr_init(&inheriting) != 0) {
    return nextInit()(mutex, attributes);
  }
  if (attributes != nullptr) {
    inheriting = *attributes;
  }
  if (mayInherit(inheriting) &&
      ::pthread_mutexattr_setprotocol(&inheriting, PTHREAD_PRIO_INHERIT) == 0 &&
      nextInit()(mutex, &inheriting) == 0) {
    return 0;
  }
  return nextInit()(mutex, attributes);  // also where this kernel refuses inheritance
}
