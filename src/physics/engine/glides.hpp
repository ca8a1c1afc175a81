// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Slices that faster sections see glide. Their forces are collected with the weights by which they
/// have moved, each step with half of the force before it and half of that after it, as the books
/// have it: so the work of the hand is that on the faster side, to rounding.
/// Realtime: yes. Source: docs/physics.md, "Hands that glide".
template <class Real>
class Glides {
 public:
  explicit Glides(const Layout& layout) : layout_(layout) {}

  /// Where they are seen before anything moves.
  void placeAtStart(Real* x) const noexcept {
    for (const Glide& glide : layout_.glides) {
      for (int k = 0; k < glide.dimensions; ++k) {
        x[glide.slot + k] = x[glide.of.slot + k * glide.of.stride];
      }
    }
  }

  /// A step of those whose sections are due. \pre the slices have moved
  void gather(const Group& group, std::int64_t now, State<Real>& state) const noexcept {
    Real* x = state.x();
    Real* d = state.d();
    for (const std::size_t g : group.glides) {
      const Glide& glide = layout_.glides[g];
      if (!layout_.isDue(glide.section, now)) {
        continue;
      }
      const GlideStep& step = stepAt(glide, now);
      for (int k = 0; k < glide.dimensions; ++k) {
        const int slot = glide.slot + k;
        const int of = glide.of.slot + k * glide.of.stride;
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
    for (const std::size_t g : group.glides) {
      const Glide& glide = layout_.glides[g];
      if (!layout_.isDue(glide.section, now + 1)) {
        continue;
      }
      const GlideStep& step = stepAt(glide, now);
      for (int k = 0; k < glide.dimensions; ++k) {
        GlideForce<Real>& force = state.glideForces()[glide.coordinate + k];
        const Real mean = (force.last + state.f()[glide.slot + k]) / Real(2);
        force.answer += static_cast<Real>(step.share_last) * mean;
        force.next += static_cast<Real>(step.share) * mean;
        force.last = state.f()[glide.slot + k];
      }
    }
  }

  /// Gives the slices of a group their forces, if a tick ends with frame `now`.
  /// \pre those of all groups are collected
  void answer(const Group& group, std::int64_t now, State<Real>& state) const noexcept {
    for (const std::size_t g : group.answered) {
      const Glide& glide = layout_.glides[g];
      if (!layout_.isDue(glide.of.section, now + 1)) {
        continue;
      }
      for (int k = 0; k < glide.dimensions; ++k) {
        GlideForce<Real>& force = state.glideForces()[glide.coordinate + k];
        state.f()[glide.of.slot + k * glide.of.stride] += force.answer;
        force.answer = force.next;
        force.next = Real(0);
      }
    }
  }

 private:
  const GlideStep& stepAt(const Glide& glide, std::int64_t now) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(glide.section)];
    return glide.steps[static_cast<std::size_t>(now / range.divisor) % glide.steps.size()];
  }

  const Layout& layout_;
};

}  // namespace ergotic::physics
