// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <cmath>
#include <cstdio>

namespace ergotic::scene {

namespace {

bool isTooLarge(double value) {
  return std::abs(value) > kLargestNumber;
}

/// True if a quantity with a unit that must not be 0 is too small: its inverse is needed.
bool isTooSmall(double value, const Limits& limits) {
  return *limits.unit != '\0' && limits.above && limits.minimum == 0.0 && value > 0.0 &&
         value < kSmallestNumber;
}

}  // namespace

bool Limits::hold(double value) const {
  return std::isfinite(value) && !isTooLarge(value) && !isTooSmall(value, *this) &&
         value <= maximum && (above ? value > minimum : value >= minimum);
}

std::string Limits::text(bool with_unit) const {
  const std::string suffix = with_unit && *unit != '\0' ? std::string(" ") + unit : "";
  if (maximum < kInfinity) {
    return (above ? "above " : "") + numberText(minimum) + "..." + numberText(maximum) + suffix;
  }
  if (minimum > -kInfinity) {
    return (above ? "> " : ">= ") + numberText(minimum) + suffix;
  }
  return "any finite number" + (suffix.empty() ? "" : " of" + suffix);
}

std::string outOfRange(const std::string& what,
                       double value,
                       const Limits& limits,
                       bool with_unit) {
  const std::string unit = with_unit && *limits.unit != '\0' ? std::string(" ") + limits.unit : "";
  return what + " = " + numberText(value) + unit +
         " is out of range, allowed: " + limits.text(with_unit) +
         (isTooLarge(value) ? ", up to 1e30 in size" : "") +
         (isTooSmall(value, limits) ? ", at least 1e-30" : "");
}

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

}  // namespace ergotic::scene
