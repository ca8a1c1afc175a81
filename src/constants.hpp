// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace ergotic {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;  ///< rad
constexpr double kNsPerS = 1e9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace ergotic
