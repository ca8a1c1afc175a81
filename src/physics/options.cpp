// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/options.hpp"

#include "ergotic/exception.hpp"

namespace ergotic::physics {

const char* nameOf(Precision precision) {
  switch (precision) {
    case Precision::kFloat:
      return "float";
    case Precision::kDouble:
      return "double";
    case Precision::kAuto:
      break;
  }
  return "auto";
}

Precision precisionNamed(const std::string& name) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    if (name == nameOf(precision)) {
      return precision;
    }
  }
  throw Exception("precision '" + name + "', allowed: float, double");
}

}  // namespace ergotic::physics
