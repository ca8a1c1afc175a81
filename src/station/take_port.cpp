// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/take_port.hpp"

#include <algorithm>

namespace ergotic::station {

TakePort::TakePort(std::size_t capacity_frames, int channels, double rate_hz)
    : capacity_(capacity_frames),
      channels_(static_cast<std::size_t>(channels)),
      step_(static_cast<float>(1.0 / (kFadeS * rate_hz))),
      samples_(capacity_ * channels_) {}

bool TakePort::push(const float* frames, int nframes) noexcept {
  const std::size_t written = written_.load(std::memory_order_relaxed);
  const auto count = static_cast<std::size_t>(nframes);
  if (written + count - read_.load(std::memory_order_acquire) > capacity_) {
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(frames + i * channels_, channels_,
                samples_.data() + (written + i) % capacity_ * channels_);
  }
  written_.store(written + count, std::memory_order_release);
  return true;
}

const float* TakePort::next(float& gain) noexcept {
  std::size_t read = read_.load(std::memory_order_relaxed);
  if (is_given_) {
    read_.store(++read, std::memory_order_release);
    is_given_ = false;
  }
  const bool is_open = open_.load(std::memory_order_acquire);
  const std::size_t written = written_.load(std::memory_order_acquire);
  if (!is_open && gain_ <= 0.0F) {
    read_.store(written, std::memory_order_release);
    return nullptr;
  }
  if (read == written) {
    gain_ = is_open ? gain_ : 0.0F;  // what has ended needs no fade
    return nullptr;
  }
  gain_ = std::clamp(gain_ + (is_open ? step_ : -step_), 0.0F, 1.0F);
  gain = gain_;
  is_given_ = true;
  return samples_.data() + read % capacity_ * channels_;
}

}  // namespace ergotic::station
