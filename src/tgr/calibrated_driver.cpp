// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/calibration.hpp"
#include "tgr/calibration_rules.hpp"
#include "tgr/require.hpp"
#include "tgr/slice_push.hpp"

namespace ergotic::tgr {
namespace {

using Slices = std::array<double, kMaxSlices>;
/// Calibrations as the tick uses them.
struct Table {
  std::array<SliceCalibration, kMaxSlices> slices;
  std::array<std::uint32_t, kMaxSlices> renewals{};  // of slices that had a calibration
  std::uint64_t uncalibrated = 0;                    // bits
};

ERGOTIC_REALTIME double positionOf(double volts, const SliceCalibration& c) noexcept {
  if (!c.is_calibrated) {
    return 0.0;
  }
  const bool is_inside = volts > c.low_volts && volts < c.high_volts;  // false if not a number
  return is_inside ? c.metres_per_volt * (volts - c.rest_volts)
                   : std::numeric_limits<double>::quiet_NaN();
}

ERGOTIC_REALTIME double voltsOf(double force, const SliceCalibration& c) noexcept {
  if (!c.is_calibrated || std::isnan(force)) {
    return c.zero_volts;
  }
  const double able = std::clamp(force, -kAbsoluteForceLimitN, kAbsoluteForceLimitN);
  return std::clamp(c.zero_volts + c.volts_per_newton * able, -c.max_volts, c.max_volts);
}

class CalibratedDriverOverRaw final : public CalibratedDriver {
 public:
  CalibratedDriverOverRaw(std::unique_ptr<Driver> raw, Calibration calibration)
      : raw_(std::move(raw)), calibration_(std::move(calibration)) {
    if (!raw_->isRaw()) {
      throw Exception("a calibration of a device that speaks metres and newtons already");
    }
    const auto count = static_cast<std::size_t>(slices());
    if (calibration_.slices.size() > count) {
      throw Exception("calibrations of " + std::to_string(calibration_.slices.size()) +
                      " slices, allowed: at most " + std::to_string(count) +
                      ", as many as the device has");
    }
    calibration_.slices.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      checkCalibration(calibration_.slices[i], " of slice " + std::to_string(i));
    }
    publish();
    table_.refresh();
    uncalibrated_ = table_.latest().uncalibrated;
  }

  void open(double tick_rate_hz) override {
    raw_->open(tick_rate_hz);
    push_.open(1.0 / tick_rate_hz, 1 + raw_->extraDelayTicks());
  }
  void close() noexcept override { raw_->close(); }
  void reconnect() override { raw_->reconnect(); }
  int slices() const noexcept override { return raw_->slices(); }
  bool isSteppedByExchange() const noexcept override { return raw_->isSteppedByExchange(); }
  void makeSafe() noexcept override { raw_->makeSafe(); }
  void makeSafeInTick() noexcept override { raw_->makeSafeInTick(); }
  void rearm() noexcept override { raw_->rearm(); }
  int extraDelayTicks() const noexcept override { return raw_->extraDelayTicks(); }
  std::uint64_t uncalibrated() const noexcept override { return uncalibrated_; }
  bool canHurt() const noexcept override { return raw_->canHurt(); }
  double damping() const noexcept override { return raw_->damping(); }
  double declaredDamping() const noexcept override { return raw_->declaredDamping(); }
  DeviceClock* clock() noexcept override { return raw_->clock(); }
  std::vector<Guard> guards() const override { return raw_->guards(); }
  std::vector<GestureValue> gestureValues() const override { return raw_->gestureValues(); }
  double gestureTime() const noexcept override { return raw_->gestureTime(); }
  bool hasHand(int slice) const noexcept override { return raw_->hasHand(slice); }
  bool move(const HandMove& move) noexcept override { return raw_->move(move); }

  void set(int slice, const SliceCalibration& calibration) override {
    requireWithin("slice of the calibration", slice, 0, slices() - 1, "");
    checkCalibration(calibration, " of slice " + std::to_string(slice));
    SliceCalibration& old = calibration_.slices[static_cast<std::size_t>(slice)];
    const bool is_elsewhere = calibration.metres_per_volt != old.metres_per_volt ||
                              calibration.rest_volts != old.rest_volts;
    renewals_[static_cast<std::size_t>(slice)] +=
        old.is_calibrated && calibration.is_calibrated && is_elsewhere ? 1U : 0U;
    old = calibration;
    publish();
  }
  const Calibration& calibration() const noexcept override { return calibration_; }

