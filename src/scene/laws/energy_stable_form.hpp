// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "ergotic/rt/realtime.hpp"
#include "ergotic/scene/scene.hpp"
#include "ergotic/scene/table.hpp"
#include "scene/laws/units.hpp"

namespace ergotic::scene {

template <class Real>
struct EnergyStableForce {
  Real force = Real(0);
  Real slope = Real(0);
};

/// A table as pieces of polynomials with its integral, and a straight line beside it. A default one
/// is 0 everywhere.
template <class Real>
class EnergyStableCurve {
 public:
  EnergyStableCurve() = default;
  /// \param holds  beyond its ends it keeps its last value; otherwise it is 0 there
  EnergyStableCurve(const Curve& curve, bool holds);
  /// \param at_0, slope  of a line, which goes on beyond the ends of the curve; that may be empty
  EnergyStableCurve(const Curve& curve, double at_0, double slope);

  bool empty() const noexcept { return pieces_.empty(); }
  /// Realtime: yes. Cost: O(log pieces)
  EnergyStableForce<Real> at(Real x) const noexcept;
  /// Integral over x, at its lowest 0 if it has a lowest value. Realtime: yes. O(log pieces)
  Real potential(Real x) const noexcept;
  Real steepest() const noexcept { return steepest_; }  ///< the largest slope between its ends

 private:
  struct Piece {
    Real begin, c0, c1, c2, c3;
    Real potential;  // at begin
  };
  static Real integral(const Piece& piece, Real u) noexcept;
  const Piece& pieceOf(Real x) const noexcept;
  void sinkToFloor();

  std::vector<Piece> pieces_;
  Real end_ = Real(0);
  Real end_value_ = Real(0);
  Real beyond_ = Real(0);  // slope, where it holds on
  Real steepest_ = Real(0);
  bool holds_ = true;
};

template <class Real>
struct EnergyStableLaw;

/// How a law is worked out in the energy-stable scheme: of `Real` numbers. Elastic laws give the
/// force f(p) over compression (contacts) or elongation p; friction laws give the force F(v) over
/// the slip v, m per step. What a sort does not need is null.
template <class Real>
struct EnergyStableForm {
  enum class Sort {
    kContact,   ///< pushes while p > 0 and lets go beyond
    kSpring,    ///< two-sided
    kFriction,  ///< over velocity alone
    kDry,       ///< friction per normal force, which sticks
  };
  using Number = Real (*)(const EnergyStableLaw<Real>&, Real) noexcept;
  using ForceAt = EnergyStableForce<Real> (*)(const EnergyStableLaw<Real>&, Real) noexcept;

  Sort sort;
  ForceAt push;               ///< f(p) and f'(p)
  Number potential;           ///< integral of f from 0 to p; springs with a well: from its bottom
  Number potential_integral;  ///< contacts: integral of the potential from 0 to p > 0
  Number curvature;           ///< contacts: f''(p)
  /// Z >= 0 at p; v is the velocity of p per step.
  Real (*damping)(const EnergyStableLaw<Real>&, Real p, Real v) noexcept;
  ForceAt slip;  ///< F(v) and F'(v) of friction; dry: mu(v) and mu'(v), v >= 0
  /// Springs that let go: what they remember at p, of what they did; above 0 they hold, from there
  /// to 0 they let go. Null: they always hold.
  Real (*phase)(const EnergyStableLaw<Real>&, Real p, Real last) noexcept;
  Real (*snap)(const EnergyStableLaw<Real>&) noexcept;  ///< what they lose where they let go
  /// Contacts: ratio of the speeds after and before an impact at `speed` per step with the damping
  /// z and the slope of the moment. `give`: opening per force.
  Real (*restitution)(
      const EnergyStableLaw<Real>&, Real z, Real slope, Real give, Real speed) noexcept;
  bool is_lossy;  ///< contacts: f (1 + damping v) is the law, and it never pulls
};

struct EnergyStableForms {
  EnergyStableForm<float> single_form;
  EnergyStableForm<double> double_form;

  template <class Real>
  const EnergyStableForm<Real>& get() const noexcept {
    if constexpr (sizeof(Real) == sizeof(float)) {
      return single_form;
    } else {
      return double_form;
    }
  }
};

/// The law of one energy-stable link: numbers of one step, and its tables. Damping is force per m
/// per step. Source: docs/physics/elements.md, "Links" and schemes.md, "Energy-stable links".
template <class Real>
struct EnergyStableLaw {
  const EnergyStableForm<Real>* form = nullptr;
  Real stiffness = Real(0);
  Real damping = Real(0);
  Real nonlinearity = Real(0);
  Real stiffness_limit = Real(0);
  Real limit_damping = Real(0);  ///< instead of `damping` beyond `tip`
  Real tip = Real(0);
  Real exponent = Real(1);
  Real width = Real(0);     ///< width of the friction curve, m per step; of springs that let go, m
  Real release = Real(0);   ///< elongation at which these let go, m
  Real per_step = Real(1);  ///< velocity of the tables per m per step
  Real length = Real(0);    ///< threshold of contacts, rest length of the others, m
  Real normal = Real(0);    ///< force of dry friction, unless a contact gives it
  Real steady = Real(0);    ///< mu far from rest
  Real share[2] = {Real(0), Real(0)};      ///< parts of mu that fall
  Real per_width[2] = {Real(0), Real(0)};  ///< 1 over the slip in which they fall by e
  EnergyStableCurve<Real> table;           ///< elastic
  EnergyStableCurve<Real> viscous;         ///< over velocity

