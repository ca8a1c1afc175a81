// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/tgr/calibration.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Mechanics of one virtual slice and of the hand that holds it.
///
///   (m + m_hand) x'' = F + k_hand (target - x) + b_hand (target' - x') - b x' - dry(x')
///   F' / (2 pi bandwidth) = saturated(asked(t - delay)) - F
///
/// The defaults are plausible, not measured on a TGR.
struct VirtualSliceConfig {
  double mass = 0.3;            ///< kg, moving part
  double damping = 2.0;         ///< N s/m
  double dry_friction = 0.1;    ///< N
  double stop = 0.03;           ///< m, end stops at +-stop (stiff, lossy)
  double quantum = 1e-6;        ///< m, sensor resolution
  double noise_rms = 0.5e-6;    ///< m, sensor noise before quantisation
  double force_limit = 200.0;   ///< N, the actuator saturates
  double bandwidth = 15'000.0;  ///< Hz, of the actuator, a first-order lag; infinite: no lag
  double delay = 0.0;           ///< s, of the actuator
  double hand_mass = 0.1;       ///< kg
  double hand_stiffness = 500;  ///< N/m
  double hand_damping = 18.0;   ///< N s/m: 0.7 of what is critical, with the slice's own
  /// True characteristics of sensor and actuator, if the device speaks volts: the result of a
  /// perfect calibration.
  std::optional<SliceCalibration> volts;
};

struct VirtualDriverConfig {
  int slices = 12;
  VirtualSliceConfig slice;                  ///< slices that are not in `others`
  std::map<int, VirtualSliceConfig> others;  ///< slices that differ; all speak volts, or none does
  /// CSV `time_s,slice,target_m` or `tick,x0,...`: where the virtual hands want to be; empty:
  /// targets by setTarget only
  std::string gesture_file;
  double gesture_rate = 0.0;  ///< Hz, of the ticks of a CSV of positions; 0: the tick rate
  std::uint64_t seed = 1;     ///< seed of the sensor noise
  int extra_delay_ticks = 0;
  /// Name of a shared-memory segment of a device process (`virtual_tgr`); empty: the device lives
  /// inside the driver and is stepped by exchange, deterministically.
  std::string shared_memory;
  bool is_raw = false;  ///< the device process speaks volts; one inside the driver: see `volts`
};

/// The virtual TGR. Its targets can be moved from one other thread while it runs; they override the
/// gesture file.
/// \throws TextError from the gesture file, Exception if a setting is outside its range
std::unique_ptr<Driver> makeVirtualDriver(const VirtualDriverConfig& config);

/// Warnings about targets of a gesture file that are not played as written, in full sentences: for
/// slices that move nothing in the scene, targets beyond the end stops, rows after the end, no rows
/// at all. None for a file of positions.
/// \param slices_in_use  bit i: a port of the scene follows slice i
/// \param seconds        duration of the render, s
/// \param late_s         delay by which rows may exceed it without a warning, s
/// \throws TextError from the gesture file
std::vector<std::string> gestureWarnings(const VirtualDriverConfig& config,
                                         std::uint64_t slices_in_use,
                                         double seconds,
                                         double late_s = 0.0);

}  // namespace ergotic::tgr
