// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/fault.hpp"
#include "ergotic/tgr/safety/gate.hpp"
#include "ergotic/tgr/safety/missing_samples.hpp"
#include "ergotic/tgr/safety/safety_config.hpp"
#include "ergotic/tgr/safety/slice_chain.hpp"

namespace ergotic::tgr {

/// The last word on every force, between the instrument and the driver.
///
/// Once per tick, after the exchange: `validate` the positions, then `limit` the forces: detectors,
/// gate and ramp, slew, force limit, port energy clamp. A caller that leaves `limit` out sends
/// zeros. Whatever happens |F| may fall at once; after a fault it grows again only after `recover`
/// and `engage`.
///
/// Realtime: yes, all but the constructor. Thread: tick
class SafetyChain {
 public:
  /// \param extra_delay_ticks  Driver::extraDelayTicks()
  /// \throws Exception if a setting is outside its range
  SafetyChain(const SafetyConfig& config, int slices, double tick_s, int extra_delay_ticks = 0);

  /// Opens the gate with a ramp from zero. No effect while it is open, or after a fault.
  void engage() noexcept;
  /// Closes the gate at once.
  void disengage() noexcept;
  /// Force to zero at once, and back within `resume_ramp_s`: after a stall or a swap the hand meets
  /// a model that has moved on. The force of the last `limit` is taken as never sent. The gate
  /// stays as it is.
  void resume() noexcept;
  /// Forgets a fault and all that the chain remembers, but where the model's forces were zero; the
  /// gate stays closed.
  void recover() noexcept;

  /// Slices that move something, a bit each; all of them at first. The others get no force and
  /// raise no fault. One that comes into use is met afresh: its sample may be anywhere.
  void setInUse(std::uint64_t slices) noexcept;

  /// Replaces bad or missing positions by the last good ones.
  /// \param[in,out] positions  [slices] m
  /// \param flags        ExchangeFlag bits of the driver
  /// \param host_missed  ticks that the host let pass since the last call: no sample was asked for
  /// \return slices held, a bit each; a fault if a slice in use is bad, or missing for too long
  std::uint64_t validate(double* positions, std::uint32_t flags, std::int64_t host_missed) noexcept;

  /// \param[in,out] forces  [slices] N; afterwards finite and within the limit, 0 if gate closed
  /// \param fade  0...1, multiplies all forces as the ramps do
  void limit(double* forces, double fade = 1.0) noexcept;

  bool isOpen() const noexcept { return gate_.isOpen(); }
  double gain() const noexcept { return gate_.ramp(); }  ///< 0...1, of the ramp after engage
  FaultReason fault() const noexcept { return fault_; }
  int faultSlice() const noexcept { return fault_slice_; }  ///< -1: all of them, or none
  /// Slice of which the last `limit` removed a force because its sensor value is constant; -1:
  /// none.
  int mutedSlice() const noexcept { return muted_slice_; }
  /// \pre 0 <= slice < slices
  SliceReading reading(int slice) const noexcept {
    return slices_[static_cast<std::size_t>(slice)].reading();
  }

 private:
  bool isInUse(std::size_t slice) const noexcept { return (in_use_ >> slice & 1U) != 0; }
  std::uint64_t all() const noexcept;
  bool hasSample(std::uint32_t flags) noexcept;
  void raise(FaultReason fault, int slice) noexcept;

  Gate gate_;
  MissingSamples missing_;
  std::vector<SliceChain> slices_;
  std::uint64_t in_use_;
  bool has_limited_ = true;  // since the last validate
  FaultReason fault_ = FaultReason::kNone;
  int fault_slice_ = -1;
  int muted_slice_ = -1;
};

}  // namespace ergotic::tgr
