// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "physics/layout/blocks/link_ends.hpp"

/// Loops over the links and modules of a body with one tank. Sums keep kSums lanes of double
/// precision, so that compilers may take them side by side and every machine gets the same bits.
namespace ergotic::physics::kernels {

constexpr std::size_t kSums = 8;
constexpr std::size_t kChunk = 64;  // links, a multiple of kSums

/// A sum in kSums parts, which are added to in turns.
class Sum {
 public:
  void add(std::size_t turn, double value) noexcept { lanes_[turn % kSums] += value; }
  double total() const noexcept {
    double sum = 0.0;
    for (const double lane : lanes_) {
      sum += lane;
    }
    return sum;
  }

 private:
  std::array<double, kSums> lanes_{};
};

template <class Real>
struct TankLinks {
  const LinkSpan* spans;
  std::size_t span_count;
  const LinkEnds* ends;
  const Real* offset;  ///< [links] e = x_a - x_b + offset
  const Real* q;       ///< [links] Q
};

struct TankSums {
  double energy = 0.0;  ///< sum Q e^2, or Q e^4
  double weight = 0.0;  ///< sum Q
};

/// Adds `slopeOf(Q, e)` of each link to slope[a], takes it from slope[b], and sums it times
/// `factorOf(e)`.
template <class Real, class Slope, class Factor>
TankSums addSlopes(const TankLinks<Real>& links,
                   const Real* x,
                   Real* slope,
                   const Slope& slopeOf,
                   const Factor& factorOf) noexcept {
  Sum energy;
  Sum weight;
  Real e[kChunk];
  Real s[kChunk];
  for (const LinkSpan* span = links.spans; span != links.spans + links.span_count; ++span) {
    const auto end = static_cast<std::size_t>(span->first + span->count);
    for (auto l = static_cast<std::size_t>(span->first); l < end; l += kChunk) {
      const std::size_t count = std::min(kChunk, end - l);
      const std::size_t done = l - static_cast<std::size_t>(span->first);
      const bool is_even = span->a >= 0;
      const Real* const offset = links.offset + l;
      const Real* const q = links.q + l;
      const LinkEnds* const ends = links.ends + l;
      const auto a = static_cast<std::ptrdiff_t>(is_even ? span->a : 0);
      const auto b = static_cast<std::ptrdiff_t>(is_even ? span->b : 0);
      const auto at = static_cast<std::ptrdiff_t>(is_even ? done : 0);
      for (std::size_t i = 0; i < count; ++i) {
        e[i] = is_even ? x[a + at + static_cast<std::ptrdiff_t>(i)] -
                             x[b + at + static_cast<std::ptrdiff_t>(i)] + offset[i]
                       : x[ends[i].a] - x[ends[i].b] + offset[i];
      }
      for (std::size_t i = 0; i < count; ++i) {
        s[i] = slopeOf(q[i], e[i]);
      }
      for (std::size_t i = 0; i < count; ++i) {
        energy.add(i, static_cast<double>(s[i]) * static_cast<double>(factorOf(e[i])));
        weight.add(i, static_cast<double>(q[i]));
      }
      if (is_even) {
        Real* const to_a = slope + a + at;
        Real* const to_b = slope + b + at;
        for (std::size_t i = 0; i < count; ++i) {
          to_a[i] += s[i];
        }
        for (std::size_t i = 0; i < count; ++i) {
          to_b[i] -= s[i];
        }
      } else {
        for (std::size_t i = 0; i < count; ++i) {
          slope[ends[i].a] += s[i];
          slope[ends[i].b] -= s[i];
        }
      }
    }
  }
  return {energy.total(), weight.total()};
}

/// Adds up sum Q e^2, and for each module Q e, half of its slope. Realtime: yes
template <class Real>
TankSums addMeanSlopes(const TankLinks<Real>& links, const Real* x, Real* slope) noexcept {
  return addSlopes(
      links, x, slope, [](Real q, Real e) { return q * e; }, [](Real e) { return e; });
}

/// Adds up sum Q e^4, and for each module Q e^3, a quarter of its slope. Realtime: yes
template <class Real>
TankSums addCubicSlopes(const TankLinks<Real>& links, const Real* x, Real* slope) noexcept {
  return addSlopes(
      links, x, slope, [](Real q, Real e) { return q * e * e * e; }, [](Real e) { return e; });
}

template <class Real>
struct TankModules {
  const Real* x;
  const Real* d;
  const Real* f;
  // The step to come is d - (lose d + pull x) + inverse_mass f + drift.
  const Real* inverse_mass;
  const Real* drift;
  const Real* lose;
  const Real* pull;
  const std::uint32_t* indices;  ///< [count] of the modules of the body, in all arrays
  std::size_t count;
};

/// Sums over the modules.
struct TankSteps {
  double now = 0.0;     ///< slope times the step just made
  double next = 0.0;    ///< times the step to come, as the forces are
  double give = 0.0;    ///< slope^2 h^2/M
  double worked = 0.0;  ///< the last force times the step just made
};

/// Realtime: yes
template <class Real>
TankSteps measureSteps(const TankModules<Real>& m, const Real* slope, const Real* last) noexcept {
  Sum now;
  Sum next;
  Sum give;
  Sum worked;
  for (std::size_t k = 0; k < m.count; ++k) {
    const std::size_t i = m.indices[k];
    const auto r = static_cast<double>(slope[i]);
    const auto d = static_cast<double>(m.d[i]);
    const Real step = m.d[i] - (m.lose[i] * m.d[i] + m.pull[i] * m.x[i]) +
                      (m.inverse_mass[i] * m.f[i] + m.drift[i]);
    now.add(i, r * d);
    next.add(i, r * static_cast<double>(step));
    give.add(i, r * r * static_cast<double>(m.inverse_mass[i]));
    worked.add(i, static_cast<double>(last[i]) * d);
  }
  return {now.total(), next.total(), give.total(), worked.total()};
}

/// Slope times how far the forces move the modules in the step to come. Realtime: yes
template <class Real>
double pushOn(const TankModules<Real>& m, const Real* slope) noexcept {
  Sum push;
  for (std::size_t k = 0; k < m.count; ++k) {
    const std::size_t i = m.indices[k];
    push.add(i, static_cast<double>(slope[i]) *
                    (static_cast<double>(m.inverse_mass[i]) * static_cast<double>(m.f[i])));
  }
  return push.total();
}

/// Takes scale times slope from the forces, and adds it to `taken`. Realtime: yes
template <class Real>
void addForces(const std::vector<std::uint32_t>& indices,
               const Real* slope,
               Real scale,
               Real* f,
               Real* taken) noexcept {
#pragma GCC ivdep  // no index comes twice, and the arrays do not overlap
  for (const std::size_t i : indices) {
    const Real force = scale * slope[i];
    f[i] -= force;
    taken[i] += force;
  }
}

}  // namespace ergotic::physics::kernels
