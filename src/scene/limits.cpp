// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <array>
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

namespace {

std::vector<LiaField> makeLiaFields(LiaType type) {
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
      {"nonlinearity", &LiaLaw::nonlinearity, nonlinearity},
      {"stiffness_limit", &LiaLaw::stiffness_limit, kStiffnessLimits},
  };
  switch (type) {
    case LiaType::kPowerContact:
      fields.push_back({"exponent", &LiaLaw::exponent, kExponentLimits});
      [[fallthrough]];
    case LiaType::kContact:
    case LiaType::kCubicContact:
      fields.push_back({"threshold", &LiaLaw::width, kMetreLimits});
      break;
    case LiaType::kPluck:
      fields.push_back({"width", &LiaLaw::width, {"m", 0.0, kInfinity, true}});
      break;
    case LiaType::kBow:
    case LiaType::kSmoothBow:
      fields.push_back({"width", &LiaLaw::width, {"m/s", 0.0, kInfinity, true}});
      break;
    case LiaType::kConditional:
      fields.push_back({"engage", &LiaLaw::width, {"m", 0.0, kInfinity, true}});
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

}  // namespace

const std::vector<LiaField>& liaFields(LiaType type) {
  static const auto kFields = [] {
    std::array<std::vector<LiaField>, kLiaTypes> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = makeLiaFields(static_cast<LiaType>(i));
    }
    return all;
  }();
  return kFields[static_cast<std::size_t>(type)];
}

const Value& memberOf(const Lia& lia, LiaMember member) {
  const auto* const own = std::get_if<Value Lia::*>(&member);
  return own != nullptr ? lia.*(*own) : (*lia.law).*(std::get<Value LiaLaw::*>(member));
}

void setMember(Lia& lia, LiaMember member, const Value& value) {
  const auto* const own = std::get_if<Value Lia::*>(&member);
  (own != nullptr ? lia.*(*own) : lia.law.edit().*(std::get<Value LiaLaw::*>(member))) = value;
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
