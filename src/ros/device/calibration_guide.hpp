// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ergotic/tgr/device.hpp"

namespace ergotic::node {

/// Guides the operator of a device through the calibration of one slice: pairs of a position, given
/// by the operator, and the sensor value, read here.
/// Thread: command thread. Realtime: no
class CalibrationGuide {
 public:
  static constexpr int kReadings = 100;  ///< readings per sample, one per `poll`
  static constexpr double kUsualResidualM = 1e-4;

  /// \param raw_parts  the devices that speak volts
  /// \param slices     of all devices
  /// \param slice      counted over all devices
  /// \throws Exception if a calibration is under way, or the slice needs none or does not exist
  void begin(const std::vector<tgr::DriverStack::Part>& raw_parts, int slices, int slice);
  /// Starts to read the sensor. \throws Exception if nothing is being calibrated, a sample is under
  /// way, or the position is not within +-1 m
  void sample(double position_m);
  /// Reads the sensor once, if a sample is under way. \return the sample when it is complete
  std::optional<tgr::CalibrationPoint> poll();
  /// Fits a line through the samples; the device uses it from now on. The calibration is over then.
  /// \param volts_per_newton  of the slice's amplifier; 0: as it was
  /// \throws Exception from `tgr::fit`: the calibration goes on
  tgr::SliceCalibration finish(double max_residual_m, double volts_per_newton);
  /// Pushes the slice, which must be free, after `begin`. \param newtons  at most
  /// \throws Exception if it has no calibration, its full scale is not stated, or samples were
  ///         taken. Nothing is under way then
  void push(double newtons);
  /// \return once a push is over: the force that answered, N. The calibration is over then.
  /// \throws Exception if sign or scale are wrong
  std::optional<double> pollPush(double mass_kg);

  /// The calibration is over, nothing has changed, nothing is pushed. Idempotent
  void abort();

  bool isUnderWay() const { return part_.has_value(); }
  bool isPushing() const { return pushing_; }
  std::size_t samples() const { return points_.size(); }

 private:
  void requireUnderWay() const;
  const tgr::SliceCalibration& now() const;

  std::optional<tgr::DriverStack::Part> part_;  // whose slice it is
  int slice_ = 0;                               // within the part
  std::vector<tgr::CalibrationPoint> points_;
  std::vector<double> readings_;  // V, of the sample under way
  bool sampling_ = false;
  bool pushing_ = false;
  double position_m_ = 0.0;
};

}  // namespace ergotic::node
