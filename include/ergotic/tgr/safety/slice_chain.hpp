// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/tgr/fault.hpp"
#include "ergotic/tgr/safety/blow_up_detector.hpp"
#include "ergotic/tgr/safety/energy_detector.hpp"
#include "ergotic/tgr/safety/force_limit.hpp"
#include "ergotic/tgr/safety/passivity.hpp"
#include "ergotic/tgr/safety/port_energy.hpp"
#include "ergotic/tgr/safety/position_check.hpp"
#include "ergotic/tgr/safety/safety_config.hpp"
#include "ergotic/tgr/safety/slew_limit.hpp"

namespace ergotic::tgr {

/// Readings of a slice's chain since the last `recover`, for diagnostics.
struct SliceReading {
  double energy_j = 0.0;           ///< present energy of the port
  double least_energy_j = 0.0;     ///< least energy of the port; below 0: that much was given out
  std::int64_t clamped_ticks = 0;  ///< ticks in which the energy clamp cut the force
  std::int64_t muted_ticks = 0;    ///< ticks with a constant sensor value, and force 0
  double peak_raw_force_n = 0.0;   ///< peak force of the model
};

/// Steps of the safety chain that each slice has for itself. Realtime: yes, all but the
/// constructor.
class SliceChain {
 public:
  /// \param delay_ticks  of the whole loop, 1...PortEnergy::kMaxDelayTicks
  SliceChain(const SafetyConfig& config, double tick_s, int delay_ticks);

  /// Takes a sample. \param[in,out] x  m, replaced if bad. \param ticks  since the last call
  FaultReason accept(double& x, std::int64_t ticks) noexcept;
  /// Accounts for a missing sample. \param[out] x  m
  void hold(double& x, std::int64_t ticks) noexcept;

  /// Runs the detectors. \param raw  N, as the model wants it, for the position of this tick
  /// \param open  force goes out: only then is energy judged
  FaultReason inspect(double raw, bool open) noexcept;

  /// Ramps, passivity controller, slew, limit, energy clamp. \return N, to be sent
  double limited(double raw, double gain) noexcept;
  /// Records that no force is sent.
  void release() noexcept;

  /// \pre the gain starts from 0
  void engage() noexcept;
  /// Restarts after ticks without force in which the model moved on unchecked.
  void resume() noexcept;
  /// Resets all but the position at which the model's force was 0: hands may still be inside a
  /// wall.
  void recover() noexcept;
  void forget() noexcept;

  /// Whether the last `limited` removed a significant force because the sensor value is constant.
  bool justMuted() const noexcept { return just_muted_; }
  SliceReading reading() const noexcept;

 private:
  void moved(double x, std::int64_t ticks) noexcept;
  double trust() noexcept;
  void turnTo(double gain) noexcept;

  PositionCheck position_;
  BlowUpDetector blow_up_;
  EnergyDetector detector_;
  PassivityController controller_;
  bool controls_;
  SlewLimit slew_;
  ForceLimit force_limit_;
  PortEnergy port_;
  bool knows_x_ = false;
  double x_ = 0.0;
  double dx_ = 0.0;
  double way_ = 0.0;    // since the last look, m
  double gain_ = 0.0;   // of the last force
  double trust_ = 1.0;  // in the sensor, a gain as well
  double trust_step_;
  double least_kick_;  // N
  bool just_muted_ = false;
  std::int64_t clamped_ticks_ = 0;
  std::int64_t muted_ticks_ = 0;
  double peak_raw_ = 0.0;
};

}  // namespace ergotic::tgr
