// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/clipped_cubic.hpp"

#include <algorithm>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

double leastStiffness(const Scene& scene, const Lia& lia) {
  return std::min(rangeOf(scene, lia.stiffness).lowest,
                  rangeOf(scene, lia.law->stiffness_limit).lowest);
}

constexpr LawWord kWords[] = {
    {"clipped_cubic", "stiffness nonlinearity stiffness_limit", "damping rest_length"}};
constexpr LiaField kFields[] = {fixedField("stiffness", &Lia::stiffness, "N/m"), dampingField(),
                                fixedField("nonlinearity", &LiaLaw::nonlinearity, "N/m^3"),
                                fixedField("stiffness_limit", &LiaLaw::stiffness_limit, "N/m")};

}  // namespace

void completeClippedLaw(Lia& lia, ClippedLaw law) {
  const bool contact = lia.type == LiaType::kCubicContact;
  if (lia.type != LiaType::kClippedCubic && !contact) {
    return;
  }
  const double k = lia.stiffness.factor;
  const double q = lia.law->nonlinearity.factor;
  const double limit = lia.law->stiffness_limit.factor;
  if (q == 0.0 || k >= limit) {
    const bool keeps_stiffness = q == 0.0 || (law == ClippedLaw::kMiGen && contact);
    lia.type = contact ? LiaType::kContact : LiaType::kSpringDamper;
    lia.stiffness = keeps_stiffness ? lia.stiffness : lia.law->stiffness_limit;
    lia.law.edit().nonlinearity = {};
    lia.law.edit().stiffness_limit = {};
    return;
  }
  const bool is_faust = law == ClippedLaw::kFaust;
  lia.law.edit().tipping_point = is_faust ? std::sqrt(limit - k) / q : std::sqrt((limit - k) / q);
  if (is_faust || (law == ClippedLaw::kMiGen && !contact)) {
    lia.law.edit().limit_damping = 0.3 * lia.law->stiffness_limit;
  }
}

template <class Real>
ERGOTIC_REALTIME EnergyStableForce<Real> ClippedCurve<Real>::push(const Numbers& n,
                                                                  Real p) noexcept {
  if (std::abs(p) > n.tip) {
    return {n.stiffness_limit * p, n.stiffness_limit};
  }
  return {p * (n.stiffness + n.nonlinearity * p * p),
          n.stiffness + Real(3) * n.nonlinearity * p * p};
}

template <class Real>
ERGOTIC_REALTIME Real ClippedCurve<Real>::potential(const Numbers& n, Real p) noexcept {
  const Real inside = std::min(std::abs(p), n.tip);
  const Real square = inside * inside;
  return square * (n.stiffness + n.nonlinearity * square / Real(2)) / Real(2) +
         n.stiffness_limit * (p * p - square) / Real(2);
}

template <class Real>
ERGOTIC_REALTIME Real ClippedCurve<Real>::damping(const Numbers& n, Real p, Real) noexcept {
  return std::max(Real(0), std::abs(p) > n.tip ? n.limit_damping : n.damping);
}

template struct ClippedCurve<float>;
template struct ClippedCurve<double>;

Slopes clippedSlopes(const Scene& scene, const Lia& lia) {
  const double tip = lia.law->tipping_point;
  const double stiffness = std::max(
      largest(scene, lia.stiffness) + 3.0 * largest(scene, lia.law->nonlinearity) * tip * tip,
      largest(scene, lia.law->stiffness_limit));
  return slopesUpTo(stiffness,
                    largest(scene, lia.damping) + largest(scene, lia.law->limit_damping));
}

constexpr Law kClippedCubicLaw = springLaw<ClippedCubic, ClippedCurve>(
    {"clipped cubic spring", kWords, kFields, Law::Tables::kNone, false},
    true,
    clippedSlopes,
    nullptr,
    leastStiffness);

}  // namespace ergotic::scene
