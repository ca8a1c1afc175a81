// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/combined_driver.hpp"

#include <algorithm>
#include <exception>
#include <numeric>
#include <string>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

class CombinedDriver final : public Driver {
 public:
  explicit CombinedDriver(std::vector<std::unique_ptr<Driver>> drivers)
      : drivers_(std::move(drivers)) {
    if (drivers_.empty()) {
      throw Exception("no device to combine, allowed: one or more");
    }
    for (const auto& driver : drivers_) {
      if (driver->isRaw()) {
        throw Exception("a device that speaks volts cannot be combined without its calibration");
      }
    }
    check();
  }

  void open(double tick_rate_hz) override {
    std::size_t opened = 0;
    try {
      for (; opened < drivers_.size(); ++opened) {
        drivers_[opened]->open(tick_rate_hz);
      }
    } catch (...) {
      for (std::size_t i = 0; i < opened; ++i) {
        drivers_[i]->close();
      }
      throw;
    }
  }

  void close() noexcept override {
    for (const auto& driver : drivers_) {
      driver->close();
    }
  }

  void reconnect() override {
    std::exception_ptr failed;
    for (const auto& driver : drivers_) {  // one that stays lost does not keep the others lost
      try {
        driver->reconnect();
      } catch (...) {
        failed = std::current_exception();
      }
    }
    if (failed) {
      std::rethrow_exception(failed);
    }
  }

  int slices() const noexcept override {
    return std::accumulate(
        drivers_.begin(), drivers_.end(), 0,
        [](int sum, const std::unique_ptr<Driver>& driver) { return sum + driver->slices(); });
  }

  ERGOTIC_REALTIME std::uint32_t exchange(const double* forces,
                                          double* positions) noexcept override {
    std::uint32_t flags = kExchangeOk;
    int first = 0;
    for (const auto& driver : drivers_) {
      flags |= driver->exchange(forces + first, positions + first);
      first += driver->slices();
    }
    return flags;
  }

  bool isSteppedByExchange() const noexcept override {
    return std::all_of(drivers_.begin(), drivers_.end(), [](const std::unique_ptr<Driver>& driver) {
      return driver->isSteppedByExchange();
    });
  }

  void makeSafe() noexcept override {
    for (const auto& driver : drivers_) {
      driver->makeSafe();
    }
  }

  void makeSafeInTick() noexcept override {
    for (const auto& driver : drivers_) {
      driver->makeSafeInTick();
    }
  }

  void rearm() noexcept override {
    for (const auto& driver : drivers_) {
      driver->rearm();
    }
  }

  bool canHurt() const noexcept override {
    return std::any_of(drivers_.begin(), drivers_.end(),
                       [](const std::unique_ptr<Driver>& driver) { return driver->canHurt(); });
  }

  int extraDelayTicks() const noexcept override {
    int ticks = 0;
    for (const auto& driver : drivers_) {
      ticks = std::max(ticks, driver->extraDelayTicks());
    }
    return ticks;
  }

  std::uint64_t uncalibrated() const noexcept override {
    std::uint64_t bits = 0;
    int first = 0;
    for (const auto& driver : drivers_) {
      bits |= driver->uncalibrated() << static_cast<unsigned>(first);
      first += driver->slices();
    }
    return bits;
  }

  std::vector<Guard> guards() const override {
    std::vector<Guard> all;
    for (const auto& driver : drivers_) {
      for (Guard& guard : driver->guards()) {
        all.push_back(std::move(guard));
      }
    }
    return all;
  }

  double damping() const noexcept override { return least(&Driver::damping); }
  double declaredDamping() const noexcept override { return least(&Driver::declaredDamping); }

  DeviceClock* clock() noexcept override {
    for (const auto& driver : drivers_) {
      if (DeviceClock* const clock = driver->clock()) {
        return clock;
      }
    }
    return nullptr;
  }

  std::vector<GestureValue> gestureValues() const override {
    std::vector<GestureValue> all;
    for (const auto& driver : drivers_) {
      for (GestureValue& value : driver->gestureValues()) {
        all.push_back(std::move(value));
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    return all;
  }
  /// Longest time of all; devices that have a gesture are in step.
  double gestureTime() const noexcept override {
    double longest_s = 0.0;
    for (const auto& driver : drivers_) {
      longest_s = std::max(longest_s, driver->gestureTime());
    }
    return longest_s;
  }

  bool hasHand(int slice) const noexcept override {
    Driver* const driver = ownerOf(slice);
    return driver != nullptr && driver->hasHand(slice);
  }
  bool move(const HandMove& move) noexcept override {
    HandMove own = move;
    Driver* const driver = ownerOf(own.slice);
    return driver != nullptr && driver->move(own);
  }

 private:
  /// \param slice  of all; becomes that of the driver, which is null if there is none
  Driver* ownerOf(int& slice) const noexcept {
    for (const auto& driver : drivers_) {
      if (slice < driver->slices()) {
        return driver.get();
      }
      slice -= driver->slices();
    }
    return nullptr;
  }
  double least(double (Driver::*quantity)() const noexcept) const noexcept {
    double least = (drivers_.front().get()->*quantity)();
    for (const auto& driver : drivers_) {
      least = std::min(least, (driver.get()->*quantity)());
    }
    return least;
  }

  void check() const {
    if (const int count = slices(); count > kMaxSlices) {
      throw Exception(std::to_string(count) + " slices in all devices together, allowed: at most " +
                      std::to_string(kMaxSlices));
    }
    const auto clocks = std::count_if(
        drivers_.begin(), drivers_.end(),
        [](const std::unique_ptr<Driver>& driver) { return driver->clock() != nullptr; });
    if (clocks > 1) {
      throw Exception(std::to_string(clocks) +
                      " devices with a clock of their own, allowed: at most one");
    }
  }

  std::vector<std::unique_ptr<Driver>> drivers_;
};

}  // namespace

std::unique_ptr<Driver> combine(std::vector<std::unique_ptr<Driver>> drivers) {
  return std::make_unique<CombinedDriver>(std::move(drivers));
}

}  // namespace ergotic::tgr
