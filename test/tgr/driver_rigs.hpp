// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/tgr/calibration.hpp"
#include "ergotic/tgr/combined_driver.hpp"
#include "ergotic/tgr/faulty_driver.hpp"
#include "ergotic/tgr/replay_driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_device.hpp"

/// Drivers with their devices, as the contract test wants them.
namespace ergotic::test {

using ThreeSlices = std::array<double, 3>;

/// A slice that moves by force alone and is seen as it is.
inline tgr::VirtualSliceConfig plainSlice() {
  tgr::VirtualSliceConfig slice;
  slice.dry_friction = 0.0;
  slice.quantum = 0.0;
  slice.noise_rms = 0.0;
  slice.bandwidth = std::numeric_limits<double>::infinity();
  return slice;
}

/// Such a slice between stops that are not in the way.
inline tgr::VirtualSliceConfig idealSlice() {
  tgr::VirtualSliceConfig slice = plainSlice();
  slice.stop = 0.1;
  return slice;
}

/// A name of shared memory that no other test uses.
inline std::string freshSegmentName() {
  static int count = 0;
  return "ergotic_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++);
}

inline std::unique_ptr<tgr::Driver> makePlainVirtual(int slices) {
  tgr::VirtualDriverConfig config;
  config.slices = slices;
  config.slice = plainSlice();
  return tgr::makeVirtualDriver(config);
}

class InProcessRig {
 public:
  static constexpr bool kFeelsForce = true;
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_ = makePlainVirtual(3);
};

class FaultyRig {
 public:
  static constexpr bool kFeelsForce = true;
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_ = tgr::makeFaultyDriver(makePlainVirtual(3));
};

/// A device that speaks volts, behind the calibration that it truly has.
class CalibratedRig {
 public:
  static constexpr bool kFeelsForce = true;
  CalibratedRig() {
    tgr::SliceCalibration truth;
    truth.is_calibrated = true;
    truth.metres_per_volt = -0.005;
    truth.volts_per_newton = 0.05;
    tgr::VirtualDriverConfig config;
    config.slices = 3;
    config.slice = plainSlice();
    config.slice.volts = truth;
    driver_ = tgr::makeCalibratedDriver(tgr::makeVirtualDriver(config), {{truth, truth, truth}});
  }
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_;
};

class CombinedRig {
 public:
  static constexpr bool kFeelsForce = true;
  CombinedRig() {
    std::vector<std::unique_ptr<tgr::Driver>> devices;
    devices.push_back(makePlainVirtual(3));
    devices.push_back(makePlainVirtual(2));
    driver_ = tgr::combine(std::move(devices));
  }
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_;
};

/// The device of another process, but stepped here, one step per tick, on a clock that only
/// `elapse` moves, so that no test depends on how fast it runs.
class SharedMemoryRig {
 public:
  static constexpr bool kFeelsForce = true;
  static constexpr double kRateHz = 1000.0;
  static constexpr std::int64_t kStepNs = 1'000'000;

  explicit SharedMemoryRig(const std::string& gesture_file = "")
      : device_(std::make_unique<tgr::VirtualDevice>(deviceConfig(gesture_file))),
        driver_(makeDriver()) {}

  std::unique_ptr<tgr::Driver> makeDriver(int slices = 3) const {
    tgr::VirtualDriverConfig config;
    config.slices = slices;
    config.shared_memory = name_;
    return tgr::makeVirtualDriver(config);
  }
  tgr::Driver& driver() { return *driver_; }
  tgr::VirtualDevice& device() { return *device_; }
  const std::string& name() const { return name_; }
  std::int64_t now() const { return now_ns_; }
  void setNow(std::int64_t now_ns) { now_ns_ = now_ns; }
  void elapse() {
    now_ns_ += kStepNs;
    device_->step(now_ns_);
  }
  void endDevice() { device_.reset(); }
  void restartDevice() { device_ = std::make_unique<tgr::VirtualDevice>(deviceConfig("")); }

 private:
  tgr::VirtualDeviceConfig deviceConfig(const std::string& gesture_file) const {
    tgr::VirtualDeviceConfig config;
    config.shared_memory = name_;
    config.rate_hz = kRateHz;
    config.bank.slices = 3;
    config.bank.slice = plainSlice();
    config.bank.gesture_file = gesture_file;
    return config;
  }

  std::string name_ = freshSegmentName();
  std::unique_ptr<tgr::VirtualDevice> device_;
  std::unique_ptr<tgr::Driver> driver_;
  // An hour ahead: the device always looks alive to the driver, however slow the machine is.
  std::int64_t now_ns_ = rt::monotonicNs() + 3'600'000'000'000;
};

/// Never ends.
class CountingSource final : public tgr::GestureSource {
 public:
  int slices() const noexcept override { return 2; }
  bool next(double* positions) noexcept override {
    count_ += 1.0;
    positions[0] = 1e-9 * count_;
    positions[1] = -1e-9 * count_;
    return true;
  }

 private:
  double count_ = 0.0;
};

class ReplayRig {
 public:
  static constexpr bool kFeelsForce = false;
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_ = tgr::makeReplayDriver(std::make_unique<CountingSource>());
};

}  // namespace ergotic::test
