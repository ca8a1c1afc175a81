// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ergotic/rt/realtime.hpp"
#include "ergotic/scene/scene.hpp"
#include "ergotic/scene/table.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {

template <class Real>
struct GuardedForce {
  Real force = Real(0);
  Real slope = Real(0);
};

/// A table as pieces of polynomials with its integral. A default one is 0 everywhere.
template <class Real>
class GuardedCurve {
 public:
  GuardedCurve() = default;
  /// \param holds  beyond its ends it keeps its last value; otherwise it is 0 there
  GuardedCurve(const scene::Curve& curve, bool holds);

  bool empty() const noexcept { return pieces_.empty(); }
  /// Realtime: yes. Cost: O(log pieces)
  GuardedForce<Real> at(Real x) const noexcept;
  /// Integral over x, at its lowest 0 if it has a lowest value. Realtime: yes. O(log pieces)
  Real potential(Real x) const noexcept;

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
  bool holds_ = true;
};

/// The law of one guarded link: numbers of one step, and its tables.
/// Elastic laws give the force f(p) over compression or elongation p and its integral; friction
/// laws give the force F(v) over the slip v, m per step. Damping is force per m per step.
/// Source: docs/physics.md, "Links" and "Guarded links".
template <class Real>
struct GuardedLaw {
  enum class Kind {
    kContact,
    kPowerContact,
    kCubicContact,
    kQuadratic,
    kCubic,
    kClippedCubic,
    kTable,
    kBow,
    kSmoothBow,
    kSlipTable,
  };
  Kind kind = Kind::kContact;
  Real stiffness = Real(0);
  Real damping = Real(0);
  Real nonlinearity = Real(0);
  Real stiffness_limit = Real(0);
  Real limit_damping = Real(0);  ///< instead of `damping` beyond `tip`
  Real tip = Real(0);
  Real exponent = Real(1);
  Real width = Real(0);        ///< of the friction curve, m per step
  Real per_step = Real(1);     ///< velocity of the tables per m per step
  Real length = Real(0);       ///< threshold of contacts, rest length of the others, m
  GuardedCurve<Real> table;    ///< elastic
  GuardedCurve<Real> viscous;  ///< over velocity

  /// \throws Exception if the link has no law that can be guarded
  static GuardedLaw make(const scene::Scene& scene, const scene::Lia& lia, const StepUnits& units);
  /// Takes all numbers again from the present values in `scene`; tables stay. Realtime: yes
  void update(const scene::Scene& scene, const scene::Lia& lia, const StepUnits& units) noexcept;

  /// Pushes while p > 0 and lets go beyond.
  bool isContact() const noexcept {
    return kind == Kind::kContact || kind == Kind::kPowerContact || kind == Kind::kCubicContact;
  }
  bool isFriction() const noexcept {
    return kind == Kind::kBow || kind == Kind::kSmoothBow || kind == Kind::kSlipTable;
  }

  /// Mean of f over the steps before and after p, which is passed at w per step, with the weight
  /// 1 - |t|: the impulse that a motion at constant velocity would get. Contacts only.
  /// Realtime: yes
  Real meanPush(Real p, Real w) const noexcept;
  /// f(p) and f'(p) of the elastic laws. \pre p > 0 for contacts. Realtime: yes
  GuardedForce<Real> push(Real p) const noexcept;
  /// Integral of f from 0 to p, for springs with a well above its bottom. Realtime: yes
  Real potential(Real p) const noexcept;
  /// Z >= 0 at p; `v` is the velocity of p per step. Realtime: yes
  Real dampingAt(Real p, Real v) const noexcept;
  /// F(v) and F'(v) of the friction laws. Realtime: yes
  GuardedForce<Real> slip(Real v) const noexcept;

 private:
  GuardedForce<Real> bow(Real v) const noexcept;
  Real clippedPotential(Real p) const noexcept;
  Real impulse(Real p) const noexcept;
  Real bend(Real p) const noexcept;
};

/// True if `GuardedLaw::make` knows a law for it.
bool canBeGuarded(const scene::Lia& lia);

extern template class GuardedCurve<float>;
extern template class GuardedCurve<double>;
extern template struct GuardedLaw<float>;
extern template struct GuardedLaw<double>;

}  // namespace ergotic::physics
