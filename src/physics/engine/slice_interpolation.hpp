// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Slices that faster sections see interpolated. Their forces are collected with the weights by
/// which they have moved, each step with half of the force before it and half of that after it, as
/// the energy accounts have it: so the work of the hand is that on the faster side, to rounding.
/// Realtime: yes. Source: docs/physics/multirate.md, "Interpolated hands".
template <class Real>
class SliceInterpolation {
 public:
  explicit SliceInterpolation(const Layout& layout) : layout_(layout) {}

  /// Sets interpolated slices to their positions at the start.
  void placeAtStart(Real* x) const noexcept {
    for (const InterpolatedSlice& slice : layout_.interpolated) {
      for (int k = 0; k < slice.dimensions; ++k) {
        x[slice.slot + k] = x[slice.of.slot + k * slice.of.stride];
      }
    }
  }

  /// A step of those whose sections are due. \pre the slices have moved
  void gather(const Group& group, std::int64_t now, State<Real>& state) const noexcept {
    Real* x = state.x();
    Real* d = state.d();
    for (const std::size_t g : group.interpolated) {
      const InterpolatedSlice& slice = layout_.interpolated[g];
      if (!layout_.isDue(slice.section, now)) {
        continue;
      }
      const InterpolationStep& step = stepAt(slice, now);
      for (int k = 0; k < slice.dimensions; ++k) {
        const int slot = slice.slot + k;
        const int of = slice.of.slot + k * slice.of.stride;
        const Real last = state.dLast()[of];
        state.dLast()[slot] = d[slot];
        x[slot] = x[of] - static_cast<Real>(step.behind) * d[of] -
                  static_cast<Real>(step.behind_last) * last;
        d[slot] = static_cast<Real>(step.share) * d[of] + static_cast<Real>(step.share_last) * last;
        state.moved()[slot] = d[slot];
        state.f()[slot] = Real(0);
      }
    }
  }

  /// Takes the forces of the steps that end with frame `now`. \pre all of them are there
  void collect(const Group& group, std::int64_t now, State<Real>& state) const noexcept {
    for (const std::size_t g : group.interpolated) {
      const InterpolatedSlice& slice = layout_.interpolated[g];
      if (!layout_.isDue(slice.section, now + 1)) {
        continue;
      }
      const InterpolationStep& step = stepAt(slice, now);
      for (int k = 0; k < slice.dimensions; ++k) {
        InterpolatedForce<Real>& force = state.interpolatedForces()[slice.coordinate + k];
        const Real mean = (force.last + state.f()[slice.slot + k]) / Real(2);
        force.answer += static_cast<Real>(step.share_last) * mean;
        force.next += static_cast<Real>(step.share) * mean;
        force.last = state.f()[slice.slot + k];
      }
    }
  }

  /// Gives the slices of a group their forces, if a tick ends with frame `now`.
  /// \pre those of all groups are collected
  void answer(const Group& group, std::int64_t now, State<Real>& state) const noexcept {
    for (const std::size_t g : group.answered) {
      const InterpolatedSlice& slice = layout_.interpolated[g];
      if (!layout_.isDue(slice.of.section, now + 1)) {
        continue;
      }
      for (int k = 0; k < slice.dimensions; ++k) {
        InterpolatedForce<Real>& force = state.interpolatedForces()[slice.coordinate + k];
        state.f()[slice.of.slot + k * slice.of.stride] += force.answer;
        force.answer = force.next;
        force.next = Real(0);
      }
    }
  }

 private:
  const InterpolationStep& stepAt(const InterpolatedSlice& slice, std::int64_t now) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(slice.section)];
    return slice.steps[static_cast<std::size_t>(now / range.divisor) % slice.steps.size()];
  }

  const Layout& layout_;
};

}  // namespace ergotic::physics
