// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/exception.hpp"
#include "tgr/calibration_rules.hpp"

namespace ergotic::tgr {
namespace {

using scene::Limits;
using scene::numberText;

void require(const std::string& what, double value, const Limits& limits) {
  if (!limits.hold(value)) {
    throw Exception(scene::outOfRange(what, value, limits));
  }
}

void requirePlaces(const std::vector<CalibrationPoint>& points, const SliceCalibration& from) {
  if (points.size() < 2) {
    throw Exception(std::to_string(points.size()) +
                    " positions to calibrate from, allowed: two or more, as far apart as can be");
  }
  for (const CalibrationPoint& point : points) {
    require("position of a place", point.position_m, {"m", -1.0, 1.0});
    require("mean of the sensor at " + numberText(point.position_m) + " m", point.mean_volts,
            kVoltsLimits);
    require("rms of the sensor at " + numberText(point.position_m) + " m", point.rms_volts,
            {"V", 0.0});
    if (point.mean_volts <= from.low_volts || point.mean_volts >= from.high_volts) {
      throw Exception("the sensor is at its rail at " + numberText(point.position_m) +
                      " m: " + numberText(point.mean_volts) + " V, allowed: between " +
                      numberText(from.low_volts) + " and " + numberText(from.high_volts) + " V");
    }
  }
}

/// Sums about the means: what a straight line is made of.
struct Line {
  double mean_volts = 0.0;
  double mean_position = 0.0;
  double volts_squared = 0.0;
  double product = 0.0;
};

Line sums(const std::vector<CalibrationPoint>& points) {
  Line line;
  const auto count = static_cast<double>(points.size());
  for (const CalibrationPoint& point : points) {
    line.mean_volts += point.mean_volts / count;
    line.mean_position += point.position_m / count;
  }
  for (const CalibrationPoint& point : points) {
    const double volts = point.mean_volts - line.mean_volts;
    line.volts_squared += volts * volts;
    line.product += volts * (point.position_m - line.mean_position);
  }
  return line;
}

double meanSquareNoise(const std::vector<CalibrationPoint>& points) {
  double sum = 0.0;
  for (const CalibrationPoint& point : points) {
    sum += point.rms_volts * point.rms_volts;
  }
  return sum / static_cast<double>(points.size());
}

void requireStroke(const std::vector<CalibrationPoint>& points) {
  const auto by = [&](auto member) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [&](const auto& a, const auto& b) { return a.*member < b.*member; });
    return (*high).*member - (*low).*member;
  };
  constexpr double kShortestM = 1e-3;
  const double stroke = by(&CalibrationPoint::position_m);
  if (stroke < kShortestM) {
    throw Exception("the places are within " + numberText(stroke) + " m, allowed: at least " +
                    numberText(kShortestM) + " m apart");
  }
  // Noise adds to itself over the stroke, so that a line through less than this is no line.
  constexpr double kMaxNoise = 0.1;
  const double volts = by(&CalibrationPoint::mean_volts);
  const double noise = std::sqrt(meanSquareNoise(points));
  constexpr double kMinVolts = 1e-3;
  if (volts < kMinVolts) {
    throw Exception(
        "the slice was not moved, or its sensor is not connected: " + numberText(volts) +
        " V between the places, allowed: at least " + numberText(kMinVolts) + " V");
  }
  if (noise > kMaxNoise * volts) {
    throw Exception("the sensor's noise of " + numberText(noise) +
                    " V rms is too large for a stroke of " + numberText(volts) +
                    " V, allowed: at most a tenth of it");
  }
}

}  // namespace

namespace {

/// The gain and what was measured at full scale say the same thing twice.
void requireFullScale(const SliceCalibration& c, const std::string& of) {
  require("full_scale_newtons" + of, c.full_scale_newtons, kFullScaleLimits);
  if (c.full_scale_newtons == 0.0 || c.volts_per_newton == 0.0) {
    return;
  }
  constexpr double kMaxApart = 1.1;
  const double by_gain = c.max_volts / std::abs(c.volts_per_newton);
  if (by_gain > kMaxApart * c.full_scale_newtons || by_gain < c.full_scale_newtons / kMaxApart) {
    throw Exception("max_volts = " + numberText(c.max_volts) +
                    " V and volts_per_newton = " + numberText(c.volts_per_newton) + " V/N" + of +
                    " make " + numberText(by_gain) + " N of full scale, full_scale_newtons says " +
                    numberText(c.full_scale_newtons) + " N, allowed: the same within a tenth");
  }
}

}  // namespace

