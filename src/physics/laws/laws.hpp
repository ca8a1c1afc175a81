// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "ergotic/rt/realtime.hpp"

/// Force laws f(e, v) of the links: e elongation in m, v its difference over one step in m, f in
/// the scene's force unit; module a receives -f, module b +f. Each law reads its coefficients from
/// a block of fields, [fields][links]; damping is per step (Z / step). `u` is x_a - x_b, or in
/// Euclidean geometries the distance, negative for laws that act when it is short (kGap).
/// kFriction: acts along the velocity, whatever the distance. Source: docs/physics.md, "Links".
namespace ergotic::physics::laws {

/// The fields of one run of links.
template <class Real>
struct Fields {
  const Real* base = nullptr;
  std::size_t links = 0;
  Real operator()(std::size_t field, std::size_t link) const noexcept {
    return base[field * links + link];
  }
};

/// The elastic part of a force depends on positions, the viscous part on velocities too.
template <class Real>
struct Force {
  Real elastic;
  Real viscous;
};

/// What a law acts on, for the geometries and for the energy meter.
enum class Kind {
  kLinear,    ///< elongation and velocity, linear
  kElastic,   ///< elongation and velocity
  kGap,       ///< a distance that is too short
  kFriction,  ///< velocity alone
};

/// Tables of one run: link l has `count[l]` pieces from `first[l]` on, each a cubic in
/// (value - x) from its x to that of the next; the last x ends the table.
template <class Real>
struct Tables {
  const Real* x = nullptr;
  const Real* cubic = nullptr;  ///< [points][4]
  const int* first = nullptr;
  const int* count = nullptr;  ///< points: pieces + 1

  ERGOTIC_REALTIME bool holds(std::size_t link, Real value) const noexcept {
    return value >= x[first[link]] && value <= x[first[link] + count[link] - 1];
  }
  /// Its value, held beyond its ends. Bounded by log2 of the table's length.
  ERGOTIC_REALTIME Real at(std::size_t link, Real value) const noexcept {
    const Real* tx = x + first[link];
    int low = 0;
    int high = count[link] - 1;
    if (high < 1) {
      return Real(0);
    }
    const Real inside = value < tx[low] ? tx[low] : (value > tx[high] ? tx[high] : value);
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (inside < tx[middle] ? high : low) = middle;
    }
    const Real* c = cubic + 4 * (first[link] + low);
    const Real t = inside - tx[low];
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  }
  Real atOrZero(std::size_t link, Real value) const noexcept {
    return holds(link, value) ? at(link, value) : Real(0);
  }
};

template <class Real>
struct SpringDamper {
  static constexpr Kind kKind = Kind::kLinear;
  static constexpr std::size_t kFields = 3;  // K, Z, offset
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    return {c(0, l) * (u + c(2, l)), c(1, l) * v};
  }
};

template <class Real>
struct Contact {
  static constexpr Kind kKind = Kind::kGap;
  static constexpr std::size_t kFields = 3;  // K, Z, offset (threshold included)
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? Force<Real>{c(0, l) * e, c(1, l) * v} : Force<Real>{};
  }
};

template <class Real>
struct Quadratic {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 4;  // K, Z, offset, Q
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return {c(0, l) * e + c(3, l) * e * std::abs(e), c(1, l) * v};
  }
};

template <class Real>
struct Cubic {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 4;  // K, Z, offset, Q
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return {c(0, l) * e + c(3, l) * e * e * e, c(1, l) * v};
  }
};

template <class Real>
struct ClippedCubic {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 7;  // K, Z, offset, Q, K_limit, Z_limit, tipping point
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> clipped(std::size_t l, Real e, Real v) const noexcept {
    return std::abs(e) <= c(6, l) ? Force<Real>{c(0, l) * e + c(3, l) * e * e * e, c(1, l) * v}
                                  : Force<Real>{c(4, l) * e, c(5, l) * v};
  }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    return clipped(l, u + c(2, l), v);
  }
};

