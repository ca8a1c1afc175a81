// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/guarded_laws.hpp"

#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;

/// An LNL that only has a viscous table is a friction.
bool isSlipTable(const scene::Lia& lia) {
  return lia.type == LiaType::kTable && lia.law->table.empty();
}

template <class Real>
typename GuardedLaw<Real>::Kind kindOf(const scene::Lia& lia) {
  using Kind = typename GuardedLaw<Real>::Kind;
  switch (lia.type) {
    case LiaType::kContact:
      return Kind::kContact;
    case LiaType::kPowerContact:
      return Kind::kPowerContact;
    case LiaType::kCubicContact:
      return Kind::kCubicContact;
    case LiaType::kQuadratic:
      return Kind::kQuadratic;
    case LiaType::kSpringDamper:
    case LiaType::kCubic:
      return Kind::kCubic;
    case LiaType::kClippedCubic:
      return Kind::kClippedCubic;
    case LiaType::kTable:
      return isSlipTable(lia) ? Kind::kSlipTable : Kind::kTable;
    case LiaType::kBow:
      return lia.law->table.empty() ? Kind::kBow : Kind::kSlipTable;
    case LiaType::kSmoothBow:
      return Kind::kSmoothBow;
    case LiaType::kPluck:
    case LiaType::kConditional:
      break;
  }
  throw Exception("link '" + lia.name + "' has no law that can be guarded");
}

}  // namespace

bool canBeGuarded(const scene::Lia& lia) {
  return lia.type != LiaType::kPluck && lia.type != LiaType::kConditional;
}

template <class Real>
GuardedCurve<Real>::GuardedCurve(const scene::Curve& curve, bool holds)
    : end_(static_cast<Real>(curve.end)),
      end_value_(static_cast<Real>(curve.end_value)),
      holds_(holds) {
  for (const scene::CurvePiece& from : curve.pieces) {
    Piece piece{static_cast<Real>(from.begin), static_cast<Real>(from.c0),
                static_cast<Real>(from.c1),    static_cast<Real>(from.c2),
                static_cast<Real>(from.c3),    Real(0)};
    if (!pieces_.empty()) {
      const Piece& last = pieces_.back();
      piece.potential = last.potential + integral(last, piece.begin - last.begin);
    }
    pieces_.push_back(piece);
  }
  sinkToFloor();
}

/// The bottom of the well lies at an end of a piece or where the force crosses 0 upwards.
template <class Real>
void GuardedCurve<Real>::sinkToFloor() {
  Real floor = pieces_.front().potential;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Real width = (i + 1 < pieces_.size() ? pieces_[i + 1].begin : end_) - pieces_[i].begin;
    Real low = Real(0);
    Real high = width;
    if (at(pieces_[i].begin).force < Real(0) && at(pieces_[i].begin + width).force > Real(0)) {
      for (int k = 0; k < 60; ++k) {
        const Real middle = (low + high) / Real(2);
        (at(pieces_[i].begin + middle).force < Real(0) ? low : high) = middle;
      }
    }
    floor = std::min({floor, pieces_[i].potential + integral(pieces_[i], high),
                      pieces_[i].potential + integral(pieces_[i], width)});
  }
  for (Piece& piece : pieces_) {
    piece.potential -= floor;
  }
}

template <class Real>
Real GuardedCurve<Real>::integral(const Piece& p, Real u) noexcept {
  return u * (p.c0 + u * (p.c1 / Real(2) + u * (p.c2 / Real(3) + u * p.c3 / Real(4))));
}

template <class Real>
ERGOTIC_REALTIME const typename GuardedCurve<Real>::Piece& GuardedCurve<Real>::pieceOf(
    Real x) const noexcept {
  std::size_t low = 0;
  std::size_t high = pieces_.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (x < pieces_[middle].begin ? high : low) = middle;
  }
  return pieces_[low];
}

