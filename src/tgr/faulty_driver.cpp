// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/faulty_driver.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <string>
#include <utility>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {
namespace {

constexpr std::array<const char*, 10> kNames{"not_a_number", "infinite", "jump", "frozen",
                                             "rail",         "missing",  "slow", "write_fails",
                                             "unplugged",    "noise"};

void requireInjectable(const FaultOrder& order, int slices) {
  const auto kind = static_cast<std::size_t>(order.kind);
  if (kind >= kNames.size()) {
    throw Exception("fault " + std::to_string(kind) + " is not known, allowed: 0..." +
                    std::to_string(kNames.size() - 1));
  }
  constexpr double kMaxTicks = 1e9;
  requireWithin("slice of the fault", order.slice, -1, slices - 1, "");
  requireWithin("ticks of the fault", static_cast<double>(order.ticks), 1.0, kMaxTicks, "");
  const std::string amount = std::string("amount of ") + kNames[kind];
  switch (order.kind) {
    case InjectedFault::kJump:
    case InjectedFault::kRail:
      requireWithin(amount, order.amount, -1.0, 1.0, "m");
      break;
    case InjectedFault::kSlow:
      requireWithin(amount, order.amount, 0.0, 10.0, "s");
      break;
    case InjectedFault::kNoise:
      requireWithin(amount, order.amount, 0.0, 0.1, "m");
      break;
    default:
      break;
  }
}

/// Delays as a device whose processor is busy: short times are exact, long ones leave the processor
/// to others.
ERGOTIC_REALTIME void linger(double seconds) noexcept {
  constexpr std::int64_t kAwakeNs = 1'000'000;
  const std::int64_t start = rt::monotonicNs();
  const std::int64_t end = start + static_cast<std::int64_t>(seconds * kNsPerS);
  if (end - start > kAwakeNs) {
    rt::sleepUntilNs(end);
  }
  while (rt::monotonicNs() < end) {
  }
}

class FaultyDriverOverAnother final : public FaultyDriver {
 public:
  explicit FaultyDriverOverAnother(std::unique_ptr<Driver> inside) : inside_(std::move(inside)) {}

  void open(double tick_rate_hz) override {
    inside_->open(tick_rate_hz);
    orders_.refresh();
    ticks_left_ = 0;
    unplugged_ = false;
  }
  void close() noexcept override { inside_->close(); }
  void reconnect() override {
    unplugged_ = false;
    inside_->reconnect();
  }
  int slices() const noexcept override { return inside_->slices(); }
  /// A device that is slow is not asked for each tick that it has cost.
  bool isSteppedByExchange() const noexcept override {
    const bool is_slow = ticks_left_ > 0 && order_.kind == InjectedFault::kSlow;
    return inside_->isSteppedByExchange() && !is_slow;
  }
  void makeSafe() noexcept override { inside_->makeSafe(); }
  void makeSafeInTick() noexcept override { inside_->makeSafeInTick(); }
  void rearm() noexcept override { inside_->rearm(); }
  int extraDelayTicks() const noexcept override { return inside_->extraDelayTicks(); }
  bool isRaw() const noexcept override { return inside_->isRaw(); }
  std::uint64_t uncalibrated() const noexcept override { return inside_->uncalibrated(); }
  std::vector<Guard> guards() const override { return inside_->guards(); }
  bool canHurt() const noexcept override { return inside_->canHurt(); }
  double damping() const noexcept override { return inside_->damping(); }
  double declaredDamping() const noexcept override { return inside_->declaredDamping(); }
  DeviceClock* clock() noexcept override { return inside_->clock(); }
  std::vector<GestureValue> gestureValues() const override { return inside_->gestureValues(); }
  double gestureTime() const noexcept override { return inside_->gestureTime(); }
  bool hasHand(int slice) const noexcept override { return inside_->hasHand(slice); }
  bool move(const HandMove& move) noexcept override { return inside_->move(move); }

  void check(const FaultOrder& order) const override { requireInjectable(order, slices()); }
  void inject(const FaultOrder& order) override {
    check(order);
    orders_.draft() = order;
    orders_.publish();
    if (order.kind == InjectedFault::kUnplugged) {
      unplugged_ = true;
    }
  }

