// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scene/laws/clipped_cubic.hpp"

namespace ergotic::scene {
namespace {

/// The clipped cubic law while e > 0.
struct CubicContact {
  static constexpr std::size_t kNumbers = ClippedCubic::kNumbers;  // threshold in the offset
  static constexpr std::size_t kOffset = ClippedCubic::kOffset;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double rest, double* to) {
    ClippedCubic::convert(scene, lia, units, rest, to);
    to[kOffset] += scene.valueOf(lia.law->width);
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(kOffset, l);
    return e > Real(0) ? ClippedCubic::clipped(c, l, e, v) : Force<Real>{};
  }
};

template <class Real>
struct Curve : ClippedCurve<Real> {
  using Numbers = GuardedLaw<Real>;

  ERGOTIC_REALTIME static Real impulse(const Numbers& n, Real p) noexcept {
    const Real inside = std::min(p, n.tip);
    const Real cube = inside * inside * inside;
    const Real beyond = p - inside;
    return cube * (n.stiffness / Real(6) + n.nonlinearity * inside * inside / Real(20)) +
           beyond * ClippedCurve<Real>::potential(n, inside) +
           n.stiffness_limit * beyond * beyond * (p + Real(2) * inside) / Real(6);
  }
  ERGOTIC_REALTIME static Real bend(const Numbers& n, Real p) noexcept {
    return p < n.tip ? Real(6) * n.nonlinearity * p : Real(0);
  }
};

const GuardedForms& forms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = contactForms<Curve>();
  return kForms;
}

constexpr LawWord kWords[] = {
    {"cubic_contact", "stiffness nonlinearity stiffness_limit", "damping threshold"}};
constexpr LiaField kFields[] = {fixedField("stiffness", &Lia::stiffness, "N/m"), dampingField(),
                                fixedField("nonlinearity", &LiaLaw::nonlinearity, "N/m^3"),
                                fixedField("stiffness_limit", &LiaLaw::stiffness_limit, "N/m"),
                                thresholdField()};

}  // namespace

constexpr Law kCubicContactLaw = {
    "cubic contact",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kGap,
    explicitFormOf<CubicContact>(),
    forms,
    guardable,
    false,  // has_linear_part
    true,   // switches
    false,  // is_held
    never,
    clippedSlopes,
    nullptr,  // growth
    nullptr,  // friction
    noStiffness,
};

}  // namespace ergotic::scene
