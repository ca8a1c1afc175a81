// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/tgr/calibration.hpp"
#include "scene/limits.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {

constexpr scene::Limits kVoltsLimits{"V", -1000.0, 1000.0};
constexpr scene::Limits kMaxVoltsLimits{"V", 0.0, 1000.0, true};
constexpr scene::Limits kMetresPerVoltLimits{"m/V", -10.0, 10.0};
constexpr scene::Limits kVoltsPerNewtonLimits{"V/N", -100.0, 100.0};
constexpr scene::Limits kFullScaleLimits{"N", 0.0, 1000.0};
constexpr scene::Limits kCheckedLimits{"m/N", -1000.0, 1000.0};
constexpr scene::Limits kErrorLimits{"m", 0.0, 1.0};

/// Largest force at zero volts. A device is at zero volts when it is made safe, when its station
/// dies, and when its power fails, whatever its calibration says.
constexpr double kMaxForceAtZeroVoltsN = 0.1;

/// \param of  text after the name of a number, as in ` of slice 3`
/// \throws Exception naming number and allowed range, if the numbers do not fit together
void checkCalibration(const SliceCalibration& calibration, const std::string& of);

/// Reads one slice. \param what  for messages. \throws TextError
SliceCalibration readSliceCalibration(const Settings& settings,
                                      const scene::Node& node,
                                      const std::string& what,
                                      scene::Place fallback);

/// Reads a list of slices. \throws TextError
std::vector<SliceCalibration> readSliceCalibrations(const Settings& settings,
                                                    const scene::Node& list,
                                                    scene::Place place);

/// The list alone, on one line.
std::string sliceCalibrationsText(const Calibration& calibration);

}  // namespace ergotic::tgr