  ERGOTIC_REALTIME std::uint32_t exchange(const double* forces,
                                          double* positions) noexcept override {
    takeOrder();
    if (unplugged_) {  // the device itself lets go of a force that nobody renews
      taken_.fill(0.0);
      const std::uint32_t flags = inside_->exchange(taken_.data(), positions);
      std::copy_n(seen_.begin(), slices(), positions);
      return flags | kDeviceLost;
    }
    const bool is_active = ticks_left_ > 0;
    std::uint32_t flags = is_active ? spoilForces(forces) : takeForces(forces);
    flags |= inside_->exchange(taken_.data(), positions);
    std::copy_n(positions, slices(), seen_.begin());
    if (is_active) {
      flags |= spoilPositions(positions);
      --ticks_left_;
    }
    return flags;
  }

 private:
  using Slices = std::array<double, kMaxSlices>;

  ERGOTIC_REALTIME void takeOrder() noexcept {
    if (orders_.refresh()) {
      order_ = orders_.latest();
      ticks_left_ = order_.kind == InjectedFault::kUnplugged ? 0 : order_.ticks;
      frozen_ = seen_;
    }
  }

  bool concerns(int slice) const noexcept { return order_.slice < 0 || order_.slice == slice; }

  ERGOTIC_REALTIME std::uint32_t takeForces(const double* forces) noexcept {
    std::copy_n(forces, slices(), taken_.begin());
    return kExchangeOk;
  }

  /// A force that is not taken leaves the last one in place, as an analogue output does.
  ERGOTIC_REALTIME std::uint32_t spoilForces(const double* forces) noexcept {
    if (order_.kind == InjectedFault::kSlow) {
      linger(order_.amount);
    }
    if (order_.kind != InjectedFault::kWriteFails) {
      return takeForces(forces);
    }
    for (int i = 0; i < slices(); ++i) {
      if (!concerns(i)) {
        taken_[static_cast<std::size_t>(i)] = forces[i];
      }
    }
    return kWriteFailed;
  }

  ERGOTIC_REALTIME std::uint32_t spoilPositions(double* positions) noexcept {
    for (int i = 0; i < slices(); ++i) {
      if (concerns(i)) {
        positions[i] = spoilt(positions[i], i);
      }
    }
    return order_.kind == InjectedFault::kMissing ? kMissingSample : kExchangeOk;
  }

  ERGOTIC_REALTIME double spoilt(double position, int slice) noexcept {
    switch (order_.kind) {
      case InjectedFault::kNotANumber:
        return std::numeric_limits<double>::quiet_NaN();
      case InjectedFault::kInfinite:
        return std::numeric_limits<double>::infinity();
      case InjectedFault::kJump:
        return position + order_.amount;
      case InjectedFault::kFrozen:
      case InjectedFault::kMissing:
        return frozen_[static_cast<std::size_t>(slice)];
      case InjectedFault::kRail:
        return order_.amount;
      case InjectedFault::kNoise:
        return position + order_.amount * noise_.next();
      default:
        return position;
    }
  }

  std::unique_ptr<Driver> inside_;
  rt::Mailbox<FaultOrder> orders_;
  std::atomic<bool> unplugged_{false};

  // The tick's own.
  FaultOrder order_;
  std::int64_t ticks_left_ = 0;
  Slices seen_{};    // positions that the device gave last
  Slices frozen_{};  // those before the order
  Slices taken_{};   // forces that the device has
  SensorNoise noise_{1};
};

}  // namespace

std::unique_ptr<FaultyDriver> makeFaultyDriver(std::unique_ptr<Driver> inside) {
  return std::make_unique<FaultyDriverOverAnother>(std::move(inside));
}

InjectedFault faultNamed(const std::string& name, const std::vector<std::string>& others) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    std::vector<std::string> all(kNames.begin(), kNames.end());
    all.insert(all.end(), others.begin(), others.end());
    std::string known;
    for (const std::string& each : all) {
      known += (known.empty() ? "" : ", ") + each;
    }
    throw Exception("fault '" + name + "' is not known, allowed: " + known);
  }
  return static_cast<InjectedFault>(found - kNames.begin());
}

}  // namespace ergotic::tgr
