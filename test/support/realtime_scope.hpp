// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "support/alloc_count.hpp"

namespace ergotic::test {

/// Sees what the calling thread does while the object lives, and what a tick may not do: heap
/// calls, and system calls but for
///  - clock_nanosleep until a time: the timer waits for the next tick;
///  - clock_gettime: only where the processor's own clock cannot be read without the kernel;
///  - rt_sigreturn: the end of a signal's handler.
/// Each is told at once with the calls that led to it, on stderr or in the file that
/// `kRealtimeReport` names, and then takes its course. Under sanitizers it sees nothing.
///
/// A seccomp filter stays with a thread: one that had a scope must not begin threads or programs
/// afterwards (onTickThread).
class RealtimeScope {
 public:
  /// \throws std::runtime_error if the system takes no filter
  RealtimeScope();
  ~RealtimeScope();
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;

  std::int64_t heapCalls() const noexcept { return heap_ ? heap_->calls() : 0; }
  std::int64_t systemCalls() const noexcept;

  static bool isAvailable() noexcept { return AllocationScope::isAvailable(); }

 private:
  std::optional<AllocationScope> heap_;  // from when the filter stands
};

constexpr const char* kRealtimeReport = "ERGOTIC_REALTIME_REPORT";  ///< of the environment

/// Writes a line to the report.
void report(const char* line) noexcept;

/// Does it in a thread of its own.
template <class Body>
void onTickThread(Body&& body) {
  std::thread(std::forward<Body>(body)).join();
}

/// Does it in a thread of its own, in which a scope sees nothing; under sanitizers it just does it.
template <class Body>
void expectRealtime(Body&& body) {
  onTickThread([&body] {
    const RealtimeScope scope;
    body();
    const std::int64_t heap_calls = scope.heapCalls();
    const std::int64_t system_calls = scope.systemCalls();
    EXPECT_EQ(heap_calls, 0);
    EXPECT_EQ(system_calls, 0);
  });
}

}  // namespace ergotic::test
