// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// From volts to metres and from newtons to volts, of one slice. The sign of a gain is the
/// direction: positions and forces are positive along the slice's axis (up).
struct SliceCalibration {
  bool is_calibrated = false;
  double metres_per_volt = 0.0;  ///< not 0
  double rest_volts = 0.0;       ///< at position 0
  double low_volts = -10.0;      ///< the sensor's range; at or beyond it the sensor is at its rail
  double high_volts = 10.0;
  double volts_per_newton = 0.0;  ///< not 0
  /// Output at zero force, at most 0.1 N away from 0 V: at 0 V is a device that was made safe, or
  /// whose station died.
  double zero_volts = 0.0;
  double max_volts = 10.0;          ///< the output's range is +-max_volts
  double full_scale_newtons = 0.0;  ///< what max_volts really give, as was measured; 0: not known
  double residual_m = 0.0;          ///< rms of the fit
  double noise_m = 0.0;             ///< rms of the sensor at rest
};

/// Calibrations of the slices of a device, from slice 0 on.
struct Calibration {
  std::vector<SliceCalibration> slices;
};

/// Reads `slices: [{...}, ...]`, see docs/tgr.md. A slice that is absent or `null` is uncalibrated.
/// \throws TextError with file:line:col, value and allowed range
Calibration readCalibration(const std::string& text, const std::string& name);
std::string toYaml(const Calibration& calibration);

/// One place where a slice was held still: where it is and what its sensor said.
struct CalibrationPoint {
  double position_m = 0.0;
  double mean_volts = 0.0;
  double rms_volts = 0.0;  ///< about the mean
};

/// Least-squares line through at least two places; what the fit cannot know is taken from `from`.
/// \throws Exception saying what is wrong: too few places, the slice was not moved, noise as large
///         as the stroke, residual above `max_residual_m`
SliceCalibration fit(const std::vector<CalibrationPoint>& points,
                     const SliceCalibration& from,
                     double max_residual_m);

/// A device that speaks volts, made to speak metres and newtons.
///
/// Slices that are not calibrated give position 0 and get the volts of no force. A sensor at its
/// rail gives a position that is not a number, so that the safety chain stops. Calibrations may
/// change while ticks go on.
class CalibratedDriver : public Driver {
 public:
  /// Takes effect with a later exchange, which `uncalibrated` then tells of: a slice that had
  /// another calibration is without one for that exchange. Thread: operator
  /// \throws Exception if a slice does not exist or a number is out of range
  virtual void set(int slice, const SliceCalibration& calibration) = 0;
  /// Thread: operator
  virtual const Calibration& calibration() const noexcept = 0;
  /// Newest sensor values. \param[out] volts  [slices]. Realtime: yes. Thread: operator
  virtual void readVolts(double* volts) noexcept = 0;
};

/// \throws Exception if `raw` does not speak volts or a calibration is out of range
std::unique_ptr<CalibratedDriver> makeCalibratedDriver(std::unique_ptr<Driver> raw,
                                                       Calibration calibration);

}  // namespace ergotic::tgr
