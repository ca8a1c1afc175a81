// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/energy_stable_form.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/table_ends.hpp"

namespace ergotic::scene {

namespace {

Curve sum(Curve curve, double at_0, double slope) {
  if (curve.pieces.empty()) {
    curve.pieces.push_back({});
  }
  for (CurvePiece& piece : curve.pieces) {
    piece.c0 += at_0 + slope * piece.begin;
    piece.c1 += slope;
  }
  curve.end_value += at_0 + slope * curve.end;
  curve.largest_slope += slope;
  return curve;
}

}  // namespace

template <class Real>
EnergyStableCurve<Real>::EnergyStableCurve(const Curve& curve, double at_0, double slope)
    : EnergyStableCurve(sum(curve, at_0, slope), true) {
  beyond_ = static_cast<Real>(slope);
  sinkToFloor();
}

template <class Real>
EnergyStableCurve<Real>::EnergyStableCurve(const Curve& curve, bool holds)
    : end_(static_cast<Real>(curve.end)),
      end_value_(static_cast<Real>(curve.end_value)),
      steepest_(static_cast<Real>(curve.largest_slope)),
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

/// The bottom of the well lies at an end of a piece or where the force crosses 0 upwards, beyond
/// the ends too if it rises there.
template <class Real>
void EnergyStableCurve<Real>::sinkToFloor() {
  const auto bottom = [this](Real from, Real outwards) {
    return from - (outwards > Real(0) && beyond_ > Real(0)
                       ? outwards * outwards / (Real(2) * beyond_)
                       : Real(0));
  };
  Real floor = bottom(pieces_.front().potential, pieces_.front().c0);
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
  floor = std::min(floor, bottom(potential(end_), -end_value_));
  for (Piece& piece : pieces_) {
    piece.potential -= floor;
  }
}

template <class Real>
Real EnergyStableCurve<Real>::integral(const Piece& p, Real u) noexcept {
  return u * (p.c0 + u * (p.c1 / Real(2) + u * (p.c2 / Real(3) + u * p.c3 / Real(4))));
}

template <class Real>
ERGOTIC_REALTIME const typename EnergyStableCurve<Real>::Piece& EnergyStableCurve<Real>::pieceOf(
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
ERGOTIC_REALTIME EnergyStableForce<Real> EnergyStableCurve<Real>::at(Real x) const noexcept {
  if (pieces_.empty()) {
    return {};
  }
  const Piece& p = pieceOf(x);
  if (x < p.begin) {
    return {holds_ ? p.c0 + beyond_ * (x - p.begin) : Real(0), beyond_};
  }
  if (x > end_) {
    return {holds_ ? end_value_ + beyond_ * (x - end_) : Real(0), beyond_};
  }
  const Real u = x - p.begin;
  return {p.c0 + u * (p.c1 + u * (p.c2 + u * p.c3)),
          p.c1 + u * (Real(2) * p.c2 + u * Real(3) * p.c3)};
}

template <class Real>
ERGOTIC_REALTIME Real EnergyStableCurve<Real>::potential(Real x) const noexcept {
  if (pieces_.empty()) {
    return Real(0);
  }
  const Piece& p = pieceOf(x);
  const Real inside = std::clamp(x, p.begin, std::max(p.begin, end_));
  const Real out = holds_ ? x - inside : Real(0);
  return p.potential + integral(p, inside - p.begin) +
         out * (at(inside).force + beyond_ * out / Real(2));
}

template <class Real>
EnergyStableLaw<Real> EnergyStableLaw<Real>::make(const Scene& scene,
                                                  const Lia& lia,
                                                  const Units& units) {
  const Law& told = lawOf(lia.type);
  EnergyStableLaw law;
  law.form = &told.energy_stable(lia).template get<Real>();
  if (told.tables == Law::Tables::kParts) {
    law.takeParts(scene, lia);
  } else if (!lia.law->table.empty()) {
    (law.isFriction() || law.isDry() ? law.viscous : law.table) =
        EnergyStableCurve<Real>(interpolate(lia.law->table), law.isDry());
  }
  law.update(scene, lia, units);
  return law;
}

/// Splits the viscous table: its force at rest is constant, so elastic; the rest is a brake.
template <class Real>
void EnergyStableLaw<Real>::takeParts(const Scene& scene, const Lia& lia) {
  const auto curveOf = [](const Table& of) { return of.empty() ? Curve{} : interpolate(of); };
  const Curve lossy = curveOf(lia.law->viscous_table);
  const double at_rest = forceAtRest(lia);
  const double slope = scene.valueOf(lia.stiffness);
  const double shift = at_rest - slope * scene.valueOf(lia.law->width);
  table = EnergyStableCurve<Real>(curveOf(lia.law->table), shift, slope);
  if (!lossy.pieces.empty()) {
    viscous = EnergyStableCurve<Real>(lossy, -at_rest, 0.0);
  }
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableLaw<Real>::update(const Scene& scene,
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
  normal = real(scene.valueOf(lia.law->normal));
  steady = real(lia.law->steady);
  for (std::size_t i = 0; i < lia.law->falls.size(); ++i) {
    share[i] = real(lia.law->falls[i].share);
    per_width[i] = real(1.0 / units.velocity(lia.law->falls[i].width));
  }
}

namespace {

template <class Real>
ERGOTIC_REALTIME Real potentialIntegralOf(const EnergyStableLaw<Real>& law, Real p) noexcept {
  return p > Real(0) ? law.form->potential_integral(law, p) : Real(0);
}

}  // namespace

template <class Real>
ERGOTIC_REALTIME Real EnergyStableLaw<Real>::meanPush(Real p, Real w) const noexcept {
  // Slower than that the cubes below vanish.
  constexpr Real kStill = Real(sizeof(Real) == sizeof(float) ? 1e-12 : 1e-100);
  const Real step = std::abs(w);
  const Real here = p > Real(0) ? push(p).force : Real(0);
  if (!(p + step > Real(0)) || step < kStill) {
    return here;
  }
  if (p > Real(4) * step) {
    // The rest is below 1e-5 of it.
    return here + step * step * form->curvature(*this, p) / Real(12);
  }
  const Real mean =
      (potentialIntegralOf(*this, p + step) - Real(2) * potentialIntegralOf(*this, p) +
       potentialIntegralOf(*this, p - step)) /
      (step * step);
  return std::isfinite(mean) ? mean : here;  // cubes overflow long before forces do
}

template <class Real>
ERGOTIC_REALTIME Real
damperRestitution(const EnergyStableLaw<Real>&, Real z, Real slope, Real give, Real) noexcept {
  const Real r = z * std::sqrt(give / slope) / Real(2);
  return r < Real(1) ? std::exp(-static_cast<Real>(kPi) * r / std::sqrt(Real(1) - r * r)) : Real(0);
}

template float damperRestitution(
    const EnergyStableLaw<float>&, float, float, float, float) noexcept;
template double damperRestitution(
    const EnergyStableLaw<double>&, double, double, double, double) noexcept;
template class EnergyStableCurve<float>;
template class EnergyStableCurve<double>;
template struct EnergyStableLaw<float>;
template struct EnergyStableLaw<double>;

}  // namespace ergotic::scene
