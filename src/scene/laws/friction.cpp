// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/friction.hpp"

#include <cmath>
#include <string>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// mu over the slip.
template <class Real>
struct FrictionCurve {
  ERGOTIC_REALTIME static EnergyStableForce<Real> slip(const EnergyStableLaw<Real>& n,
                                                       Real v) noexcept {
    if (!n.viscous.empty()) {
      const EnergyStableForce<Real> at = n.viscous.at(v * n.per_step);
      return {at.force, at.slope * n.per_step};
    }
    EnergyStableForce<Real> mu{n.steady, Real(0)};
    for (int i = 0; i < 2; ++i) {
      const Real part = n.share[i] * std::exp(-v * n.per_width[i]);
      mu.force += part;
      mu.slope -= part * n.per_width[i];
    }
    return mu;
  }
};

template <class Real>
constexpr EnergyStableForm<Real> form() {
  EnergyStableForm<Real> form = frictionForm<FrictionCurve<Real>, Real>();
  form.sort = EnergyStableForm<Real>::Sort::kDry;
  return form;
}

const EnergyStableForms& forms(const Lia& /*lia*/) {
  static constexpr EnergyStableForms kForms = {form<float>(), form<double>()};
  return kForms;
}

void convertNothing(const LinkInSteps& /*link*/, double* /*to*/) {}

Slopes noSlopes(const Scene& /*scene*/, const Lia& /*lia*/) {
  return {};
}

/// At rest its force is whatever it takes.
FrictionSlopes friction(const Scene& /*scene*/, const Lia& /*lia*/) {
  return {kInfinity, 0.0};
}

constexpr LawWord kWords[] = {{"friction", "normal", "table steady parts"}};
constexpr LiaField kFields[] = {{"normal", &LiaLaw::normal, {"N", 0.0}}};

}  // namespace

std::string coefficientFault(const Table& table) {
  const auto& points = table.points;
  if (table.smooth) {
    return "is smooth, allowed: interpolation: linear";
  }
  if (points.empty() || points.front().first != 0.0) {
    return "does not begin at a slip of 0, allowed: 0 m/s first";
  }
  double last_slope = -kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [v, mu] = points[i];
    if (!kFrictionLimits.hold(mu)) {
      return outOfRange("has a coefficient", mu, kFrictionLimits);
    }
    if (i > 0) {
      const double slope = (mu - points[i - 1].second) / (v - points[i - 1].first);
      if (slope < last_slope - 1e-9 * std::abs(last_slope)) {
        return "falls faster beyond " + numberText(points[i - 1].first) +
               " m/s than before it, allowed: slopes that never fall";
      }
      last_slope = slope;
    }
  }
  return "";
}

constexpr Law kFrictionLaw = {
    {"friction", kWords, kFields, Law::Tables::kCoefficient, false},
    Law::Kind::kFriction,
    {0, 0, 0, convertNothing, nullptr, nullptr},
    forms,
    guardable,
    false,   // has_linear_part
    false,   // switches
    false,   // is_held
    always,  // canGive
    never,   // givesForEver
    noSlopes,
    nullptr,  // growth
    friction,
    never,  // onlyBrakes
    noStiffness,
};

}  // namespace ergotic::scene
