// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iterator>

#include "ergotic/rt/realtime.hpp"
#include "ergotic/scene/scene.hpp"
#include "scene/laws/units.hpp"

/// Force laws f(e, v) of explicit links: e elongation in m, v its difference over one step in m, f
/// in the scene's force unit; module a receives -f, module b +f. Damping is per step (Z / step).
/// `u` is x_a - x_b, or in Euclidean geometries the distance, negative for laws that act when it is
/// short (kGap). Source: docs/physics/elements.md, "Links".
namespace ergotic::scene {

/// The elastic part of a force depends on positions, the viscous part on velocities too.
template <class Real>
struct Force {
  Real elastic;
  Real viscous;
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
  /// Value of the table, held beyond its ends. Bounded by log2 of the table's length.
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

/// The coefficients of one run of links: number i of link l is c(i, l).
template <class Real>
struct RunNumbers {
  const Real* base = nullptr;  ///< [numbers][links]
  std::size_t links = 0;
  Tables<Real> table{};  ///< elastic; friction: its only one
  Tables<Real> viscous{};
  Real* state = nullptr;   ///< [links][states] of laws that have one
  double* lost = nullptr;  ///< sum of what their elastic forces lose; null: not asked for

  Real operator()(std::size_t number, std::size_t link) const noexcept {
    return base[number * links + link];
  }
};

/// Data from which the numbers of a link are computed.
struct LinkInSteps {
  const Scene& scene;
  const Lia& lia;
  const Units& units;
  double rest;  ///< distance of the ends at rest, if it is not part of u already
};

/// Computes one number of a link, in steps.
using Number = double (*)(const LinkInSteps& link);

namespace number {

inline double stiffness(const LinkInSteps& of) {
  return of.scene.valueOf(of.lia.stiffness);
}
inline double damping(const LinkInSteps& of) {
  return of.units.damping(of.scene.valueOf(of.lia.damping));
}
/// Displacements are stored from rest: e = u + offset.
inline double offset(const LinkInSteps& of) {
  return of.rest - of.lia.rest_length;
}
/// Offset of the elongation of a contact, with its threshold.
inline double gapOffset(const LinkInSteps& of) {
  return offset(of) + of.scene.valueOf(of.lia.law->width);
}
inline double width(const LinkInSteps& of) {
  return of.scene.valueOf(of.lia.law->width);
}
inline double nonlinearity(const LinkInSteps& of) {
  return of.scene.valueOf(of.lia.law->nonlinearity);
}
inline double exponent(const LinkInSteps& of) {
  return of.scene.valueOf(of.lia.law->exponent);
}
/// m/time_unit per step difference.
inline double perStep(const LinkInSteps& of) {
  return 1.0 / of.units.step;
}

}  // namespace number

/// Forces of `count` links from `first` on, at u[i] and v[i]. Realtime: yes
template <class Real>
using RunForces = void (*)(const RunNumbers<Real>& c,
                           std::size_t first,
                           std::size_t count,
                           const Real* u,
                           const Real* v,
                           Force<Real>* forces) noexcept;

/// How a law is worked out in the explicit scheme.
struct ExplicitForm {
  static constexpr std::size_t kMaxNumbers = 12;

  std::size_t numbers;  ///< of each link, at most kMaxNumbers
  std::size_t offset;   ///< the number that u + it is e; not of friction
  std::size_t states;   ///< numbers that it remembers from step to step, 0 at the start
  void (*convert)(const LinkInSteps& link, double* to);  ///< its numbers. Realtime: yes
  RunForces<float> single_forces;
  RunForces<double> double_forces;

  template <class Real>
  RunForces<Real> forces() const noexcept {
    if constexpr (sizeof(Real) == sizeof(float)) {
      return single_forces;
    } else {
      return double_forces;
    }
  }
};

/// A run of `Law::force(c, l, u, v)`.
template <class Law, class Real>
ERGOTIC_REALTIME void runForces(const RunNumbers<Real>& c,
                                std::size_t first,
                                std::size_t count,
                                const Real* u,
                                const Real* v,
                                Force<Real>* forces) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    forces[i] = Law::force(c, first + i, u[i], v[i]);
  }
}

template <class Law>
void convertNumbers(const LinkInSteps& link, double* to) {
  for (const Number number : Law::kNumbers) {
    *to++ = number(link);
  }
}

/// Explicit form of a law that defines kNumbers, kOffset and force().
template <class Law>
constexpr ExplicitForm explicitForm(std::size_t states = 0) {
  static_assert(std::size(Law::kNumbers) <= ExplicitForm::kMaxNumbers);
  return {std::size(Law::kNumbers), Law::kOffset,          states,
          convertNumbers<Law>,      runForces<Law, float>, runForces<Law, double>};
}

}  // namespace ergotic::scene
