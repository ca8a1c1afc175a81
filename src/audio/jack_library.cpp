// SPDX-License-Identifier: BSD-3-Clause
#include "audio/jack_library.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include <jack/jack.h>

#include "ergotic/rt/clock.hpp"

namespace ergotic::audio::jack_library {

namespace {

constexpr std::chrono::seconds kPatience{2};

/// libjack may report from its real-time thread: a message that finds another at work is dropped.
class LastMessage {
 public:
  void keep(const char* text) noexcept {
    if (!busy_.test_and_set(std::memory_order_acquire)) {
      std::strncpy(text_, text, sizeof text_ - 1);
      busy_.clear(std::memory_order_release);
    }
  }

  std::string take() {
    while (busy_.test_and_set(std::memory_order_acquire)) {
      std::this_thread::yield();
    }
    char copy[sizeof text_];
    std::memcpy(copy, text_, sizeof text_);
    text_[0] = '\0';
    busy_.clear(std::memory_order_release);
    return copy;
  }

 private:
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  char text_[256] = "";
};

LastMessage last_message;

void onError(const char* text) {
  last_message.keep(text);
}
void onInfo(const char*) {}

std::mutex calls_mutex;
int calls_out = 0;  // have not come back

}  // namespace

void silence() {
  jack_set_error_function(onError);
  jack_set_info_function(onInfo);
}

bool isOfPipeWire() {
  const char* version = jack_get_version_string();
  return version != nullptr && std::string(version).find("PipeWire") != std::string::npos;
}

std::string takeMessage() {
  return last_message.take();
}

bool callPatiently(std::function<void()> call) {
  auto back = std::make_shared<std::promise<void>>();
  std::future<void> came_back = back->get_future();
  {
    const std::lock_guard<std::mutex> lock(calls_mutex);
    ++calls_out;
  }
  std::thread([back, call = std::move(call)]() mutable {
    call();
    call = nullptr;  // what it owns goes before the caller goes on
    {
      const std::lock_guard<std::mutex> lock(calls_mutex);
      --calls_out;
    }
    back->set_value();
  }).detach();
  return came_back.wait_for(kPatience) == std::future_status::ready;
}

bool isStuck() {
  const std::lock_guard<std::mutex> lock(calls_mutex);
  return calls_out != 0;
}

std::int64_t clockOffsetNs() {
  constexpr std::int64_t kNsPerUs = 1000;
  std::int64_t offset = 0;
  std::int64_t narrowest = INT64_MAX;
  for (int i = 0; i < 16; ++i) {
    const std::int64_t before = rt::monotonicNs();
    const auto jack_ns = static_cast<std::int64_t>(jack_get_time()) * kNsPerUs;
    const std::int64_t after = rt::monotonicNs();
    if (after - before < narrowest) {
      narrowest = after - before;
      offset = jack_ns - (before + narrowest / 2);
    }
  }
  // jack_get_time truncates to a microsecond.
  return std::abs(offset) <= kNsPerUs + narrowest ? 0 : offset;
}

}  // namespace ergotic::audio::jack_library
