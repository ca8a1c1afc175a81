// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "ergotic/rt/ring.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "tgr/drivers/virtual/slice_bank.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"

namespace ergotic::tgr {

/// A virtual device that lives in the driver and moves on by one tick per exchange.
///
/// As on a real device, the forces of an exchange act from there to the next one, so the positions
/// that this exchange reads do not contain them yet. Same settings, file and forces: same bits.
class InProcessDriver final : public Driver {
 public:
  /// \throws as makeVirtualDriver
  explicit InProcessDriver(const VirtualDriverConfig& config);

  void open(double tick_rate_hz) override;
  void close() noexcept override { open_ = false; }
  int slices() const noexcept override { return bank_.slices(); }
  std::uint32_t exchange(const double* forces, double* positions) noexcept override;
  void makeSafe() noexcept override { safe_ = true; }
  void rearm() noexcept override { safe_ = false; }
  int extraDelayTicks() const noexcept override { return queue_ticks_ + actuator_ticks_; }
  bool isRaw() const noexcept override { return bank_.isRaw(); }
  bool canHurt() const noexcept override { return false; }
  bool isSteppedByExchange() const noexcept override { return true; }
  double damping() const noexcept override { return bank_.damping(); }
  double declaredDamping() const noexcept override { return damping(); }
  std::vector<GestureValue> gestureValues() const override { return values_; }
  double gestureTime() const noexcept override { return gesture_s_; }
  bool hasHand(int slice) const noexcept override { return slice >= 0 && slice < slices(); }
  bool move(const HandMove& move) noexcept override;

 private:
  static constexpr std::size_t kPendingMoves = 256;
  using Forces = std::array<double, kMaxSlices>;

  void takeMoves() noexcept;

  SliceBank bank_;
  std::vector<GestureValue> values_;
  std::atomic<double> gesture_s_{0.0};
  int queue_ticks_;
  int actuator_ticks_ = 0;                               // of its delay, rounded up
  std::array<Forces, kMaxExtraDelayTicks + 1> queue_{};  // forces under way, oldest at head_
  std::size_t head_ = 0;
  Forces last_positions_{};
  rt::Ring<HandMove> moves_{kPendingMoves};
  std::atomic<bool> open_{false};
  std::atomic<bool> safe_{false};
};

}  // namespace ergotic::tgr
