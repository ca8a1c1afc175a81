// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace ergotic::tgr {

constexpr int kMaxSlices = 64;
constexpr double kAbsoluteForceLimitN = 200.0;  ///< what a slice can do; no setting exceeds it

/// Bits of what `exchange` met; 0: all went well.
enum ExchangeFlag : std::uint32_t {
  kExchangeOk = 0,
  kMissingSample = 1U << 0U,  ///< at least one position is not fresh
  kDeviceLost = 1U << 1U,     ///< the device does not answer any more
  kMadeSafe = 1U << 2U,       ///< forces are latched to zero by makeSafe()
};

/// A force-feedback device, an impedance device: it gives positions and takes forces.
///
/// The order of calls is open, any number of exchange, close. `makeSafe` may come at any time.
class Driver {
 public:
  virtual ~Driver() = default;

  /// Opens the device with zero force. Realtime: no. Thread: setup
  /// \param tick_rate_hz  rate at which exchange will be called
  /// \throws DeviceError saying which device, what failed, and what to do
  virtual void open(double tick_rate_hz) = 0;

  /// Zero force, then gives the device back. Idempotent. Realtime: no. Thread: setup
  virtual void close() noexcept = 0;

  /// Number of slices, 1...kMaxSlices, constant after open.
  virtual int slices() const noexcept = 0;

  /// One transaction: the forces of the last tick go out, positions come in.
  /// \param[in]  forces     [slices] N, positive along the slice's axis (up)
  /// \param[out] positions  [slices] m, relative to the slice's rest
  /// \return ExchangeFlag bits
  /// Realtime: yes. Thread: tick
  virtual std::uint32_t exchange(const double* forces, double* positions) noexcept = 0;

  /// Zero force now and from now on: later exchanges send zero until `rearm`. Idempotent, from any
  /// thread or a signal's helper thread, also while exchange runs; takes at most one tick.
  virtual void makeSafe() noexcept = 0;

  /// Allows force again after makeSafe; the caller's chain ramps it in. Thread: setup
  virtual void rearm() noexcept = 0;

  /// Ticks of delay the driver adds to the loop's one (0 for a synchronous device).
  virtual int extraDelayTicks() const noexcept { return 0; }
};

}  // namespace ergotic::tgr
