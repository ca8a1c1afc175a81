// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::station {

/// Gain of audio and force around a swap: straight lines, one full-scale ramp taking exactly
/// `ticks` ticks, so that a replay knows every sample of it from the tick of the swap alone.
///
/// full --startOut--> out --ticks--> silent --startIn--> in --ticks--> full
///
/// Realtime: yes, all of it. Thread: tick
class SwapFade {
 public:
  /// \param ticks  length of one ramp, >= 1
  /// \param ratio  audio frames per tick
  SwapFade(int ticks, int ratio) noexcept : ticks_(ticks), ratio_(ratio) {}

  bool isFull() const noexcept { return phase_ == Phase::kFull; }
  bool isSilent() const noexcept { return phase_ == Phase::kSilent; }
  bool isFadingOut() const noexcept { return phase_ == Phase::kOut; }
  int ticks() const noexcept { return ticks_; }

  void startOut() noexcept { enter(Phase::kOut); }
  void startIn() noexcept { enter(Phase::kIn); }

  /// Gain of frame `frame` (0...ratio-1) of the current tick; the last frame of a ramp is exactly
  /// 0 or 1.
  double gainAt(int frame) const noexcept {
    const double passed =
        static_cast<double>(tick_ * ratio_ + frame + 1) / static_cast<double>(ticks_ * ratio_);
    switch (phase_) {
      case Phase::kFull:
        return 1.0;
      case Phase::kOut:
        return 1.0 - passed;
      case Phase::kSilent:
        return 0.0;
      case Phase::kIn:
        return passed;
    }
    return 0.0;
  }

  /// The current tick is over.
  void advance() noexcept {
    if (phase_ == Phase::kFull || phase_ == Phase::kSilent || ++tick_ < ticks_) {
      return;
    }
    enter(phase_ == Phase::kOut ? Phase::kSilent : Phase::kFull);
  }

 private:
  enum class Phase { kFull, kOut, kSilent, kIn };
  void enter(Phase phase) noexcept {
    phase_ = phase;
    tick_ = 0;
  }

  int ticks_;
  int ratio_;
  int tick_ = 0;
  Phase phase_ = Phase::kFull;
};

}  // namespace ergotic::station
