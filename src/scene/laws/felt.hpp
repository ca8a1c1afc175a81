// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/laws/power_contact.hpp"

namespace ergotic::scene {

/// Contact with losses of its material, f = K e^a (1 + c v) while e > 0, v the rate at which it
/// closes; it never pulls. What comes back of an impact depends on its speed and c alone.
/// Source: Hunt and Crossley 1975, J. Appl. Mech. 42(2).
struct Felt {
  /// `damping` is c.
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::gapOffset,
                                        number::exponent};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    if (!(e > Real(0))) {
      return {};
    }
    const Real elastic = c(0, l) * std::pow(e, c(3, l));
    return {elastic, std::max(c(1, l) * v, Real(-1)) * elastic};
  }
};

/// Ratio of the speeds after and before an impact, u = c v before it:
/// u - log(1 + u) = -x - log(1 - x) with x that after it. Realtime: yes
double feltRestitution(double u) noexcept;

}  // namespace ergotic::scene
