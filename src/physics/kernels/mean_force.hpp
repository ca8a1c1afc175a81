// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "physics/layout/layout.hpp"
#include "physics/state/link_memory.hpp"
#include "scene/laws/law.hpp"

/// How the ends of a link feel its force. Between sections of different rates the slower end is
/// held between its own steps and feels the mean of the force over each of them.
/// Source: docs/physics/multirate.md, "Coupling of two rates".
namespace ergotic::physics::kernels {

using scene::Force;

/// The instrument's arrays, and how the ends of a run count in this frame.
template <class Real>
struct RunStep {
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

/// Half of the work of a force over the step in which the ends moved so far: each step is counted
/// with half of the force before it and half of that after it. Across rates a damper takes what
/// both sides do against it: the jumps of a held end are no motion of anything. What they do to a
/// spring nobody does; against what the slower end does in the same step, it is made.
template <class Real>
void addHalfWork(
    const LinkRun& run, Real moved_a, Real moved_b, Force<Real> force, LinkWork& work) noexcept {
  const Real sum = force.elastic + force.viscous;
  work.stored += 0.5 * static_cast<double>((moved_a - moved_b) * force.elastic);
  if (run.slow_section < 0) {
    work.dissipated += 0.5 * static_cast<double>((moved_a - moved_b) * force.viscous);
    work.on_a -= 0.5 * static_cast<double>(moved_a * sum);
    work.on_b += 0.5 * static_cast<double>(moved_b * sum);
  } else {
    const Real fast = run.slow_is_a ? moved_b : -moved_a;
    const Real jump = run.slow_is_a ? moved_a : -moved_b;
    (run.slow_is_a ? work.on_b : work.on_a) += 0.5 * static_cast<double>(fast * sum);
    work.dissipated -= 0.5 * static_cast<double>(fast * force.viscous);
    work.made += 0.5 * static_cast<double>(jump * force.elastic);
  }
}

/// The slower end feels 1/R of the force in each of the R steps of the faster one.
template <class Real>
void addToMean(const LinkRun& run,
               const RunStep<Real>& at,
               std::size_t index,
               Force<Real> force) noexcept {
  const Real share = run.slow_is_a ? at.share_a : at.share_b;
  at.memory.mean[index] += share * (force.elastic + force.viscous);
  at.memory.mean_viscous[index] += share * force.viscous;
}

/// Counts one coordinate of one link, if anybody asks, and hands its force out.
template <class Real>
void exchangeForce(const LinkRun& run,
                   const RunStep<Real>& at,
                   std::size_t index,
                   int a,
                   int b,
                   Force<Real> force) noexcept {
  const LinkMemory<Real>& memory = at.memory;
  if (at.work != nullptr) {
    const Force<Real> both{force.elastic + memory.elastic[index],
                           force.viscous + memory.viscous[index]};
    addHalfWork(run, at.gate_a * at.moved[a], at.gate_b * at.moved[b], both, *at.work);
  }
  if (memory.elastic != nullptr) {
    memory.elastic[index] = force.elastic;
    memory.viscous[index] = force.viscous;
  }
  const Real sum = force.elastic + force.viscous;
  if (run.slow_section >= 0) {
    addToMean(run, at, index, force);
  }
  at.f[a] -= at.share_a * sum;
  at.f[b] += at.share_b * sum;
}

/// Work on the slower end, which moved by `moved`, with the mean force so far in its step.
template <class Real>
void addWorkOfMean(const LinkRun& run,
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
  work.made += 0.5 * signed_moved * (mean - viscous);
}

/// The slower end has moved by d under the mean force: its side of the energy accounts closes.
template <class Real>
void closeMean(
    const LinkRun& run, const RunStep<Real>& at, std::size_t index, int a, int b) noexcept {
  if (at.work != nullptr) {
    addWorkOfMean(run, at.memory, index, static_cast<double>(at.moved[run.slow_is_a ? a : b]),
                  *at.work);
  }
  const LinkMemory<Real>& memory = at.memory;
  memory.last_mean[index] = memory.mean[index];
  memory.last_mean_viscous[index] = memory.mean_viscous[index];
  memory.mean[index] = Real(0);
  memory.mean_viscous[index] = Real(0);
}

}  // namespace ergotic::physics::kernels
