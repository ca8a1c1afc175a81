// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scene/laws/clipped_cubic.hpp"
#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// The clipped cubic law while e > 0.
struct CubicContact {
  static constexpr Number kNumbers[] = {number::stiffness,
                                        number::damping,
                                        number::gapOffset,
                                        number::nonlinearity,
                                        ClippedCubic::stiffnessLimit,
                                        ClippedCubic::limitDamping,
                                        ClippedCubic::tippingPoint};
  static constexpr std::size_t kOffset = ClippedCubic::kOffset;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(kOffset, l);
    return e > Real(0) ? ClippedCubic::clipped(c, l, e, v) : Force<Real>{};
  }
};

template <class Real>
struct CubicContactCurve : ClippedCurve<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static Real potentialIntegral(const Numbers& n, Real p) noexcept {
    const Real inside = std::min(p, n.tip);
    const Real cube = inside * inside * inside;
    const Real beyond = p - inside;
    return cube * (n.stiffness / Real(6) + n.nonlinearity * inside * inside / Real(20)) +
           beyond * ClippedCurve<Real>::potential(n, inside) +
           n.stiffness_limit * beyond * beyond * (p + Real(2) * inside) / Real(6);
  }
  ERGOTIC_REALTIME static Real curvature(const Numbers& n, Real p) noexcept {
    return p < n.tip ? Real(6) * n.nonlinearity * p : Real(0);
  }
};

constexpr LawWord kWords[] = {
    {"cubic_contact", "stiffness nonlinearity stiffness_limit", "damping threshold"}};
constexpr LiaField kFields[] = {fixedField("stiffness", &Lia::stiffness, "N/m"), dampingField(),
                                fixedField("nonlinearity", &LiaLaw::nonlinearity, "N/m^3"),
                                fixedField("stiffness_limit", &LiaLaw::stiffness_limit, "N/m"),
                                thresholdField()};

}  // namespace

constexpr Law kCubicContactLaw = contactLaw<CubicContact, CubicContactCurve>(
    {"cubic contact", kWords, kFields, Law::Tables::kNone, false}, clippedSlopes, nullptr);

}  // namespace ergotic::scene
