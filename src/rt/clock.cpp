// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/clock.hpp"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace ergotic::rt {

namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr double kMaxOmega = 0.5;  // rad per update: keeps the loop stable over long gaps

std::int64_t nsOf(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kNsPerSecond + now.tv_nsec;
}

}  // namespace

std::int64_t monotonicNs() noexcept {
  return nsOf(CLOCK_MONOTONIC);
}

std::int64_t threadCpuNs() noexcept {
  return nsOf(CLOCK_THREAD_CPUTIME_ID);
}

void sleepUntilNs(std::int64_t deadline_ns) noexcept {
  timespec deadline{};
  deadline.tv_sec = static_cast<time_t>(deadline_ns / kNsPerSecond);
  deadline.tv_nsec = static_cast<long>(deadline_ns % kNsPerSecond);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

FrameClock::FrameClock(double frame_rate, double bandwidth) noexcept
    : nominal_ns_per_frame_(1e9 / frame_rate),
      bandwidth_(bandwidth),
      ns_per_frame_(nominal_ns_per_frame_) {}

void FrameClock::reset() noexcept {
  ns_per_frame_ = nominal_ns_per_frame_;
  locked_ = false;
}

void FrameClock::lock(const FrameTime& reading) noexcept {
  frame_ = reading.frames;
  time_ns_ = reading.time_ns;
  fraction_ns_ = 0.0;
  locked_ = true;
}

void FrameClock::update(const FrameTime& reading) noexcept {
  if (!locked_) {
    lock(reading);
    return;
  }
  // Differences are taken between integers: a double would lose nanoseconds after 100 days.
  const auto frames = static_cast<double>(reading.frames - frame_);
  const double predicted_ns = fraction_ns_ + frames * ns_per_frame_;
  const double error_ns = static_cast<double>(reading.time_ns - time_ns_) - predicted_ns;
  if (std::abs(error_ns) > static_cast<double>(kRelockNs)) {
    lock(reading);
    ++relocks_;
    return;
  }
  if (frames <= 0.0) {
    return;
  }
  const double seconds = frames * nominal_ns_per_frame_ * 1e-9;
  const double omega = std::min(2.0 * M_PI * bandwidth_ * seconds, kMaxOmega);
  ns_per_frame_ += omega * omega * error_ns / frames;
  const double filtered_ns = predicted_ns + M_SQRT2 * omega * error_ns;
  const double whole_ns = std::floor(filtered_ns);
  frame_ = reading.frames;
  time_ns_ += static_cast<std::int64_t>(whole_ns);
  fraction_ns_ = filtered_ns - whole_ns;
}

double FrameClock::frameRateHz() const noexcept {
  return 1e9 / ns_per_frame_;
}

std::int64_t FrameClock::timeOf(std::int64_t frame) const noexcept {
  const double ahead_ns = static_cast<double>(frame - frame_) * ns_per_frame_ + fraction_ns_;
  return time_ns_ + std::llround(ahead_ns);
}

double FrameClock::frameAt(std::int64_t time_ns) const noexcept {
  const double ahead_ns = static_cast<double>(time_ns - time_ns_) - fraction_ns_;
  return static_cast<double>(frame_) + ahead_ns / ns_per_frame_;
}

}  // namespace ergotic::rt