  static EnergyStableLaw make(const Scene& scene, const Lia& lia, const Units& units);
  /// Takes the tables of a law in parts, beside which a spring K (e - width) may act.
  void takeParts(const Scene& scene, const Lia& lia);
  /// Takes all numbers again from the present values in `scene`; tables stay. Realtime: yes
  void update(const Scene& scene, const Lia& lia, const Units& units) noexcept;

  bool isContact() const noexcept { return form->sort == EnergyStableForm<Real>::Sort::kContact; }
  bool isFriction() const noexcept { return form->sort == EnergyStableForm<Real>::Sort::kFriction; }
  bool isDry() const noexcept { return form->sort == EnergyStableForm<Real>::Sort::kDry; }

  /// f(p) and f'(p) of the elastic laws. \pre p > 0 for contacts. Realtime: yes
  EnergyStableForce<Real> push(Real p) const noexcept { return form->push(*this, p); }
  /// Mean of f over the steps before and after p, which is passed at w per step, with the weight
  /// 1 - |t|: the impulse that a motion at constant velocity would get. Contacts only.
  /// Realtime: yes
  Real meanPush(Real p, Real w) const noexcept;
  /// Realtime: yes
  Real potential(Real p) const noexcept {
    return form->potential == nullptr ? Real(0) : form->potential(*this, p);
  }
  Real dampingAt(Real p, Real v) const noexcept { return form->damping(*this, p, v); }
  /// False of a contact whose elastic force is 0 at any p: it is a damper that comes and goes.
  bool hasPush() const noexcept {
    return !isContact() || form->is_lossy || stiffness != Real(0) || nonlinearity != Real(0);
  }
  EnergyStableForce<Real> slip(Real v) const noexcept { return form->slip(*this, v); }
};

/// The form of a contact from a `Curve<Real>` with these functions.
template <class Curve, class Real>
constexpr EnergyStableForm<Real> contactForm() {
  EnergyStableForm<Real> form{};
  form.sort = EnergyStableForm<Real>::Sort::kContact;
  form.push = Curve::push;
  form.potential = Curve::potential;
  form.potential_integral = Curve::potentialIntegral;
  form.curvature = Curve::curvature;
  form.damping = Curve::damping;
  form.restitution = Curve::restitution;
  form.is_lossy = Curve::kIsLossy;
  return form;
}
/// The form of a two-sided spring.
template <class Curve, class Real>
constexpr EnergyStableForm<Real> springForm() {
  EnergyStableForm<Real> form{};
  form.sort = EnergyStableForm<Real>::Sort::kSpring;
  form.push = Curve::push;
  form.potential = Curve::potential;
  form.damping = Curve::damping;
  return form;
}
/// Of one that lets go.
template <class Curve, class Real>
constexpr EnergyStableForm<Real> snappingForm() {
  EnergyStableForm<Real> form = springForm<Curve, Real>();
  form.phase = Curve::phase;
  form.snap = Curve::snap;
  return form;
}
/// Of friction.
template <class Curve, class Real>
constexpr EnergyStableForm<Real> frictionForm() {
  EnergyStableForm<Real> form{};
  form.sort = EnergyStableForm<Real>::Sort::kFriction;
  form.slip = Curve::slip;
  return form;
}

template <template <class> class Curve>
const EnergyStableForms& contactForms(const Lia& /*lia*/) {
  static constexpr EnergyStableForms kForms = {contactForm<Curve<float>, float>(),
                                               contactForm<Curve<double>, double>()};
  return kForms;
}
template <template <class> class Curve>
const EnergyStableForms& springForms(const Lia& /*lia*/) {
  static constexpr EnergyStableForms kForms = {springForm<Curve<float>, float>(),
                                               springForm<Curve<double>, double>()};
  return kForms;
}
template <template <class> class Curve>
const EnergyStableForms& snappingForms(const Lia& /*lia*/) {
  static constexpr EnergyStableForms kForms = {snappingForm<Curve<float>, float>(),
                                               snappingForm<Curve<double>, double>()};
  return kForms;
}
template <template <class> class Curve>
const EnergyStableForms& frictionForms(const Lia& /*lia*/) {
  static constexpr EnergyStableForms kForms = {frictionForm<Curve<float>, float>(),
                                               frictionForm<Curve<double>, double>()};
  return kForms;
}

/// Ratio of the speeds after and before an impact of an oscillator with this damper.
template <class Real>
Real damperRestitution(
    const EnergyStableLaw<Real>& law, Real z, Real slope, Real give, Real speed) noexcept;

/// Z of a law that has one number for it.
template <class Real>
struct PlainDamping {
  ERGOTIC_REALTIME static Real damping(const EnergyStableLaw<Real>& law, Real, Real) noexcept {
    return law.damping > Real(0) ? law.damping : Real(0);
  }
  static constexpr auto restitution = damperRestitution<Real>;
  static constexpr bool kIsLossy = false;
};

extern template class EnergyStableCurve<float>;
extern template class EnergyStableCurve<double>;
extern template struct EnergyStableLaw<float>;
extern template struct EnergyStableLaw<double>;

}  // namespace ergotic::scene
