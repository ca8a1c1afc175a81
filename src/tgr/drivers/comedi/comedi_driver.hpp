// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>

#include "ergotic/tgr/driver.hpp"
#include "tgr/drivers/comedi/comedi_board.hpp"
#include "tgr/drivers/comedi/comedi_settings.hpp"

namespace ergotic::tgr {

/// A measurement board under Linux' comedi: an analog input and an analog output per slice, volts.
/// Its behaviour and its guarantees are in docs/tgr.md.
///
/// Safe: `makeSafe` latches, then writes the safe volts itself, in the calling thread. A list of
/// the tick that the kernel runs after that one was made before the latch; the tick looks at the
/// latch again when its list has run, and writes the safe volts as well. So no more than one list
/// can come late, and it is undone by the same `exchange`. The tick itself only latches: its next
/// list has the safe volts, and where that fails it writes nothing but them.
///
/// Lost: `board_` belongs to the tick as long as `online_`, else to the thread that opens and
/// closes.
class ComediDriver final : public Driver {
 public:
  explicit ComediDriver(ComediSettings settings) : settings_(std::move(settings)) {}
  ~ComediDriver() override { close(); }

  void open(double tick_rate_hz) override;
  void close() noexcept override;
  void reconnect() override;
  int slices() const noexcept override { return settings_.slices(); }
  std::uint32_t exchange(const double* outputs, double* inputs) noexcept override;
  /// Realtime: no; it waits for no more than one other caller's write.
  void makeSafe() noexcept override;
  void makeSafeInTick() noexcept override { safe_ = true; }
  void rearm() noexcept override { safe_ = false; }
  std::vector<Guard> guards() const override { return {board_->guard()}; }
  bool isRaw() const noexcept override { return true; }
  double damping() const noexcept override { return settings_.damping.value_or(kSupposedDamping); }
  double declaredDamping() const noexcept override { return settings_.damping.value_or(0.0); }

 private:
  void takeBoard();
  void dropBoard() noexcept;

  ComediSettings settings_;
  std::mutex board_mutex_;  // of the pointer, between makeSafe and those that set it
  std::unique_ptr<ComediBoard> board_;
  bool open_ = false;  // as its owner wants it, even if it is lost
  std::atomic<bool> online_{false};
  std::atomic<bool> safe_{false};
  std::array<double, kMaxSlices> inputs_{};  // V, newest; the tick's
};

}  // namespace ergotic::tgr