template <class Real>
struct CubicContact {
  static constexpr Kind kKind = Kind::kGap;
  static constexpr std::size_t kFields = ClippedCubic<Real>::kFields;
  ClippedCubic<Real> spring;
  Real offset(std::size_t l) const noexcept { return spring.c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + spring.c(2, l);
    return e > Real(0) ? spring.clipped(l, e, v) : Force<Real>{};
  }
};

template <class Real>
struct Pluck {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 4;  // K, Z, offset, width
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    const Real distance = std::abs(e);
    const Real width = c(3, l);
    if (distance >= width) {
      return {};
    }
    const Real stiffness = c(0, l);
    const Real slope = Real(0.1) * stiffness;
    const Real tip = Real(0.1) * width;
    const Real friction = c(1, l) * v;
    return {
        distance < tip ? (slope - stiffness) * e : slope * e - std::copysign(tip * stiffness, e),
        friction};
  }
};

template <class Real>
struct Bow {
  static constexpr Kind kKind = Kind::kFriction;
  static constexpr std::size_t kFields = 2;  // Z, width per step
  Fields<Real> c;
  Force<Real> force(std::size_t l, Real, Real v) const noexcept {
    const Real speed = std::abs(v);
    const Real width = c(1, l);
    if (speed >= width) {
      return {};
    }
    const Real damping = c(0, l);
    const Real slope = damping / Real(3);
    const Real stick = width / Real(3);
    return {Real(0),
            speed < stick ? (damping - slope) * v : std::copysign(stick * damping, v) - slope * v};
  }
};

template <class Real>
struct SmoothBow {
  static constexpr Kind kKind = Kind::kFriction;
  static constexpr std::size_t kFields = 2;  // Z, 1 / width per step
  Fields<Real> c;
  Force<Real> force(std::size_t l, Real, Real v) const noexcept {
    const Real r = v * c(1, l);
    return {Real(0), Real(0.63) * c(0, l) * v * std::exp(Real(-4) * r * r + Real(0.5))};
  }
};

template <class Real>
struct PluckTable {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 3;  // unused K, Z, offset
  Fields<Real> c;
  Tables<Real> table;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    return {table.atOrZero(l, u + c(2, l)), c(1, l) * v};
  }
};

template <class Real>
struct BowTable {
  static constexpr Kind kKind = Kind::kFriction;
  static constexpr std::size_t kFields = 1;  // m/time_unit per step difference
  Fields<Real> c;
  Tables<Real> table;
  Force<Real> force(std::size_t l, Real, Real v) const noexcept {
    return {Real(0), table.atOrZero(l, v * c(0, l))};
  }
};

template <class Real>
struct PowerContact {
  static constexpr Kind kKind = Kind::kGap;
  static constexpr std::size_t kFields = 4;  // K, Z, offset (threshold included), exponent
  Fields<Real> c;
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? Force<Real>{c(0, l) * std::pow(e, c(3, l)), c(1, l) * v} : Force<Real>{};
  }
};

template <class Real>
struct ElasticViscousTable {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 2;  // offset, m/time_unit per step difference
  Fields<Real> c;
  Tables<Real> elastic;
  Tables<Real> viscous;
  Real offset(std::size_t l) const noexcept { return c(0, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    return {elastic.at(l, u + c(0, l)), viscous.at(l, v * c(1, l))};
  }
};

template <class Real>
struct Conditional {
  static constexpr Kind kKind = Kind::kElastic;
  static constexpr std::size_t kFields = 5;  // K, Z, offset, engage, release
  Fields<Real> c;
  Real* engaged;  ///< [links] 1 while it holds on
  Real offset(std::size_t l) const noexcept { return c(2, l); }
  Force<Real> force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    const Real distance = std::abs(e);
    const bool holds = engaged[l] != Real(0) ? distance <= c(4, l) : distance < c(3, l);
    engaged[l] = holds ? Real(1) : Real(0);
    return holds ? Force<Real>{c(0, l) * e, c(1, l) * v} : Force<Real>{};
  }
};

}  // namespace ergotic::physics::laws
