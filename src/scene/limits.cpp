// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <cmath>
#include <cstdio>

namespace ergotic::scene {

bool Limits::hold(double value) const {
  return std::isfinite(value) && value <= maximum && (above ? value > minimum : value >= minimum);
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

std::vector<LiaField> liaFields(LiaType type) {
  // A clipped cubic law has a tipping point only if it gets stiffer on the way there.
  const bool clipped = type == LiaType::kClippedCubic || type == LiaType::kCubicContact;
  const Limits nonlinearity{type == LiaType::kQuadratic ? "N/m^2" : "N/m^3",
                            clipped ? 0.0 : -kInfinity};
  // Of a linear link any stiffness and damping may be asked for: the certificate judges the whole.
  const double least = type == LiaType::kSpringDamper ? -kInfinity : 0.0;
  const bool power = type == LiaType::kPowerContact;
  std::vector<LiaField> fields = {
      {"stiffness", &Lia::stiffness, {power ? "N/m^exponent" : "N/m", least}},
      {"damping", &Lia::damping, {"N s/m", least}},
      {"nonlinearity", &Lia::nonlinearity, nonlinearity},
      {"stiffness_limit", &Lia::stiffness_limit, kStiffnessLimits},
  };
  switch (type) {
    case LiaType::kPowerContact:
      fields.push_back({"exponent", &Lia::exponent, kExponentLimits});
      [[fallthrough]];
    case LiaType::kContact:
    case LiaType::kCubicContact:
      fields.push_back({"threshold", &Lia::width, kMetreLimits});
      break;
    case LiaType::kPluck:
      fields.push_back({"width", &Lia::width, {"m", 0.0, kInfinity, true}});
      break;
    case LiaType::kBow:
    case LiaType::kSmoothBow:
      fields.push_back({"width", &Lia::width, {"m/s", 0.0, kInfinity, true}});
      break;
    case LiaType::kConditional:
      fields.push_back({"engage", &Lia::width, {"m", 0.0, kInfinity, true}});
      break;
    case LiaType::kTable:
    case LiaType::kSpringDamper:
    case LiaType::kQuadratic:
    case LiaType::kCubic:
    case LiaType::kClippedCubic:
      break;
  }
  return fields;
}

std::string outOfRange(const std::string& what,
                       double value,
                       const Limits& limits,
                       bool with_unit) {
  const std::string unit = with_unit && *limits.unit != '\0' ? std::string(" ") + limits.unit : "";
  return what + " = " + numberText(value) + unit +
         " is out of range, allowed: " + limits.text(with_unit);
}

std::string numberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

}  // namespace ergotic::scene
