// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/overrides.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {

void checkOverrides(const Overrides& overrides,
                    const std::vector<std::string>& names,
                    const std::string& file) {
  for (const auto& [name, value] : overrides) {
    if (name != kGesturalRateName && std::find(names.begin(), names.end(), name) == names.end()) {
      std::string known;
      for (const std::string& candidate : names) {
        known += candidate + ", ";
      }
      throw Exception(file + ": error: override " + quoted(name) +
                      " is not a parameter, known: " + known + kGesturalRateName);
    }
    if (!std::isfinite(value)) {
      throw Exception(file + ": error: override " + quoted(name) + " = " + numberText(value) +
                      " is not a finite number");
    }
  }
}

double overrideGesturalRate(const Overrides& overrides, double written, const std::string& file) {
  const auto found = overrides.find(kGesturalRateName);
  if (found == overrides.end()) {
    return written;
  }
  if (!kGesturalRateLimits.hold(found->second)) {
    throw Exception(file + ": error: override " +
                    outOfRange(kGesturalRateName, found->second, kGesturalRateLimits));
  }
  return found->second;
}

}  // namespace ergotic::scene
