// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::tgr {

/// Whether force goes out, and how much of it: a straight line from 0 to 1 after opening, and a
/// shorter one after a stall or a swap. Realtime: yes. One for all slices.
class Gate {
 public:
  Gate(double ramp_s, double resume_ramp_s, double tick_s) noexcept
      : step_(tick_s / ramp_s), resume_step_(tick_s / resume_ramp_s) {}

  /// Ramps the gain in from 0; no effect while the gate is open.
  void open() noexcept;
  void close() noexcept;
  /// Sets the gain to 0 and ramps it in by the shorter line; neither opens the gate nor shortens
  /// the longer line.
  void resume() noexcept { resume_gain_ = 0.0; }

  bool isOpen() const noexcept { return open_; }
  double ramp() const noexcept { return ramp_; }  ///< 0...1, position on the longer line

  /// Gain of this tick, 0...1; moves on to the next. \pre isOpen()
  double next() noexcept;

 private:
  double step_;
  double resume_step_;
  bool open_ = false;
  double ramp_ = 0.0;
  double resume_gain_ = 1.0;
};

}  // namespace ergotic::tgr
