// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/guarded_form.hpp"

#include <algorithm>
#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::scene {

template <class Real>
GuardedCurve<Real>::GuardedCurve(const Curve& curve, bool holds)
    : end_(static_cast<Real>(curve.end)),
      end_value_(static_cast<Real>(curve.end_value)),
      holds_(holds) {
  for (const CurvePiece& from : curve.pieces) {
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
GuardedLaw<Real> GuardedLaw<Real>::make(const Scene& scene, const Lia& lia, const Units& units) {
  const Law& told = lawOf(lia.type);
  const bool holds = told.tables == Law::Tables::kParts;
  GuardedLaw law;
  law.form = &told.guarded(lia).template get<Real>();
  if (!lia.law->table.empty()) {
    (law.isFriction() ? law.viscous : law.table) =
        GuardedCurve<Real>(interpolate(lia.law->table), holds);
  }
  if (!lia.law->viscous_table.empty()) {
    law.viscous = GuardedCurve<Real>(interpolate(lia.law->viscous_table), holds);
  }
  law.update(scene, lia, units);
  return law;
}

template <class Real>
ERGOTIC_REALTIME void GuardedLaw<Real>::update(const Scene& scene,
                                               const Lia& lia,
                                               const Units& units) noexcept {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const double z = units.damping(scene.valueOf(lia.damping));
  stiffness = real(scene.valueOf(lia.stiffness));
  damping = real(z);
  nonlinearity = real(scene.valueOf(lia.law->nonlinearity));
  stiffness_limit = real(scene.valueOf(lia.law->stiffness_limit));
  limit_damping = real(z + units.damping(scene.valueOf(lia.law->limit_damping)));
  tip = real(lia.law->tipping_point);
  exponent = real(scene.valueOf(lia.law->exponent));
  const double across = scene.valueOf(lia.law->width);
  width = real(isFriction() ? units.velocity(across) : across);
  release = real(lia.law->release);
  per_step = real(1.0 / units.step);
  length = real(isContact() ? across : lia.rest_length);
}

namespace {

template <class Real>
ERGOTIC_REALTIME Real impulseOf(const GuardedLaw<Real>& law, Real p) noexcept {
  return p > Real(0) ? law.form->impulse(law, p) : Real(0);
}

}  // namespace

template <class Real>
ERGOTIC_REALTIME Real GuardedLaw<Real>::meanPush(Real p, Real w) const noexcept {
  // Slower than that the cubes below vanish.
  constexpr Real kStill = Real(sizeof(Real) == sizeof(float) ? 1e-12 : 1e-100);
  const Real step = std::abs(w);
  const Real here = p > Real(0) ? push(p).force : Real(0);
  if (!(p + step > Real(0)) || step < kStill) {
    return here;
  }
  if (p > Real(4) * step) {
    // The rest is below 1e-5 of it.
    return here + step * step * form->bend(*this, p) / Real(12);
  }
  const Real mean =
      (impulseOf(*this, p + step) - Real(2) * impulseOf(*this, p) + impulseOf(*this, p - step)) /
      (step * step);
  return std::isfinite(mean) ? mean : here;  // cubes overflow long before forces do
}

template <class Real>
ERGOTIC_REALTIME Real
damperRestitution(const GuardedLaw<Real>&, Real z, Real slope, Real give, Real) noexcept {
  constexpr double kPi = 3.14159265358979323846;
  const Real r = z * std::sqrt(give / slope) / Real(2);
  return r < Real(1) ? std::exp(-static_cast<Real>(kPi) * r / std::sqrt(Real(1) - r * r)) : Real(0);
}

template float damperRestitution(const GuardedLaw<float>&, float, float, float, float) noexcept;
template double damperRestitution(
    const GuardedLaw<double>&, double, double, double, double) noexcept;
template class GuardedCurve<float>;
template class GuardedCurve<double>;
template struct GuardedLaw<float>;
template struct GuardedLaw<double>;

}  // namespace ergotic::scene
