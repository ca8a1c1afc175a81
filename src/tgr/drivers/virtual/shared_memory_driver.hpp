// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <list>

#include "ergotic/tgr/virtual_driver.hpp"
#include "tgr/drivers/virtual/shared_device.hpp"

namespace ergotic::tgr {

/// The driver's side of a virtual device that is a process of its own. Never waits for it: it
/// leaves the forces, and takes the newest positions.
class SharedMemoryDriver final : public Driver {
 public:
  /// \throws Exception if a setting is outside its range or belongs to the device process
  explicit SharedMemoryDriver(const VirtualDriverConfig& config);
  ~SharedMemoryDriver() override;
  SharedMemoryDriver(const SharedMemoryDriver&) = delete;
  SharedMemoryDriver& operator=(const SharedMemoryDriver&) = delete;

  /// Opens the device, and waits up to a second for it to come up.
  /// \throws DeviceError if there is no device, another driver has it, or its slices differ
  void open(double tick_rate_hz) override;
  void close() noexcept override;
  /// Reconnects to a device that was started again under the same name.
  /// \throws DeviceError if there is none, or it is another one than was opened
  void reconnect() override;
  int slices() const noexcept override { return slices_; }
  std::uint32_t exchange(const double* forces, double* positions) noexcept override;
  void makeSafe() noexcept override;
  void rearm() noexcept override;
  /// Worst-case delay: a force waits for the device's next step, and the position is one step old.
  int extraDelayTicks() const noexcept override { return extra_delay_ticks_; }
  bool isRaw() const noexcept override { return is_raw_; }
  bool canHurt() const noexcept override { return false; }
  double damping() const noexcept override { return traits_.damping; }
  double declaredDamping() const noexcept override { return damping(); }
  std::vector<Guard> guards() const override;
  bool hasHand(int slice) const noexcept override { return slice >= 0 && slice < slices_; }
  bool move(const HandMove& move) noexcept override;

  static constexpr std::int64_t kMissingNs = 20'000'000;  ///< age of the device's last step
  static constexpr std::int64_t kLostNs = 1'000'000'000;

 private:
  void join(SharedSegment segment);

  std::string name_;
  int slices_;
  bool is_raw_;
  SharedTraits traits_;  // of the device that was opened
  int extra_delay_ticks_ = 0;
  std::list<SharedSegment> segments_;  // older ones stay: makeSafe may be in one, in any thread
  std::atomic<SharedDevice*> device_{nullptr};  // the newest, open or not
  std::atomic<bool> open_{false};
  std::atomic<bool> safe_{false};
  std::array<double, kMaxSlices> last_positions_{};
};

}  // namespace ergotic::tgr
