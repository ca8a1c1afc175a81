// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/fault.hpp"

namespace ergotic::tgr {

struct SafetyConfig {
  double force_limit_n = 20.0;    ///< per slice, 0...kAbsoluteForceLimitN
  double ramp_s = 2.0;            ///< from zero to full gain after engage, 0.1...10
  double resume_ramp_s = 0.05;    ///< the same after a stall or a swap, 0.005...10
  double position_limit_m = 0.1;  ///< |x| of a slice beyond this is a bad sample, 0.001...1
  int max_missing = 20;           ///< ticks a missing sample is held before a Fault, 0...1000
};

/// The last word on every force, between the instrument and the driver.
///
/// Step 1 of every tick: `validate` the positions. Step 2: `limit` the forces: detectors, gate and
/// ramp, force limit. Whatever happens |F| may fall at once; it grows again only after `engage`.
/// Realtime: yes, all but the constructor. Thread: tick
class SafetyChain {
 public:
  /// \throws Exception if a setting is outside its range
  SafetyChain(const SafetyConfig& config, int slices, double tick_s);

  /// Opens the gate with a ramp from zero. No effect while it is open, or after a fault.
  void engage() noexcept;
  /// Closes the gate at once.
  void disengage() noexcept;
  /// Force to zero at once, and back within `resume_ramp_s`: after a stall or a swap the hand meets
  /// a model that has moved on. The gate stays as it is.
  void resume() noexcept;
  /// Forgets a fault and all that detectors remember; the gate stays closed.
  void recover() noexcept;

  /// Replaces bad or missing positions by the last good ones.
  /// \param[in,out] positions  [slices] m
  /// \param flags        ExchangeFlag bits of the driver
  /// \param host_missed  ticks that the host let pass since the last call: no sample was asked for
  /// \return slices held, a bit each; a fault if a slice is bad, or missing for too long
  std::uint64_t validate(double* positions, std::uint32_t flags, std::int64_t host_missed) noexcept;

  /// \param[in,out] forces  [slices] N; afterwards finite and within the limit, 0 if gate closed
  void limit(double* forces) noexcept;

  bool isOpen() const noexcept { return open_; }
  double gain() const noexcept { return gain_; }  ///< 0...1, of the ramp after engage
  FaultReason fault() const noexcept { return fault_; }
  int faultSlice() const noexcept { return fault_slice_; }

 private:
  void raise(FaultReason fault, int slice) noexcept;

  SafetyConfig config_;
  int slices_;
  double gain_step_;
  double resume_step_;
  bool open_ = false;
  double gain_ = 0.0;
  double resume_gain_ = 1.0;
  int missing_ = 0;
  FaultReason fault_ = FaultReason::kNone;
  int fault_slice_ = -1;
  std::array<double, kMaxSlices> last_good_{};
};

}  // namespace ergotic::tgr
