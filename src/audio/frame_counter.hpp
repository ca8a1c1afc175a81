// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::audio {

/// Continues JACK's 32-bit frame time, which wraps after a day, in 64 bits.
class FrameCounter {
 public:
  /// Realtime: yes
  std::int64_t extend(std::uint32_t frame) noexcept {
    if (started_) {
      // Modulo 2^32 the step is right forwards and backwards.
      total_ += static_cast<std::int32_t>(frame - last_);
    } else {
      total_ = frame;
      started_ = true;
    }
    last_ = frame;
    return total_;
  }

 private:
  std::int64_t total_ = 0;
  std::uint32_t last_ = 0;
  bool started_ = false;
};

}  // namespace ergotic::audio