void checkCalibration(const SliceCalibration& c, const std::string& of) {
  require("low_volts" + of, c.low_volts, kVoltsLimits);
  require("high_volts" + of, c.high_volts, {"V", c.low_volts, kVoltsLimits.maximum, true});
  require("max_volts" + of, c.max_volts, kMaxVoltsLimits);
  require("zero_volts" + of, c.zero_volts, {"V", -c.max_volts, c.max_volts});
  require("metres_per_volt" + of, c.metres_per_volt, kMetresPerVoltLimits);
  require("volts_per_newton" + of, c.volts_per_newton, kVoltsPerNewtonLimits);
  requireFullScale(c, of);
  require("checked" + of, c.checked, kCheckedLimits);
  require("residual_m" + of, c.residual_m, kErrorLimits);
  require("noise_m" + of, c.noise_m, kErrorLimits);
  require("zero_volts" + of, c.zero_volts,
          {"V", -std::abs(c.volts_per_newton) * kMaxForceAtZeroVoltsN,
           std::abs(c.volts_per_newton) * kMaxForceAtZeroVoltsN});
  if (!c.is_calibrated) {
    return;
  }
  require("rest_volts" + of, c.rest_volts, {"V", c.low_volts, c.high_volts});
  if (c.metres_per_volt == 0.0 || c.volts_per_newton == 0.0) {
    throw Exception("metres_per_volt = " + numberText(c.metres_per_volt) +
                    " and volts_per_newton = " + numberText(c.volts_per_newton) + of +
                    ", allowed: neither is 0 in a slice that is calibrated");
  }
}

bool isChecked(const SliceCalibration& c) {
  constexpr double kRounding = 1e-6;
  const double now = c.metres_per_volt * c.volts_per_newton;
  return c.is_calibrated && std::abs(c.checked - now) <= kRounding * std::abs(now);
}

double judgePush(const Push& push, double mass_kg) {
  // A hand, friction and other masses than was said: what counts is a factor of ten.
  constexpr double kMin = 0.2;
  constexpr double kMax = 4.0;
  if (push.seconds == 0.0 && push.moved_m != 0.0) {
    throw Exception("the slice moved by " + numberText(1e3 * push.moved_m) +
                    " mm before it was pushed, allowed: at most " + numberText(1e3 * kRestM) +
                    " mm in " + numberText(kRestS) + " s: hands off, and wait until it rests");
  }
  if (!(push.seconds > 0.0)) {
    throw Exception(
        "the push was ended before it told anything: force was taken away or let out, the device is"
        " lost, or the sensor is at its rail");
  }
  const double force = 6.0 * mass_kg * kPushS * push.moved_m / std::pow(push.seconds, 3);
  const std::string what = "a push of up to " + numberText(push.newtons) +
                           " N moved the slice by " + numberText(1e3 * push.moved_m) + " mm in " +
                           numberText(1e3 * push.seconds) + " ms, as one of " + numberText(force) +
                           " N would: ";
  if (force < -kMin * push.newtons) {
    throw Exception(what + "the sign of volts_per_newton or of metres_per_volt is wrong");
  }
  if (!(force >= kMin * push.newtons && force <= kMax * push.newtons)) {
    throw Exception(what +
                    "volts_per_newton is wrong, or a hand holds the slice, or the amplifier is"
                    " off, allowed: " +
                    numberText(kMin * push.newtons) + "..." + numberText(kMax * push.newtons) +
                    " N");
  }
  return force;
}

SliceCalibration fit(const std::vector<CalibrationPoint>& points,
                     const SliceCalibration& from,
                     double max_residual_m) {
  requirePlaces(points, from);
  requireStroke(points);
  const Line line = sums(points);
  SliceCalibration result = from;
  result.is_calibrated = true;
  result.metres_per_volt = line.product / line.volts_squared;
  result.rest_volts = line.mean_volts - line.mean_position / result.metres_per_volt;
  double squares = 0.0;
  for (const CalibrationPoint& point : points) {
    const double error =
        point.position_m - result.metres_per_volt * (point.mean_volts - result.rest_volts);
    squares += error * error;
  }
  result.residual_m = std::sqrt(squares / static_cast<double>(points.size()));
  result.noise_m = std::sqrt(meanSquareNoise(points)) * std::abs(result.metres_per_volt);
  if (!(result.residual_m <= max_residual_m)) {
    throw Exception(
        "the readings of the sensor do not lie on a straight line over the positions: residual " +
        numberText(result.residual_m) + " m rms, allowed: at most " + numberText(max_residual_m) +
        " m");
  }
  checkCalibration(result, "");
  return result;
}

}  // namespace ergotic::tgr
