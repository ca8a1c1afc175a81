// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::rt {

/// CLOCK_MONOTONIC, ns. Realtime: yes (vDSO).
std::int64_t monotonicNs() noexcept;

/// CPU time of the calling thread, ns.
std::int64_t threadCpuNs() noexcept;

/// Sleeps until an absolute CLOCK_MONOTONIC time; the only system call of a waiting tick.
void sleepUntilNs(std::int64_t deadline_ns) noexcept;

/// One reading of an audio clock: frame `frames` began at `time_ns`.
struct FrameTime {
  std::int64_t frames = 0;
  std::int64_t time_ns = 0;
};

/// Second-order delay-locked loop from audio frame times to CLOCK_MONOTONIC.
///
/// Source: F. Adriaensen, "Using a DLL to filter time", Linux Audio Conference 2005.
class FrameClock {
 public:
  /// \param frame_rate  nominal, Hz
  /// \param bandwidth   of the loop, Hz
  FrameClock(double frame_rate, double bandwidth) noexcept;

  /// Forgets the past; the next update sets the phase at once.
  void reset() noexcept;

  /// Takes a reading. One of a frame that is not after the last is ignored; a phase error of more
  /// than `kRelockNs` (lost cycles, another server) re-locks at once, keeps the measured rate and
  /// counts in `relocks()`. Realtime: yes
  void update(const FrameTime& reading) noexcept;

  bool isLocked() const noexcept { return locked_; }
  std::int64_t relocks() const noexcept { return relocks_; }
  double frameRateHz() const noexcept;  ///< measured frame rate

  /// Filtered time at which a frame begins, extrapolated. \pre isLocked(). Realtime: yes
  std::int64_t timeOf(std::int64_t frame) const noexcept;
  /// Frame (with its fraction) at a time, extrapolated. \pre isLocked(). Realtime: yes
  double frameAt(std::int64_t time_ns) const noexcept;

  static constexpr std::int64_t kRelockNs = 20'000'000;

 private:
  void lock(const FrameTime& reading) noexcept;

  double nominal_ns_per_frame_;
  double bandwidth_;
  double ns_per_frame_;
  std::int64_t frame_ = 0;    // of the last update
  std::int64_t time_ns_ = 0;  // filtered time of frame_, whole part
  double fraction_ns_ = 0.0;  // and the rest, 0...1
  std::int64_t relocks_ = 0;
  bool locked_ = false;
};

}  // namespace ergotic::rt
