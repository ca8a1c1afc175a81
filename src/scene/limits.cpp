// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <cmath>
#include <cstdio>

namespace ergotic::scene {

bool Limits::hold(double value) const {
  return std::abs(value) <= kLargestNumber && value <= maximum &&
         (above ? value > minimum : value >= minimum);
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
         (std::abs(value) > kLargestNumber ? ", up to 1e30 in size" : "");
}

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

}  // namespace ergotic::scene