template <class Real>
ERGOTIC_REALTIME GuardedForce<Real> GuardedCurve<Real>::at(Real x) const noexcept {
  if (pieces_.empty()) {
    return {};
  }
  const Piece& p = pieceOf(x);
  if (x < p.begin) {
    return {holds_ ? p.c0 : Real(0), Real(0)};
  }
  if (x > end_) {
    return {holds_ ? end_value_ : Real(0), Real(0)};
  }
  const Real u = x - p.begin;
  return {p.c0 + u * (p.c1 + u * (p.c2 + u * p.c3)),
          p.c1 + u * (Real(2) * p.c2 + u * Real(3) * p.c3)};
}

template <class Real>
ERGOTIC_REALTIME Real GuardedCurve<Real>::potential(Real x) const noexcept {
  if (pieces_.empty()) {
    return Real(0);
  }
  const Piece& p = pieceOf(x);
  const Real inside = std::clamp(x, p.begin, std::max(p.begin, end_));
  const Real beyond = holds_ ? (x - inside) * at(inside).force : Real(0);
  return p.potential + integral(p, inside - p.begin) + beyond;
}

template <class Real>
GuardedLaw<Real> GuardedLaw<Real>::make(const scene::Scene& scene,
                                        const scene::Lia& lia,
                                        const StepUnits& units) {
  GuardedLaw law;
  law.kind = kindOf<Real>(lia);
  const bool holds = lia.type == LiaType::kTable;
  if (!lia.law->table.empty()) {
    const GuardedCurve<Real> curve(scene::interpolate(lia.law->table), holds);
    (law.kind == Kind::kTable ? law.table : law.viscous) = curve;
  }
  if (!lia.law->viscous_table.empty()) {
    law.viscous = GuardedCurve<Real>(scene::interpolate(lia.law->viscous_table), holds);
  }
  law.update(scene, lia, units);
  return law;
}

template <class Real>
ERGOTIC_REALTIME void GuardedLaw<Real>::update(const scene::Scene& scene,
                                               const scene::Lia& lia,
                                               const StepUnits& units) noexcept {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const double z = units.damping(scene.valueOf(lia.damping));
  stiffness = real(scene.valueOf(lia.stiffness));
  damping = real(z);
  nonlinearity = real(scene.valueOf(lia.law->nonlinearity));
  stiffness_limit = real(scene.valueOf(lia.law->stiffness_limit));
  limit_damping = real(z + units.damping(scene.valueOf(lia.law->limit_damping)));
  tip = real(lia.law->tipping_point);
  exponent = real(scene.valueOf(lia.law->exponent));
  width = real(units.velocity(scene.valueOf(lia.law->width)));
  per_step = real(1.0 / units.step);
  length = real(isContact() ? scene.valueOf(lia.law->width) : lia.rest_length);
}

template <class Real>
ERGOTIC_REALTIME GuardedForce<Real> GuardedLaw<Real>::push(Real p) const noexcept {
  const Real size = std::abs(p);
  switch (kind) {
    case Kind::kContact:
      return {stiffness * p, stiffness};
    case Kind::kPowerContact: {
      const Real force = stiffness * std::pow(p, exponent);
      return {force, exponent * force / p};
    }
    case Kind::kQuadratic:
      return {p * (stiffness + nonlinearity * size), stiffness + Real(2) * nonlinearity * size};
    case Kind::kCubicContact:
    case Kind::kClippedCubic:
      if (size > tip) {
        return {stiffness_limit * p, stiffness_limit};
      }
      [[fallthrough]];
    case Kind::kCubic:
      return {p * (stiffness + nonlinearity * p * p), stiffness + Real(3) * nonlinearity * p * p};
    case Kind::kTable:
      return table.at(p);
    case Kind::kBow:
    case Kind::kSmoothBow:
    case Kind::kSlipTable:
      break;
  }
  return {};
}

template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::clippedPotential(Real p) const noexcept {
  const Real inside = std::min(std::abs(p), tip);
  const Real square = inside * inside;
  return square * (stiffness + nonlinearity * square / Real(2)) / Real(2) +
         stiffness_limit * (p * p - square) / Real(2);
}