  void push(int slice, double newtons) override {
    requireWithin("slice to push", slice, 0, slices() - 1, "");
    requireWithin("push", newtons, kMinPushN, kPushN, "N");
    if (!calibration_.slices[static_cast<std::size_t>(slice)].is_calibrated) {
      throw Exception("slice " + std::to_string(slice) + " has no calibration yet");
    }
    push_.begin(slice, newtons);
  }
  void endPush() noexcept override { push_.end(); }
  std::optional<Push> takePush() noexcept override { return push_.take(); }

  void readVolts(double* volts) noexcept override {
    volts_.refresh();
    std::copy_n(volts_.latest().begin(), slices(), volts);
  }

  ERGOTIC_REALTIME std::uint32_t exchange(const double* forces,
                                          double* positions) noexcept override {
    table_.refresh();
    const auto& table = table_.latest().slices;
    const std::uint64_t away = takeRenewals() | table_.latest().uncalibrated;
    uncalibrated_ = away;  // with the positions that it goes with
    const auto count = static_cast<std::size_t>(slices());
    for (std::size_t i = 0; i < count; ++i) {
      outputs_[i] = voltsOf(hasBit(away, i) ? 0.0 : forces[i], table[i]);
    }
    const int pushed = push_.slice();
    bool may_push = false;
    if (pushed >= 0) {
      const auto slice = static_cast<std::size_t>(pushed);
      may_push = forces[slice] == 0.0 && !hasBit(away, slice);
      outputs_[slice] = may_push ? voltsOf(push_.force(), table[slice]) : outputs_[slice];
    }
    Slices& sensors = volts_.draft();
    const std::uint32_t flags = raw_->exchange(outputs_.data(), sensors.data());
    if ((flags & kDeviceLost) == 0) {
      for (std::size_t i = 0; i < count; ++i) {
        positions_[i] = hasBit(away, i) ? 0.0 : positionOf(sensors[i], table[i]);
      }
      volts_.publish();
    }
    if (pushed >= 0) {
      push_.follow(positions_[static_cast<std::size_t>(pushed)],
                   may_push && (flags & (kDeviceLost | kMadeSafe)) == 0);
    }
    std::copy_n(positions_.begin(), count, positions);
    return flags;
  }

 private:
  static constexpr bool hasBit(std::uint64_t bits, std::size_t i) noexcept {
    return (bits >> i & 1U) != 0;
  }

  /// Slices with a new calibration. Each is uncalibrated for one exchange, so that the caller
  /// treats it like a slice that had no calibration, whatever its position.
  ERGOTIC_REALTIME std::uint64_t takeRenewals() noexcept {
    std::uint64_t renewed = 0;
    const auto& renewals = table_.latest().renewals;
    for (std::size_t i = 0; i < renewals.size(); ++i) {
      renewed |= std::exchange(seen_[i], renewals[i]) != renewals[i] ? std::uint64_t{1} << i : 0U;
    }
    return renewed;
  }

  void publish() noexcept {
    Table& table = table_.draft();
    table.uncalibrated = 0;
    table.renewals = renewals_;
    for (std::size_t i = 0; i < calibration_.slices.size(); ++i) {
      table.slices[i] = calibration_.slices[i];
      table.uncalibrated |= table.slices[i].is_calibrated ? 0U : std::uint64_t{1} << i;
    }
    table_.publish();
  }

  std::unique_ptr<Driver> raw_;
  Calibration calibration_;  // the operator's, as is
  std::array<std::uint32_t, kMaxSlices> renewals_{};
  std::atomic<std::uint64_t> uncalibrated_{0};  // bits
  rt::Mailbox<Table> table_;                    // to the tick
  rt::Mailbox<Slices> volts_;                   // to the operator

  SlicePush push_;

  // The tick's own.
  std::array<std::uint32_t, kMaxSlices> seen_{};
  Slices outputs_{};    // V
  Slices positions_{};  // m
};

}  // namespace

std::unique_ptr<CalibratedDriver> makeCalibratedDriver(std::unique_ptr<Driver> raw,
                                                       Calibration calibration) {
  return std::make_unique<CalibratedDriverOverRaw>(std::move(raw), std::move(calibration));
}

}  // namespace ergotic::tgr
