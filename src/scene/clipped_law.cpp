// SPDX-License-Identifier: BSD-3-Clause
#include "scene/clipped_law.hpp"

#include <cmath>

namespace ergotic::scene {

void completeClippedLaw(Lia& lia, ClippedLaw law) {
  const bool contact = lia.type == LiaType::kCubicContact;
  if (lia.type != LiaType::kClippedCubic && !contact) {
    return;
  }
  const double k = lia.stiffness.factor;
  const double q = lia.law->nonlinearity.factor;
  const double limit = lia.law->stiffness_limit.factor;
  if (q == 0.0 || k >= limit) {
    lia.type = contact ? LiaType::kContact : LiaType::kSpringDamper;
    lia.stiffness = q == 0.0 ? lia.stiffness : lia.law->stiffness_limit;
    lia.law.edit().nonlinearity = {};
    lia.law.edit().stiffness_limit = {};
    return;
  }
  if (law == ClippedLaw::kMdl) {
    lia.law.edit().tipping_point = std::sqrt(limit - k) / q;
    lia.law.edit().limit_damping = 0.3 * lia.law->stiffness_limit;
  } else {
    lia.law.edit().tipping_point = std::sqrt((limit - k) / q);
  }
}

}  // namespace ergotic::scene
