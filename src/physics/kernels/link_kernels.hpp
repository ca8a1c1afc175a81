// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "physics/laws/laws.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/link_memory.hpp"

/// What links do in one step: forces from positions, and the work they take and lose.
/// Work over a step is d[n] (F[n-1] + F[n]) / 2, with F[n-1] remembered where it cannot be worked
/// out from positions. Source: docs/physics.md, "Energy".
namespace ergotic::physics::kernels {

/// The instrument's arrays, and how the ends of a run count in this frame.
template <class Real>
struct Frame {
  const Real* x;
  const Real* d;
  const Real* moved;   ///< d, and for points the change of their place too
  const Real* d_last;  ///< d of the step before
  Real* f;
  Real gate_a;  ///< 0 while an end is held, else 1
  Real gate_b;
  Real share_a;  ///< of the force that an end receives in this frame
  Real share_b;
  bool slow_ends;  ///< the slower end's step ends with this frame
  LinkMemory<Real> memory;
  LinkWork* work;  ///< null: nobody asks
};

/// Plain runs: linear, scalar, inside one section.
template <bool kMetered, class Real, class Law>
void stepPlain(const LinkRun& run, const Law& law, const Frame<Real>& at) noexcept {
  const LinkEnds* ends = run.ends.data();
  const std::size_t links = run.ends.size();
  const Real* x = at.x;
  const Real* d = at.d;
  const Real* moved = at.moved;
  const Real* d_last = at.d_last;
  Real* f = at.f;
  // What a link loses, twice over.
  const auto stepLink = [=](std::size_t l) noexcept {
    const int a = ends[l].a;
    const int b = ends[l].b;
    const Real v = d[a] - d[b];
    const laws::Force<Real> force = law.force(l, x[a] - x[b], v);
    const Real sum = force.elastic + force.viscous;
    f[a] -= sum;
    f[b] += sum;
    if constexpr (!kMetered) {
      return Real(0);
    }
    // The damper's last force is the damping times the last v.
    return (moved[a] - moved[b]) * law.c(1, l) * (v + (d_last[a] - d_last[b]));
  };
  Real lost[4] = {};  // four sums, as one would wait for each addition
  std::size_t l = 0;
  for (; l + 4 <= links; l += 4) {
    for (std::size_t k = 0; k < 4; ++k) {
      lost[k] += stepLink(l + k);
    }
  }
  for (; l < links; ++l) {
    lost[0] += stepLink(l);
  }
  if constexpr (kMetered) {
    at.work->dissipated += 0.5 * static_cast<double>((lost[0] + lost[1]) + (lost[2] + lost[3]));
  }
}

/// Half of the work of a force over the step in which the ends moved so far: each step is booked
/// with half of the force before it and half of that after it. Across rates a damper takes what
/// both sides do against it: the jumps of a held end are no motion of anything.
template <class Real>
void addHalfWork(const LinkRun& run,
                 Real moved_a,
                 Real moved_b,
                 laws::Force<Real> force,
                 LinkWork& work) noexcept {
  const Real sum = force.elastic + force.viscous;
  work.stored += 0.5 * static_cast<double>((moved_a - moved_b) * force.elastic);
  if (run.slow_section < 0) {
    work.dissipated += 0.5 * static_cast<double>((moved_a - moved_b) * force.viscous);
    work.on_a -= 0.5 * static_cast<double>(moved_a * sum);
    work.on_b += 0.5 * static_cast<double>(moved_b * sum);
  } else {
    const Real fast = run.slow_is_a ? moved_b : -moved_a;
    (run.slow_is_a ? work.on_b : work.on_a) += 0.5 * static_cast<double>(fast * sum);
    work.dissipated -= 0.5 * static_cast<double>(fast * force.viscous);
  }
}

/// Books one coordinate of one link, if anybody asks, and hands its force out.
template <class Real>
void exchangeForce(const LinkRun& run,
                   const Frame<Real>& at,
                   std::size_t index,
                   int a,
                   int b,
                   laws::Force<Real> force) noexcept {
  const LinkMemory<Real>& memory = at.memory;
  if (at.work != nullptr) {
    const laws::Force<Real> both{force.elastic + memory.elastic[index],
                                 force.viscous + memory.viscous[index]};
    addHalfWork(run, at.gate_a * at.moved[a], at.gate_b * at.moved[b], both, *at.work);
  }
  if (memory.elastic != nullptr) {
    memory.elastic[index] = force.elastic;
    memory.viscous[index] = force.viscous;
  }
  const Real sum = force.elastic + force.viscous;
  if (run.slow_section >= 0) {
    const Real share = run.slow_is_a ? at.share_a : at.share_b;
    memory.mean[index] += share * sum;
    memory.mean_viscous[index] += share * force.viscous;
  }
  at.f[a] -= at.share_a * sum;
  at.f[b] += at.share_b * sum;
}

/// Work on the slower end, which moved by `moved`, with the mean force so far in its step.
template <class Real>
void addSlowWork(const LinkRun& run,
                 const LinkMemory<Real>& memory,
                 std::size_t index,
                 double moved,
                 LinkWork& work) noexcept {
  const double signed_moved = run.slow_is_a ? -moved : moved;
  const auto mean = static_cast<double>(memory.mean[index] + memory.last_mean[index]);
  const auto viscous =
      static_cast<double>(memory.mean_viscous[index] + memory.last_mean_viscous[index]);
  (run.slow_is_a ? work.on_a : work.on_b) += 0.5 * signed_moved * mean;
  work.dissipated -= 0.5 * signed_moved * viscous;
}

/// The slower end has moved by d under the mean force: its side of the books closes.
template <class Real>
void closeSlowStep(
    const LinkRun& run, const Frame<Real>& at, std::size_t index, int a, int b) noexcept {
  if (at.work != nullptr) {
    addSlowWork(run, at.memory, index, static_cast<double>(at.moved[run.slow_is_a ? a : b]),
                *at.work);
  }
  const LinkMemory<Real>& memory = at.memory;
  memory.last_mean[index] = memory.mean[index];
  memory.last_mean_viscous[index] = memory.mean_viscous[index];
  memory.mean[index] = Real(0);
  memory.mean_viscous[index] = Real(0);
}

/// Scalar runs that are nonlinear, or between sections.
template <class Real, class Law>
void stepScalar(const LinkRun& run, const Law& law, const Frame<Real>& at) noexcept {
  for (std::size_t l = 0; l < run.ends.size(); ++l) {
    const int a = run.ends[l].a;
    const int b = run.ends[l].b;
    const Real v = at.gate_a * at.d[a] - at.gate_b * at.d[b];
    exchangeForce(run, at, l, a, b, law.force(l, at.x[a] - at.x[b], v));
    if (at.slow_ends) {
      closeSlowStep(run, at, l, a, b);
    }
  }
}

/// A vector of up to three coordinates.
template <class Real, int D>
struct Vector {
  Real at[D];
  Real norm() const noexcept {
    Real sum(0);
    for (int c = 0; c < D; ++c) {
      sum += at[c] * at[c];
    }
    return std::sqrt(sum);
  }
};

/// Euclidean runs. The force is along the line that joins the ends (n), or, for friction, along
/// their relative velocity; without a direction there is no force.
template <class Real, int D, class Law>
void stepSpatial(const LinkRun& run,
                 const Law& law,
                 const Real* rests,
                 const Frame<Real>& at) noexcept {
  const std::size_t links = run.ends.size();
  for (std::size_t l = 0; l < links; ++l) {
    const LinkEnds ends = run.ends[l];
    Vector<Real, D> apart;
    Vector<Real, D> velocity;
    for (int c = 0; c < D; ++c) {
      const int a = ends.a + c * run.stride_a;
      const int b = ends.b + c * run.stride_b;
      apart.at[c] = at.x[a] - at.x[b] + rests[static_cast<std::size_t>(c) * links + l];
      velocity.at[c] = at.gate_a * at.d[a] - at.gate_b * at.d[b];
    }
    const bool friction = Law::kKind == laws::Kind::kFriction;
    const Vector<Real, D>& line = friction ? velocity : apart;
    const Real length = line.norm();
    const Real sign = Law::kKind == laws::Kind::kGap ? Real(-1) : Real(1);
    const Real scale = length > Real(0) ? sign / length : Real(0);
    Real v = length;
    if (!friction) {
      v = Real(0);
      for (int c = 0; c < D; ++c) {
        v += scale * line.at[c] * velocity.at[c];
      }
    }
    const laws::Force<Real> force = law.force(l, sign * length, v);
    for (int c = 0; c < D; ++c) {
      const Real n = scale * line.at[c];
      const int a = ends.a + c * run.stride_a;
      const int b = ends.b + c * run.stride_b;
      const std::size_t index = static_cast<std::size_t>(c) * links + l;
      exchangeForce(run, at, index, a, b, {n * force.elastic, n * force.viscous});
      if (at.slow_ends) {
        closeSlowStep(run, at, index, a, b);
      }
    }
  }
}

/// What a link holds at the start: the integral of its elastic force from where it is none.
template <class Real, class Law>
double storedAtStart(const Law& law, std::size_t l, Real u) noexcept {
  if constexpr (Law::kKind == laws::Kind::kFriction) {
    return 0.0;
  } else {
    constexpr int kIntervals = 64;  // Simpson
    const double from = -static_cast<double>(law.offset(l));
    const double width = (static_cast<double>(u) - from) / kIntervals;
    double sum = 0.0;
    for (int i = 0; i <= kIntervals; ++i) {
      const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 0 ? 2.0 : 4.0);
      const Real at = static_cast<Real>(from + i * width);
      sum += weight * static_cast<double>(law.force(l, at, Real(0)).elastic);
    }
    return sum * width / 3.0;
  }
}

template <class Real, class Law>
void step(const LinkRun& run, const Law& law, const Real* rests, const Frame<Real>& at) noexcept {
  switch (run.dimensions) {
    case 0:
      if constexpr (Law::kKind == laws::Kind::kLinear) {
        if (at.memory.elastic == nullptr) {
          return at.work != nullptr ? stepPlain<true>(run, law, at)
                                    : stepPlain<false>(run, law, at);
        }
      }
      return stepScalar(run, law, at);
    case 1:
      return stepSpatial<Real, 1>(run, law, rests, at);
    case 2:
      return stepSpatial<Real, 2>(run, law, rests, at);
    default:
      return stepSpatial<Real, 3>(run, law, rests, at);
  }
}

}  // namespace ergotic::physics::kernels
