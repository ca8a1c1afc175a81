// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Calibration of one slice: volts to metres and newtons to volts. The sign of a gain gives the
/// direction: positions and forces are positive along the slice's axis (up).
struct SliceCalibration {
  bool is_calibrated = false;
  double metres_per_volt = 0.0;  ///< not 0
  double rest_volts = 0.0;       ///< sensor voltage at position 0
  double low_volts = -10.0;      ///< the sensor's range; at or beyond it the sensor is at its rail
  double high_volts = 10.0;
  double volts_per_newton = 0.0;  ///< not 0
  /// Output at zero force, at most 0.1 N away from 0 V: at 0 V is a device that was made safe, or
  /// whose station died.
  double zero_volts = 0.0;
  double max_volts = 10.0;          ///< the output's range is +-max_volts
  double full_scale_newtons = 0.0;  ///< measured force at max_volts; 0: unknown
  /// metres_per_volt times volts_per_newton as it was when a push was answered; of another product
  /// nothing is known. 0: never
  double checked = 0.0;
  double residual_m = 0.0;  ///< rms of the fit
  double noise_m = 0.0;     ///< rms of the sensor at rest
};

/// Whether a push has confirmed sign and scale of exactly these gains.
bool isChecked(const SliceCalibration& calibration);

// A push is a force that grows in a straight line, until a slice that was at rest has moved.
constexpr double kRestS = 0.1;   ///< time at rest before the push
constexpr double kRestM = 1e-4;  ///< largest motion within kRestS that counts as rest
constexpr double kPushN = 1.0;   ///< largest force, at the end of the push
constexpr double kMinPushN = 0.1;
constexpr double kPushS = 0.05;   ///< duration of the push
constexpr double kPushM = 0.001;  ///< motion at which it ends earlier, as under too large a gain

/// Response of a slice to a push upwards.
struct Push {
  double newtons = 0.0;  ///< force that is reached after `kPushS`
  double moved_m = 0.0;  ///< motion until the push ended, by the calibration
  double seconds = 0.0;  ///< since the device had the force; 0: it had none, or not to the end
};

/// \param mass_kg  that the push moves
/// \throws Exception if the slice was not at rest, went down, its force was not about that, or the
///         push did not come to its end
/// \return the force that moved it, as it would have been after `kPushS`, N
double judgePush(const Push& push, double mass_kg);

/// Calibrations of the slices of a device, from slice 0 on.
struct Calibration {
  std::vector<SliceCalibration> slices;
};

/// Reads `slices: [{...}, ...]`, see docs/tgr.md. A slice that is absent or `null` is uncalibrated.
/// \throws TextError with file:line:col, value and allowed range
Calibration readCalibration(const std::string& text, const std::string& name);
std::string toYaml(const Calibration& calibration);

/// One measured point of a calibration: position and sensor voltage while the slice is held still.
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
  /// Sets a calibration, with effect from a later exchange, as `uncalibrated` shows: a slice that
  /// had another calibration is without one for that exchange. Thread: command thread
  /// \throws Exception if a slice does not exist or a number is out of range
  virtual void set(int slice, const SliceCalibration& calibration) = 0;
  /// Thread: command thread
  virtual const Calibration& calibration() const noexcept = 0;
  /// Pushes a calibrated slice, soon. Forces of the model end it, and stay. Thread: command thread
  /// \throws Exception if it has no calibration, does not exist, or `newtons` is out of range
  virtual void push(int slice, double newtons) = 0;
  /// Ends the push. Idempotent. Thread: command thread
  virtual void endPush() noexcept = 0;
  /// Result of the last push, returned once. Thread: command thread
  virtual std::optional<Push> takePush() noexcept = 0;
  /// Newest sensor values. \param[out] volts  [slices]. Realtime: yes. Thread: command thread
  virtual void readVolts(double* volts) noexcept = 0;
};

/// \throws Exception if `raw` does not speak volts or a calibration is out of range
std::unique_ptr<CalibratedDriver> makeCalibratedDriver(std::unique_ptr<Driver> raw,
                                                       Calibration calibration);

}  // namespace ergotic::tgr
