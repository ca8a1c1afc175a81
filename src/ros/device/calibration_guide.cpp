// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/calibration_guide.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

constexpr double kFarthestM = 1.0;
const char kSampling[] = "a sample is under way: wait for its answer";

tgr::CalibrationPoint pointOf(double position_m, const std::vector<double>& volts) {
  const auto count = static_cast<double>(volts.size());
  tgr::CalibrationPoint point;
  point.position_m = position_m;
  point.mean_volts = std::accumulate(volts.begin(), volts.end(), 0.0) / count;
  double squares = 0.0;
  for (const double v : volts) {
    squares += (v - point.mean_volts) * (v - point.mean_volts);
  }
  point.rms_volts = std::sqrt(squares / count);
  return point;
}

}  // namespace

void CalibrationGuide::begin(const std::vector<tgr::DriverStack::Part>& raw_parts,
                             int slices,
                             int slice) {
  if (isUnderWay()) {
    throw Exception("slice " + std::to_string(part_->first_slice + slice_) +
                    " is being calibrated: finish or abort first");
  }
  const auto holds = [slice](const tgr::DriverStack::Part& part) {
    return slice >= part.first_slice && slice < part.first_slice + part.calibrated->slices();
  };
  const auto found = std::find_if(raw_parts.begin(), raw_parts.end(), holds);
  if (found == raw_parts.end()) {
    const bool exists = slice >= 0 && slice < slices;
    throw Exception("slice " + std::to_string(slice) +
                    (exists ? " needs no calibration: its device speaks metres"
                            : " does not exist, allowed: 0..." + std::to_string(slices - 1)));
  }
  part_ = *found;
  slice_ = slice - found->first_slice;
  points_.clear();
  sampling_ = false;
  pushing_ = false;
}

const tgr::SliceCalibration& CalibrationGuide::now() const {
  return part_->calibrated->calibration().slices[static_cast<std::size_t>(slice_)];
}

void CalibrationGuide::push(double newtons) {
  requireUnderWay();
  try {
    if (now().full_scale_newtons == 0.0) {
      throw Exception("full_scale_newtons of slice " + std::to_string(part_->first_slice + slice_) +
                      " is not in the device file, allowed: the force that max_volts really give");
    }
    part_->calibrated->push(slice_, newtons);
  } catch (const Exception&) {
    abort();
    throw;
  }
  pushing_ = true;
}

std::optional<double> CalibrationGuide::pollPush(double mass_kg) {
  const auto push = pushing_ ? part_->calibrated->takePush() : std::nullopt;
  if (!push) {
    return std::nullopt;
  }
  tgr::CalibratedDriver& driver = *part_->calibrated;
  tgr::SliceCalibration checked = now();
  const int slice = slice_;
  abort();
  checked.checked = 0.0;
  driver.set(slice, checked);  // unless it answers well
  const double force = tgr::judgePush(*push, mass_kg);
  checked.checked = checked.metres_per_volt * checked.volts_per_newton;
  driver.set(slice, checked);
  return force;
}

void CalibrationGuide::abort() {
  if (pushing_) {
    part_->calibrated->endPush();
  }
  pushing_ = false;
  part_.reset();
}

void CalibrationGuide::sample(double position_m) {
  requireUnderWay();
  if (sampling_) {
    throw Exception(kSampling);
  }
  if (!(std::abs(position_m) <= kFarthestM)) {
    throw Exception("position is " + std::to_string(position_m) + " m, allowed: -1...1");
  }
  position_m_ = position_m;
  readings_.clear();
  sampling_ = true;
}

std::optional<tgr::CalibrationPoint> CalibrationGuide::poll() {
  if (!isUnderWay() || !sampling_) {
    return std::nullopt;
  }
  std::array<double, tgr::kMaxSlices> volts{};
  part_->calibrated->readVolts(volts.data());
  readings_.push_back(volts[static_cast<std::size_t>(slice_)]);
  if (readings_.size() < std::size_t{kReadings}) {
    return std::nullopt;
  }
  sampling_ = false;
  points_.push_back(pointOf(position_m_, readings_));
  return points_.back();
}

tgr::SliceCalibration CalibrationGuide::finish(double max_residual_m, double volts_per_newton) {
  requireUnderWay();
  if (sampling_) {
    throw Exception(kSampling);
  }
  const auto& slices = part_->calibrated->calibration().slices;
  const auto index = static_cast<std::size_t>(slice_);
  tgr::SliceCalibration from = index < slices.size() ? slices[index] : tgr::SliceCalibration();
  if (volts_per_newton != 0.0) {
    from.volts_per_newton = volts_per_newton;
  }
  const tgr::SliceCalibration fitted = tgr::fit(points_, from, max_residual_m);
  part_->calibrated->set(slice_, fitted);
  part_.reset();
  return fitted;
}

void CalibrationGuide::requireUnderWay() const {
  if (!isUnderWay() || pushing_) {
    throw Exception("nothing is being calibrated: begin first");
  }
}

}  // namespace ergotic::node
