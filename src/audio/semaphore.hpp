// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <semaphore.h>
#include <time.h>

#include <cstdint>

#include "ergotic/rt/clock.hpp"

namespace ergotic::audio {

/// Wakes a waiting thread from anywhere, a callback of JACK or a signal handler included.
class Semaphore {
 public:
  Semaphore() noexcept { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  /// Posts without blocking. Thread: any
  void post() noexcept { sem_post(&semaphore_); }

  /// Takes back all posts so far.
  void forget() noexcept {
    while (sem_trywait(&semaphore_) == 0) {
    }
  }

  /// Waits for a post, at most this long; an interruption by a signal ends it as well.
  void waitFor(std::int64_t timeout_ns) noexcept {
    const std::int64_t end_ns = rt::monotonicNs() + timeout_ns;
    timespec end{};
    end.tv_sec = static_cast<time_t>(end_ns / 1'000'000'000);
    end.tv_nsec = static_cast<long>(end_ns % 1'000'000'000);
    sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &end);
  }

 private:
  sem_t semaphore_{};
};

}  // namespace ergotic::audio
