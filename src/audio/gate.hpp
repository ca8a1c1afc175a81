// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

namespace ergotic::audio {

/// Lets callbacks through while it is open. After `close` has returned no callback is inside, even
/// if the library still calls: it may do so during and after its own shutdown.
class Gate {
 public:
  void open() noexcept { open_ = true; }

  /// Waits for those inside to leave. Realtime: no
  void close() noexcept {
    open_ = false;
    while (inside_ != 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }

  /// \return whether the caller may go in; if so it must `leave`. Realtime: yes
  bool enter() noexcept {
    ++inside_;
    if (open_) {
      return true;
    }
    --inside_;
    return false;
  }
  void leave() noexcept { --inside_; }

 private:
  // Sequentially consistent: either `close` sees the visitor or the visitor sees it closed.
  std::atomic<bool> open_{false};
  std::atomic<int> inside_{0};
};

}  // namespace ergotic::audio
