// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::rt {

/// Answer of a set-up step that may be refused without being fatal.
struct Outcome {
  bool ok = true;
  std::string message;  ///< why not, and what to do about it; empty if ok
};

/// Locks present and future pages of the process into memory (mlockall). Refuses while the process
/// has a memory-lock limit, since later allocations would fail at that limit.
/// Realtime: no. Thread: any
Outcome lockMemory();

/// Gives back to the system what the heap holds free, by the allocator that this process has: that
/// of the C library, or mimalloc where it is preloaded. The former takes milliseconds for which all
/// threads that allocate or free wait, and cannot give back pages that are locked.
/// Realtime: no. Thread: the one that freed most of it
void trimHeap();

/// Gives the calling thread SCHED_FIFO at `priority` (1...99).
/// Realtime: no
Outcome makeRealtime(int priority);

/// Takes it back: the thread is an ordinary one again. Realtime: no
void makeOrdinary() noexcept;

/// Priority that `makeRealtime` gave the calling thread; 0: none. Realtime: yes
int realtimePriority() noexcept;

/// Number of stack bytes that `prefaultStack` makes resident.
constexpr int kPrefaultBytes = 1 << 18;

/// Touches the next `kPrefaultBytes` of the calling thread's stack so that they are resident.
/// Realtime: no
void prefaultStack() noexcept;

/// Denormals become zero in the calling thread while the object lives (FTZ and DAZ on x86,
/// FZ on ARM): a fading string would cost 25 times more without.
/// Realtime: yes
class FlushDenormals {
 public:
  FlushDenormals() noexcept;
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned long long saved_;
};

}  // namespace ergotic::rt
