// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "ergotic/exception.hpp"
#include "physics/engine/energy_meter.hpp"
#include "physics/engine/stored_energy.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Puts quiet sections to rest: one whose energy has fallen below its limit, and on which no link
/// of another section pulls, is stepped no more until a force comes. By itself it rests at 0;
/// linked to others it stops where it is, for a jump would stretch what it hangs on. The error is
/// bounded (docs/physics.md, "Model no more than a scene needs").
template <class Real>
class Sleeper {
 public:
  /// \throws Exception if a section that may sleep does not rest at 0, or is not linear
  Sleeper(const scene::Scene& scene, const Layout& layout, const CoefficientsOf<Real>& c)
      : layout_(layout), limits_(scene.sections.size()) {
    for (int s = 0; s < static_cast<int>(scene.sections.size()); ++s) {
      Limit& limit = limits_[static_cast<std::size_t>(s)];
      limit.energy = scene.sections[static_cast<std::size_t>(s)].sleep_energy;
      if (limit.energy > 0.0) {
        checkRest(scene, s, c);
        for (std::size_t r = 0; r < layout.runs.size(); ++r) {
          if ((layout.runs[r].section_a == s) != (layout.runs[r].section_b == s)) {
            limit.joins.push_back(r);
          }
        }
      }
    }
  }

  /// After all forces of the frames from `first` on are known. Realtime: yes
  void endFrames(const Group& group,
                 std::int64_t first,
                 const CoefficientsOf<Real>& c,
                 const EnergyMeter<Real>& meter,
                 State<Real>& state) const noexcept {
    for (const int section : group.sections) {
      const Limit& limit = limits_[static_cast<std::size_t>(section)];
      if (limit.energy == 0.0) {
        continue;
      }
      unsigned char& asleep = state.asleep()[section];
      const int divisor = layout_.sections[static_cast<std::size_t>(section)].divisor;
      if (asleep != 0) {
        asleep = isTouched(section, state) ? 0 : 1;
      } else if (first % (kStepsBetween * divisor) == 0 && !isTouched(section, state)) {
        const double energy = meter.storedIn(section, c, state);
        if (energy < limit.energy && restsWithNoMore(section, c, state)) {
          stop(section, state);
          meter.addDissipated(section, energy - meter.storedIn(section, c, state), state);
          asleep = 1;
        }
      }
    }
  }

 private:
  static constexpr std::int64_t kStepsBetween = 64;  // the energy costs as much as a step
  struct Limit {
    double energy = 0.0;             // 0: it never sleeps
    std::vector<std::size_t> joins;  // runs that end in it and elsewhere
  };

  void checkRest(const scene::Scene& scene, int section, const CoefficientsOf<Real>& c) const {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    bool rests = true;
    for (int slot = range.first; slot < range.fixed; ++slot) {
      for (int k = 0; k < range.dimensions; ++k) {
        const auto here = static_cast<std::size_t>(slot + k * range.stride);
        rests = rests && c.masses.drift[here] == Real(0);
      }
    }
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      const LinkRun& run = layout_.runs[r];
      if (run.section_a != section || run.section_b != section) {
        continue;
      }
      const std::vector<Real>& fields = c.runs[r].fields;  // K, Z, then elongations at rest
      const auto offsets = fields.begin() + static_cast<std::ptrdiff_t>(2 * fields.size() / 3);
      const bool has_bias =
          run.block >= 0 ? layout_.blocks[static_cast<std::size_t>(run.block)].has_bias
                         : std::any_of(offsets, fields.end(), [](Real o) { return o != Real(0); });
      rests = rests && !remembers(run) && !has_bias;
    }
    if (!rests) {
      const scene::Section& named = scene.sections[static_cast<std::size_t>(section)];
      throw TextError(scene.file, named.place.line, named.place.column,
                      "section '" + named.name +
                          "' cannot sleep: allowed are scalar sections of masses, cells and "
                          "spring-dampers that rest at 0 (no gravity, no rest lengths)");
    }
  }

  /// Whether anything from outside pulls on a section, or has pulled on a slow one in this step.
  bool isTouched(int section, State<Real>& state) const noexcept {
    const auto is_touching = [](const Real* forces, std::size_t count) {
      return forces != nullptr &&
             std::any_of(forces, forces + count, [](Real force) { return force != Real(0); });
    };
    for (const std::size_t r : limits_[static_cast<std::size_t>(section)].joins) {
      const LinkMemory<Real> memory = state.memory(r);
      const std::size_t count = state.remembered(r);
      if (is_touching(memory.elastic, count) || is_touching(memory.viscous, count) ||
          is_touching(memory.mean, count) || is_touching(memory.last_mean, count)) {
        return true;
      }
    }
    return std::any_of(layout_.feeds.begin(), layout_.feeds.end(), [&](const Feed& feed) {
      return feed.section == section && state.asleep()[section] != 0 &&
             state.f()[feed.slot] != Real(0);
    });
  }

  /// What stops keeps what its springs hold. Where steps are nearly opposite, motion counts below
  /// 0, and that is more than the energy was.
  bool restsWithNoMore(int section,
                       const CoefficientsOf<Real>& c,
                       const State<Real>& state) const noexcept {
    const auto s = static_cast<std::size_t>(section);
    return limits_[s].joins.empty() || kineticOf(layout_.sections[s], c.masses, state) >= 0.0;
  }

  void stop(int section, State<Real>& state) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    const bool is_alone = limits_[static_cast<std::size_t>(section)].joins.empty();
    for (Real* values : {is_alone ? state.x() : state.d(), state.d(), state.dLast(), state.f()}) {
      for (int k = 0; k < range.dimensions; ++k) {
        std::fill(values + range.first + k * range.stride, values + range.fixed + k * range.stride,
                  Real(0));
      }
    }
  }

  const Layout& layout_;
  std::vector<Limit> limits_;  // [sections]
};

}  // namespace ergotic::physics
