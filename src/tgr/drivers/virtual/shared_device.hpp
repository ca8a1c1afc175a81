// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <type_traits>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// The newest values from one writing to one reading process (a sequence lock): neither waits, and
/// a writer that was killed in the middle of a write leaves nothing that the next could not use.
///
/// Realtime: yes. Source: H.-J. Boehm, "Can seqlocks get along with programming language memory
/// models?", MSPC 2012; the values are acquired and released, so that no fence is needed.
class SharedFrame {
 public:
  void write(const double* values, int count) noexcept;

  /// \return false if the writer was in the way each of `kTries` times; `values` is then untouched
  bool read(double* values, int count) const noexcept;

 private:
  static constexpr int kTries = 4;
  std::atomic<std::uint64_t> sequence_{0};  // odd while being written
  std::array<std::atomic<double>, kMaxSlices> values_{};
};

/// Moves of hands on their way from one writing to one reading process. Neither waits. Each belongs
/// to a session: those of a driver that is gone have no effect under the next one. Realtime: yes
class SharedMoves {
 public:
  /// \return false if 256 of them wait. Process: driver
  bool push(std::uint32_t session, const HandMove& move) noexcept;
  /// \return false if none of this session waits. Process: device
  bool pop(std::uint32_t session, HandMove& move) noexcept;

 private:
  static constexpr std::uint32_t kCapacity = 256;
  struct Entry {
    std::uint32_t session = 0;
    HandMove move;
  };
  std::array<Entry, kCapacity> entries_{};
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> read_{0};
};

/// Traits of a virtual device, constant while it lives.
struct SharedTraits {
  std::int32_t slices = 0;
  bool is_raw = false;  ///< positions and forces are volts
  double step_rate_hz = 0.0;
  double delay_s = 0.0;  ///< the longest of its actuators
  double damping = 0.0;  ///< the least of its slices, N s/m
};

/// Data that a virtual device and its driver share as two processes.
struct SharedDevice {
  static constexpr std::uint32_t kMagic = 0x54475256U;
  static constexpr std::uint32_t kVersion = 3;

  std::atomic<std::uint32_t> magic{0};  ///< kMagic once all the rest is in place
  std::uint32_t version = kVersion;
  std::uint64_t size = sizeof(SharedDevice);
  SharedTraits traits;
  std::int64_t born_ns = 0;  ///< CLOCK_MONOTONIC; distinguishes a device from an earlier one

  // The device writes:
  alignas(64) std::atomic<std::int32_t> device_pid{0};  ///< 0: the device has gone
  std::atomic<std::int64_t> heartbeat_ns{0};            ///< CLOCK_MONOTONIC of its last step
  SharedFrame positions;                                ///< m, or V

  // The driver writes:
  alignas(64) std::atomic<std::int32_t> driver_pid{0};  ///< 0: no driver, so no force
  std::atomic<std::uint32_t> session{0};                ///< counts the times a driver opened
  std::atomic<std::uint64_t> exchanges{0};              ///< in this session, for the watchdog
  SharedFrame forces;                                   ///< N, or V
  SharedMoves moves;

  // Both write:
  alignas(64) std::atomic<std::uint32_t> safe{0};  ///< not 0: no force until the driver re-arms
};
static_assert(std::is_standard_layout_v<SharedDevice>);
static_assert(std::atomic<double>::is_always_lock_free);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// Whether there is a process of this id. Realtime: no
bool processLives(std::int32_t pid) noexcept;

/// A mapped segment of POSIX shared memory that holds a SharedDevice. Realtime: no, but `->`.
class SharedSegment {
 public:
  /// Makes the segment, in place of one whose device has died; it goes with this object.
  /// \param name  with or without the leading slash
  /// \throws DeviceError if the name is not usable or a living device has it
  static SharedSegment create(const std::string& name, const SharedTraits& traits);

  /// Maps the segment of a running device.
  /// \throws DeviceError if there is none, or it is of another version
  static SharedSegment attach(const std::string& name);

  SharedSegment(SharedSegment&& other) noexcept;
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;
  SharedSegment& operator=(SharedSegment&&) = delete;
  ~SharedSegment();

  SharedDevice* operator->() const noexcept { return device_; }
  SharedDevice* get() const noexcept { return device_; }

 private:
  SharedSegment(SharedDevice* device, std::string owned_name)
      : device_(device), owned_name_(std::move(owned_name)) {}

  SharedDevice* device_;
  std::string owned_name_;  // to be unlinked; empty if attached
};

}  // namespace ergotic::tgr
