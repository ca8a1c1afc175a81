// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/kernels/mean_force.hpp"
#include "physics/layout/layout.hpp"
#include "scene/laws/law.hpp"

/// Kernels of links: in one step, their forces from positions, and the work they store and lose.
/// Work over a step is d[n] (F[n-1] + F[n]) / 2, with F[n-1] remembered where it cannot be worked
/// out from positions. Source: docs/physics/accuracy.md, "Energy accounting".
namespace ergotic::physics::kernels {

using scene::Force;
using scene::RunNumbers;

/// Plain runs: spring-dampers, scalar, inside one section.
template <bool kMetered, class Real>
void stepPlain(const LinkRun& run, const RunNumbers<Real>& c, const RunStep<Real>& at) noexcept {
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
    const Real sum = c(0, l) * (x[a] - x[b] + c(2, l)) + c(1, l) * v;
    f[a] -= sum;
    f[b] += sum;
    if constexpr (!kMetered) {
      return Real(0);
    }
    // The damper's last force is the damping times the last v.
    return (moved[a] - moved[b]) * c(1, l) * (v + (d_last[a] - d_last[b]));
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

constexpr std::size_t kTogether = 64;  ///< links whose forces a law works out in one call

/// Visits a run in pieces: `visit(first, count)`.
template <class Visit>
void forEachPiece(const LinkRun& run, const Visit& visit) noexcept {
  for (std::size_t first = 0; first < run.ends.size(); first += kTogether) {
    visit(first, std::min(kTogether, run.ends.size() - first));
  }
}

/// Scalar runs that are nonlinear, or between sections.
template <class Real>
void stepScalar(const LinkRun& run, const RunNumbers<Real>& c, const RunStep<Real>& at) noexcept {
  const scene::RunForces<Real> forces = scene::lawOf(run.law).explicit_form.forces<Real>();
  Real u[kTogether];
  Real v[kTogether];
  Force<Real> force[kTogether];
  forEachPiece(run, [&](std::size_t first, std::size_t count) {
    const LinkEnds* ends = run.ends.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = at.x[ends[i].a] - at.x[ends[i].b];
      v[i] = at.gate_a * at.d[ends[i].a] - at.gate_b * at.d[ends[i].b];
    }
    forces(c, first, count, u, v, force);
    for (std::size_t i = 0; i < count; ++i) {
      exchangeForce(run, at, first + i, ends[i].a, ends[i].b, force[i]);
      if (at.slow_ends) {
        closeMean(run, at, first + i, ends[i].a, ends[i].b);
      }
    }
  });
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

/// A piece of a Euclidean run: where its laws act, and along which unit vectors.
template <class Real, int D>
struct Lines {
  Real u[kTogether];
  Real v[kTogether];
  Real n[D][kTogether];
};

/// The line of a link joins its ends, or, for friction, is along their relative velocity; without a
/// direction there is no force.
template <class Real, int D>
void drawLines(const LinkRun& run,
               std::size_t first,
               std::size_t count,
               const Real* rests,
               const RunStep<Real>& at,
               Lines<Real, D>& lines) noexcept {
  const scene::Law::Kind kind = scene::lawOf(run.law).kind;
  const bool friction = kind == scene::Law::Kind::kFriction;
  const Real sign = kind == scene::Law::Kind::kGap ? Real(-1) : Real(1);
  const std::size_t links = run.ends.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LinkEnds ends = run.ends[first + i];
    Vector<Real, D> apart;
    Vector<Real, D> velocity;
    for (int c = 0; c < D; ++c) {
      const int a = ends.a + c * run.stride_a;
      const int b = ends.b + c * run.stride_b;
      apart.at[c] = at.x[a] - at.x[b] + rests[static_cast<std::size_t>(c) * links + first + i];
      velocity.at[c] = at.gate_a * at.d[a] - at.gate_b * at.d[b];
    }
    const Vector<Real, D>& line = friction ? velocity : apart;
    const Real length = line.norm();
    const Real scale = length > Real(0) ? sign / length : Real(0);
    Real v = Real(0);
    for (int c = 0; c < D; ++c) {
      lines.n[c][i] = scale * line.at[c];
      v += lines.n[c][i] * velocity.at[c];
    }
    lines.u[i] = sign * length;
    lines.v[i] = friction ? length : v;
  }
}

template <class Real, int D>
void stepSpatial(const LinkRun& run,
                 const RunNumbers<Real>& numbers,
                 const Real* rests,
                 const RunStep<Real>& at) noexcept {
  const scene::RunForces<Real> forces = scene::lawOf(run.law).explicit_form.forces<Real>();
  const std::size_t links = run.ends.size();
  Lines<Real, D> lines;
  Force<Real> force[kTogether];
  forEachPiece(run, [&](std::size_t first, std::size_t count) {
    drawLines(run, first, count, rests, at, lines);
    forces(numbers, first, count, lines.u, lines.v, force);
    for (std::size_t i = 0; i < count; ++i) {
      for (int c = 0; c < D; ++c) {
        const Real n = lines.n[c][i];
        const int a = run.ends[first + i].a + c * run.stride_a;
        const int b = run.ends[first + i].b + c * run.stride_b;
        const std::size_t index = static_cast<std::size_t>(c) * links + first + i;
        exchangeForce(run, at, index, a, b, {n * force[i].elastic, n * force[i].viscous});
        if (at.slow_ends) {
          closeMean(run, at, index, a, b);
        }
      }
    }
  });
}

/// Energy that a link stores after the first step: the integral of its elastic force from where
/// that is 0, less the half of that step's work with which the energy accounts begin.
/// \param moved  by how much the step has changed u
template <class Real>
double storedAtStart(
    const scene::Law& law, const RunNumbers<Real>& c, std::size_t l, Real u, Real moved) noexcept {
  if (law.kind == scene::Law::Kind::kFriction) {
    return 0.0;
  }
  constexpr int kIntervals = 64;  // Simpson
  const scene::RunForces<Real> forces = law.explicit_form.forces<Real>();
  const double from = -static_cast<double>(c(law.explicit_form.offset, l));
  const double width = (static_cast<double>(u) - from) / kIntervals;
  double sum = 0.0;
  Force<Real> force{};
  for (int i = 0; i <= kIntervals; ++i) {
    const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 0 ? 2.0 : 4.0);
    const Real at = static_cast<Real>(from + i * width);
    const Real still = Real(0);
    forces(c, l, 1, &at, &still, &force);
    sum += weight * static_cast<double>(force.elastic);
  }
  return sum * width / 3.0 - 0.5 * static_cast<double>(moved * force.elastic);
}

template <class Real>
void stepByLaw(const LinkRun& run,
               const RunNumbers<Real>& c,
               const Real* rests,
               const RunStep<Real>& at) noexcept {
  switch (run.dimensions) {
    case 0:
      return stepScalar(run, c, at);
    case 1:
      return stepSpatial<Real, 1>(run, c, rests, at);
    case 2:
      return stepSpatial<Real, 2>(run, c, rests, at);
    default:
      return stepSpatial<Real, 3>(run, c, rests, at);
  }
}

template <class Real>
void step(const LinkRun& run,
          RunNumbers<Real> c,
          const Real* rests,
          const RunStep<Real>& at) noexcept {
  const bool is_linear = scene::lawOf(run.law).kind == scene::Law::Kind::kLinear;
  if (run.dimensions == 0 && is_linear && at.memory.elastic == nullptr) {
    return at.work != nullptr ? stepPlain<true>(run, c, at) : stepPlain<false>(run, c, at);
  }
  if (at.work == nullptr) {
    return stepByLaw(run, c, rests, at);
  }
  double lost = 0.0;
  c.lost = &lost;
  stepByLaw(run, c, rests, at);
  at.work->stored -= lost;
  at.work->dissipated += lost;
}

}  // namespace ergotic::physics::kernels