template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::potential(Real p) const noexcept {
  const Real k = stiffness;
  const Real q = nonlinearity;
  const bool has_well = k < Real(0) && q > Real(0);
  switch (kind) {
    case Kind::kContact:
      return k * p * p / Real(2);
    case Kind::kPowerContact:
      return push(p).force * p / (exponent + Real(1));
    case Kind::kQuadratic:
      return p * p * (k / Real(2) + q * std::abs(p) / Real(3)) -
             (has_well ? k * k * k / (Real(6) * q * q) : Real(0));
    case Kind::kCubic:
      return p * p * (k / Real(2) + q * p * p / Real(4)) +
             (has_well ? k * k / (Real(4) * q) : Real(0));
    case Kind::kCubicContact:
    case Kind::kClippedCubic:
      return clippedPotential(p);
    case Kind::kTable:
      return table.potential(p);
    case Kind::kBow:
    case Kind::kSmoothBow:
    case Kind::kSlipTable:
      break;
  }
  return Real(0);
}

/// Integral of the potential from 0: what a force gives to a motion at constant velocity.
template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::impulse(Real p) const noexcept {
  if (!(p > Real(0))) {
    return Real(0);
  }
  if (kind == Kind::kContact) {
    return stiffness * p * p * p / Real(6);
  }
  if (kind == Kind::kPowerContact) {
    return push(p).force * p * p / ((exponent + Real(1)) * (exponent + Real(2)));
  }
  const Real inside = std::min(p, tip);
  const Real cube = inside * inside * inside;
  const Real beyond = p - inside;
  return cube * (stiffness / Real(6) + nonlinearity * inside * inside / Real(20)) +
         beyond * clippedPotential(inside) +
         stiffness_limit * beyond * beyond * (p + Real(2) * inside) / Real(6);
}

/// Second derivative of f.
template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::bend(Real p) const noexcept {
  if (kind == Kind::kPowerContact) {
    return exponent * (exponent - Real(1)) * push(p).force / (p * p);
  }
  return kind == Kind::kCubicContact && p < tip ? Real(6) * nonlinearity * p : Real(0);
}

template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::meanPush(Real p, Real w) const noexcept {
  const Real step = std::abs(w);
  if (p > Real(4) * step) {
    return push(p).force + step * step * bend(p) / Real(12);  // the rest is below 1e-5 of it
  }
  if (!(p + step > Real(0))) {
    return Real(0);
  }
  return (impulse(p + step) - Real(2) * impulse(p) + impulse(p - step)) / (step * step);
}

template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::dampingAt(Real p, Real v) const noexcept {
  const bool is_clipped = kind == Kind::kCubicContact || kind == Kind::kClippedCubic;
  Real z = is_clipped && std::abs(p) > tip ? limit_damping : damping;
  if (kind == Kind::kTable && !viscous.empty()) {
    // The chord, not the slope: it is what this much force dissipates at this velocity.
    const GuardedForce<Real> at = viscous.at(v * per_step);
    z += v != Real(0) ? at.force / v : at.slope * per_step;
  }
  return std::max(Real(0), z);
}

template <class Real>
ERGOTIC_REALTIME GuardedForce<Real> GuardedLaw<Real>::bow(Real v) const noexcept {
  const Real speed = std::abs(v);
  const Real slope = damping / Real(3);
  const Real stick = width / Real(3);
  if (speed >= width) {
    return {};
  }
  if (speed < stick) {
    return {(damping - slope) * v, damping - slope};
  }
  return {std::copysign(stick * damping, v) - slope * v, -slope};
}

template <class Real>
ERGOTIC_REALTIME GuardedForce<Real> GuardedLaw<Real>::slip(Real v) const noexcept {
  switch (kind) {
    case Kind::kBow:
      return bow(v);
    case Kind::kSmoothBow: {
      const Real r = v / width;
      const Real chord = Real(0.63) * damping * std::exp(Real(-4) * r * r + Real(0.5));
      return {chord * v, chord * (Real(1) - Real(8) * r * r)};
    }
    case Kind::kSlipTable: {
      const GuardedForce<Real> at = viscous.at(v * per_step);
      return {at.force, at.slope * per_step};
    }
    default:
      return {};
  }
}

template class GuardedCurve<float>;
template class GuardedCurve<double>;
template struct GuardedLaw<float>;
template struct GuardedLaw<double>;

}  // namespace ergotic::physics
