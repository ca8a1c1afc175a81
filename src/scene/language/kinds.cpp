// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/kinds.hpp"

#include <cmath>
#include <cstdlib>

namespace ergotic::scene {
namespace {

constexpr int kMaxTwelfths = 12 * 100;  // far beyond what anything is measured in

bool isKnown(const Kind& kind) {
  for (const int power : kind.twelfths) {
    if (std::abs(power) > kMaxTwelfths) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<Kind> commonKind(const Kind& one, const Kind& other) {
  if (one == other || other.isBare()) {
    return one;
  }
  return one.isBare() ? std::optional(other) : std::nullopt;
}

std::optional<Kind> productKind(const Kind& kind, const Kind& by, int power) {
  Kind result = kind;
  for (std::size_t i = 0; i < result.twelfths.size(); ++i) {
    result.twelfths[i] += power * by.twelfths[i];
  }
  return isKnown(result) ? std::optional(result) : std::nullopt;
}

std::optional<Kind> powerKind(const Kind& kind, double power) {
  Kind result;
  for (std::size_t i = 0; i < result.twelfths.size(); ++i) {
    const double twelfths = kind.twelfths[i] * power;
    // A third is no binary number.
    if (!(std::abs(twelfths) <= kMaxTwelfths) || std::abs(twelfths - std::round(twelfths)) > 1e-9) {
      return std::nullopt;
    }
    result.twelfths[i] = static_cast<int>(std::lround(twelfths));
  }
  return result;
}

bool isPlainNumber(const Kind& kind) {
  return kind.isBare() || kind == kindOfUnit("rad");
}

std::string nameOf(const Kind& kind) {
  const std::string unit = kind.unit();
  return !unit.empty() ? unit : kind.isBare() ? "a number" : "a power that is not whole";
}

}  // namespace ergotic::scene
