// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <thread>

#include "ergotic/rt/audio_processor.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// Value of frame `frame` on output `channel`: exact in a float, no two near frames alike.
inline float counterRamp(std::int64_t frame, int channel) {
  constexpr std::int64_t kModulus = 1 << 20;
  return static_cast<float>(frame % kModulus + channel * kModulus) / 16777216.0F;
}

/// Waits until something holds, generously: a machine may be busy. \return whether it came to hold
inline bool eventually(const std::function<bool()>& holds) {
  const std::int64_t end_ns = rt::monotonicNs() + 30'000'000'000;
  while (!holds()) {
    if (rt::monotonicNs() > end_ns) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// Sends counter ramps and remembers what an audio host does to it.
class PeriodProbe : public rt::AudioProcessor {
 public:
  /// What a host did; between two starts every period is checked.
  struct Counts {
    std::atomic<int> starts{0};
    std::atomic<int> stops{0};
    std::atomic<std::int64_t> periods{0};
    std::atomic<std::int64_t> jumps{0};  ///< periods not beginning where the last ended
    std::atomic<std::int64_t> xruns{0};
    std::atomic<std::int64_t> stray{0};       ///< periods outside of start and stop
    std::atomic<std::int64_t> wrong_size{0};  ///< periods not of the announced period
    std::atomic<std::int64_t> bad_times{0};   ///< not within a second of CLOCK_MONOTONIC
    std::atomic<std::int64_t> denormals{0};   ///< periods in which denormals survive
  };

  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override {
    if (refuse) {
      throw Exception("the probe wants no audio");
    }
    sample_rate = sample_rate_hz;
    period = period_frames;
    has_last_ = false;
    running_ = true;
    ++counts.starts;
  }

  void audioStopped() noexcept override {
    running_ = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // time for stray periods to come
    ++counts.stops;
  }

  void process(const rt::Period& now) noexcept override {
    counts.stray += running_ ? 0 : 1;
    counts.wrong_size += now.nframes == period ? 0 : 1;
    counts.jumps += has_last_ && now.start.frames != next_ ? 1 : 0;
    const std::int64_t late_ns = rt::monotonicNs() - now.start.time_ns;
    counts.bad_times += std::abs(late_ns) < 1'000'000'000 ? 0 : 1;
    volatile double tiny = 1e-308;
    volatile double product = tiny * 0.001;
    counts.denormals += product != 0.0 ? 1 : 0;
    has_last_ = true;
    next_ = now.start.frames + now.nframes;
    for (int channel = 0; channel < now.output_channels; ++channel) {
      for (std::uint32_t i = 0; i < now.nframes; ++i) {
        now.outputs[channel][i] = counterRamp(now.start.frames + i, channel);
      }
    }
    ++counts.periods;
  }

  void xrun() noexcept override { ++counts.xruns; }

  Counts counts;
  std::atomic<bool> refuse{false};
  std::atomic<double> sample_rate{0.0};
  std::atomic<std::uint32_t> period{0};

 private:
  std::atomic<bool> running_{false};
  bool has_last_ = false;
  std::int64_t next_ = 0;
};

}  // namespace ergotic::test
