// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "ergotic/rt/realtime.hpp"

/// Force laws f(e, v) of the links: e elongation in m, v its difference over one step in m, f in
/// the scene's force unit; module a receives -f, module b +f. Each law reads its coefficients from
/// a block of fields, [fields][links]; damping is per step (Z / step).
/// Source: docs/physics.md, "Links".
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

/// Tables of one run: link l has `count[l]` points from `first[l]` on.
template <class Real>
struct Tables {
  const Real* x = nullptr;
  const Real* y = nullptr;
  const int* first = nullptr;
  const int* count = nullptr;

  /// Straight lines between the points, 0 outside. Bounded by log2 of the table's length.
  ERGOTIC_REALTIME Real at(std::size_t link, Real value) const noexcept {
    const Real* tx = x + first[link];
    const Real* ty = y + first[link];
    int low = 0;
    int high = count[link] - 1;
    if (!(value >= tx[low] && value <= tx[high])) {
      return Real(0);
    }
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (value < tx[middle] ? high : low) = middle;
    }
    return ty[low] + (ty[high] - ty[low]) * (value - tx[low]) / (tx[high] - tx[low]);
  }
};

template <class Real>
struct SpringDamper {
  static constexpr std::size_t kFields = 3;  // K, Z, offset
  Fields<Real> c;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    return c(0, l) * (u + c(2, l)) + c(1, l) * v;
  }
};

template <class Real>
struct Contact {
  static constexpr std::size_t kFields = 3;  // K, Z, offset (threshold included)
  Fields<Real> c;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? c(0, l) * e + c(1, l) * v : Real(0);
  }
};

template <class Real>
struct Quadratic {
  static constexpr std::size_t kFields = 4;  // K, Z, offset, Q
  Fields<Real> c;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return c(0, l) * e + c(3, l) * e * std::abs(e) + c(1, l) * v;
  }
};

template <class Real>
struct Cubic {
  static constexpr std::size_t kFields = 4;  // K, Z, offset, Q
  Fields<Real> c;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    return c(0, l) * e + c(3, l) * e * e * e + c(1, l) * v;
  }
};

template <class Real>
struct ClippedCubic {
  static constexpr std::size_t kFields = 7;  // K, Z, offset, Q, K_limit, Z_limit, tipping point
  Fields<Real> c;
  Real clipped(std::size_t l, Real e, Real v) const noexcept {
    return std::abs(e) <= c(6, l) ? c(0, l) * e + c(3, l) * e * e * e + c(1, l) * v
                                  : c(4, l) * e + c(5, l) * v;
  }
  Real force(std::size_t l, Real u, Real v) const noexcept { return clipped(l, u + c(2, l), v); }
};

template <class Real>
struct CubicContact {
  static constexpr std::size_t kFields = ClippedCubic<Real>::kFields;
  ClippedCubic<Real> spring;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + spring.c(2, l);
    return e > Real(0) ? spring.clipped(l, e, v) : Real(0);
  }
};

template <class Real>
struct Pluck {
  static constexpr std::size_t kFields = 4;  // K, Z, offset, width
  Fields<Real> c;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    const Real e = u + c(2, l);
    const Real distance = std::abs(e);
    const Real width = c(3, l);
    if (distance >= width) {
      return Real(0);
    }
    const Real stiffness = c(0, l);
    const Real slope = Real(0.1) * stiffness;
    const Real tip = Real(0.1) * width;
    const Real friction = c(1, l) * v;
    return distance < tip ? (slope - stiffness) * e + friction
                          : slope * e - std::copysign(tip * stiffness, e) + friction;
  }
};

template <class Real>
struct Bow {
  static constexpr std::size_t kFields = 2;  // Z, width per step
  Fields<Real> c;
  Real force(std::size_t l, Real, Real v) const noexcept {
    const Real speed = std::abs(v);
    const Real width = c(1, l);
    if (speed >= width) {
      return Real(0);
    }
    const Real damping = c(0, l);
    const Real slope = damping / Real(3);
    const Real stick = width / Real(3);
    return speed < stick ? (damping - slope) * v : std::copysign(stick * damping, v) - slope * v;
  }
};

template <class Real>
struct SmoothBow {
  static constexpr std::size_t kFields = 2;  // Z, 1 / width per step
  Fields<Real> c;
  Real force(std::size_t l, Real, Real v) const noexcept {
    const Real r = v * c(1, l);
    return Real(0.63) * c(0, l) * v * std::exp(Real(-4) * r * r + Real(0.5));
  }
};

template <class Real>
struct PluckTable {
  static constexpr std::size_t kFields = 3;  // unused K, Z, offset
  Fields<Real> c;
  Tables<Real> table;
  Real force(std::size_t l, Real u, Real v) const noexcept {
    return table.at(l, u + c(2, l)) + c(1, l) * v;
  }
};

template <class Real>
struct BowTable {
  static constexpr std::size_t kFields = 1;  // m/time_unit per step difference
  Fields<Real> c;
  Tables<Real> table;
  Real force(std::size_t l, Real, Real v) const noexcept { return table.at(l, v * c(0, l)); }
};

}  // namespace ergotic::physics::laws
