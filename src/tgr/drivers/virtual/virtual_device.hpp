// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "ergotic/rt/ring.hpp"
#include "tgr/drivers/virtual/force_record.hpp"
#include "tgr/drivers/virtual/shared_device.hpp"
#include "tgr/drivers/virtual/slice_bank.hpp"

namespace ergotic::tgr {

struct VirtualDeviceConfig {
  std::string shared_memory;  ///< name of the segment
  VirtualDriverConfig bank;   ///< its slices; delay and shared memory are not those of a process
  double rate_hz = 8000.0;    ///< step rate of the mechanics, 100...50000
  double watchdog_s = 0.010;  ///< longest time between exchanges, 0.001...10
};

/// A virtual device that outlives its driver: mechanics on a clock of its own, accessed through
/// shared memory, with a watchdog. Force needs a driver that is open, armed, and exchanging: after
/// `watchdog_s` without an exchange there is none until the driver exchanges again and re-arms. The
/// gesture starts anew with every driver that opens.
class VirtualDevice {
 public:
  /// \throws DeviceError from the segment; TextError and Exception as SliceBank
  explicit VirtualDevice(const VirtualDeviceConfig& config);

  /// Runs one step of the mechanics, at the time `now_ns`. Realtime: yes. Thread: one
  void step(std::int64_t now_ns) noexcept;

  /// Steps at absolute times until `stop`. After a gap of more than `kMaxBehindNs` the steps that
  /// were missed are dropped. Realtime: yes, but the sleep. Thread: as `step`
  void run(const std::atomic<bool>& stop) noexcept;

  /// \return false if there is no record. Thread: one, any
  bool pollForce(ForceRecord& record) noexcept { return records_.pop(record); }
  /// Number of records that found their ring full.
  std::int64_t droppedRecords() const noexcept { return dropped_records_; }

  static constexpr std::int64_t kMaxBehindNs = 50'000'000;

 private:
  bool mayPush(std::int64_t now_ns) noexcept;
  void takeForces(std::int64_t now_ns) noexcept;

  VirtualDeviceConfig config_;
  SliceBank bank_;
  SharedSegment shared_;
  std::int64_t watchdog_ns_;
  std::uint32_t session_ = 0;
  std::uint64_t exchanges_ = 0;
  std::int64_t last_exchange_ns_ = 0;
  bool heard_ = false;                       // exchanges come, and none has been late since
  std::array<double, kMaxSlices> asked_{};   // by the driver, N or V
  std::array<double, kMaxSlices> forces_{};  // N, as felt
  rt::Ring<ForceRecord> records_{1U << 17U};
  std::atomic<std::int64_t> dropped_records_{0};
};

}  // namespace ergotic::tgr
