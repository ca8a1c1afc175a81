// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"
#include "physics/engine/energy_meter.hpp"
#include "physics/engine/points.hpp"
#include "physics/engine/stored_energy.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Puts quiet sections to rest: one whose energy has fallen below its limit, and on which no link
/// of another section pulls, is stepped no more until a force comes. By itself it rests at 0;
/// linked to others it stops where it is, for a jump would stretch what it is attached to, with the
/// forces of its springs, so that the step in which it wakes is one like any other. The error is
/// bounded (docs/physics/schemes.md, "Defaults that are resolved").
template <class Real>
class Sleeper {
 public:
  /// \throws Exception if a section that may sleep does not rest at 0, or is not linear
  Sleeper(const scene::Scene& scene,
          const Layout& layout,
          const Points<Real>& points,
          const CoefficientsOf<Real>& c)
      : layout_(layout), points_(points), limits_(scene.sections.size()) {
    for (int s = 0; s < static_cast<int>(scene.sections.size()); ++s) {
      Limit& limit = limits_[static_cast<std::size_t>(s)];
      limit.energy = scene.sections[static_cast<std::size_t>(s)].sleep_energy;
      if (limit.energy > 0.0) {
        checkRest(scene, s, c);
        for (std::size_t r = 0; r < layout.runs.size(); ++r) {
          const LinkRun& run = layout.runs[r];
          if ((run.section_a == s) != (run.section_b == s)) {
            limit.joins.push_back(r);
          } else if (run.section_a == s) {
            limit.springs.push_back(r);
          }
        }
        findFeeds(scene, s, c, limit);
      }
    }
  }

  /// Ends the frames from `first` on, once all their forces are known.
  /// \param is_held  whether a hand holds something in a section. Realtime: yes
  template <class IsHeld>
  void endFrames(const Group& group,
                 std::int64_t first,
                 const CoefficientsOf<Real>& c,
                 const EnergyMeter<Real>& meter,
                 State<Real>& state,
                 const IsHeld& is_held) const noexcept {
    for (const int section : group.sections) {
      const Limit& limit = limits_[static_cast<std::size_t>(section)];
      if (limit.energy == 0.0 || is_held(section)) {
        continue;
      }
      unsigned char& asleep = state.asleep()[section];
      const int divisor = layout_.sections[static_cast<std::size_t>(section)].divisor;
      if (asleep != 0) {
        asleep = isTouched(section, state) || isFed(limit, c, state) ? 0 : 1;
      } else if (first % (kStepsBetween * divisor) == 0 && !isTouched(section, state)) {
        const double energy = meter.storedIn(section, c, state);
        if (energy < limit.energy && restsWithNoMore(section, c, state)) {
          stop(group, section, c, state);
          meter.addDissipated(section, energy - meter.storedIn(section, c, state), state);
          asleep = 1;
        }
      }
    }
  }

 private:
  static constexpr std::int64_t kStepsBetween = 64;  // the energy costs as much as a step
  /// A spring that ends where force is fed in.
  struct Spring {
    std::size_t run = 0;
    BlockLink link;  // of runs that are in no block `place` is the link
    LinkEnds ends;
  };
  struct Fed {
    int slot = 0;
    std::vector<Spring> springs;
  };
  struct Limit {
    double energy = 0.0;               // 0: it never sleeps
    std::vector<std::size_t> joins;    // runs that end in it and elsewhere
    std::vector<std::size_t> springs;  // runs inside whose forces it keeps
    std::vector<Fed> feeds;
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
      refuse(scene, section,
             "allowed are scalar sections of masses, cells and spring-dampers that rest at 0 (no "
             "gravity, no rest lengths)");
    }
  }

  /// A force that is fed in is known by what else there is: what springs between modules hold.
  /// Points and taps would spread theirs.
  void findFeeds(const scene::Scene& scene,
                 int section,
                 const CoefficientsOf<Real>& c,
                 Limit& limit) const {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    const auto isModule = [&](int slot) { return slot >= range.first && slot < range.end; };
    for (const Feed& feed : layout_.feeds) {
      if (feed.section != section) {
        continue;
      }
      Fed fed{feed.slot, {}};
      for (const std::size_t r : limit.joins.empty() ? std::vector<std::size_t>() : limit.springs) {
        forEachSpring(r, c, [&](const BlockLink& link, int a, int b) {
          if (!isModule(a) || !isModule(b)) {
            refuse(scene, section,
                   "allowed is, where it is linked to others, a force that is fed in or springs of "
                   "its own at taps and points, not both");
          }
          if (a == feed.slot || b == feed.slot) {
            fed.springs.push_back({r, link, {a, b}});
          }
        });
      }
      limit.feeds.push_back(std::move(fed));
    }
  }

  [[noreturn]] static void refuse(const scene::Scene& scene,
                                  int section,
                                  const std::string& allowed) {
    const scene::Section& named = scene.sections[static_cast<std::size_t>(section)];
    throw TextError(scene.file, named.place.line, named.place.column,
                    "section '" + named.name + "' cannot sleep: " + allowed);
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
    return false;
  }

  /// Whether one that sleeps gets a force from an input: by the same sums as `pull`.
  bool isFed(const Limit& limit,
             const CoefficientsOf<Real>& c,
             const State<Real>& state) const noexcept {
    return std::any_of(limit.feeds.begin(), limit.feeds.end(), [&](const Fed& fed) {
      Real kept(0);
      for (const Spring& spring : fed.springs) {
        const LinkEnds& ends = spring.ends;
        const Real force =
            stiffness(spring.run, spring.link, c) * (state.x()[ends.a] - state.x()[ends.b]);
        kept -= ends.a == fed.slot ? force : Real(0);
        kept += ends.b == fed.slot ? force : Real(0);
      }
      return state.f()[fed.slot] != kept;
    });
  }

  /// True if stopping adds no energy: springs keep what they hold. If successive steps are nearly
  /// opposite, kinetic energy counts below 0, and a stop would leave more than there was.
  bool restsWithNoMore(int section,
                       const CoefficientsOf<Real>& c,
                       const State<Real>& state) const noexcept {
    const auto s = static_cast<std::size_t>(section);
    return limits_[s].joins.empty() || kineticOf(layout_.sections[s], c.masses, state) >= 0.0;
  }

  void stop(const Group& group,
            int section,
            const CoefficientsOf<Real>& c,
            State<Real>& state) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    const Limit& limit = limits_[static_cast<std::size_t>(section)];
    const bool is_alone = limit.joins.empty();
    for (Real* values : {is_alone ? state.x() : state.d(), state.d(), state.dLast(), state.f()}) {
      for (int k = 0; k < range.dimensions; ++k) {
        std::fill(values + range.first + k * range.stride, values + range.fixed + k * range.stride,
                  Real(0));
      }
    }
    if (!is_alone) {
      forEachPoint(group, section, [&](const auto& point, const auto& /*scatter*/) {
        std::fill_n(state.f() + point.slot, point.dimensions, Real(0));
      });
      for (const std::size_t r : limit.springs) {
        pull(r, c, state);
      }
      forEachPoint(group, section,
                   [&](const auto& /*point*/, const auto& scatter) { scatter(state); });
    }
  }

  /// Places, then taps, on which they may lie: as forces go on.
  template <class Function>
  void forEachPoint(const Group& group, int section, const Function& function) const noexcept {
    for (const std::size_t p : group.places) {
      if (layout_.places[p].section == section) {
        function(layout_.places[p],
                 [&](State<Real>& state) { points_.scatterPlace(p, state.f(), state.places()); });
      }
    }
    for (const std::size_t t : group.taps) {
      if (layout_.taps[t].section == section) {
        function(layout_.taps[t],
                 [&](State<Real>& state) { points_.taps().scatter(t, state.f(), state.f()); });
      }
    }
  }

  /// Adds the forces of springs on modules at rest.
  void pull(std::size_t run, const CoefficientsOf<Real>& c, State<Real>& state) const noexcept {
    forEachSpring(run, c, [&](const BlockLink& link, int a, int b) {
      const Real force = stiffness(run, link, c) * (state.x()[a] - state.x()[b]);
      state.f()[a] -= force;
      state.f()[b] += force;
    });
  }

  template <class Visit>
  void forEachSpring(std::size_t r, const CoefficientsOf<Real>& c, const Visit& visit) const {
    const LinkRun& run = layout_.runs[r];
    if (run.block >= 0) {
      forEachLink(layout_.blocks[static_cast<std::size_t>(run.block)], run, c.masses, visit);
      return;
    }
    for (std::size_t l = 0; l < run.ends.size(); ++l) {
      visit(BlockLink{l, 0, 0}, run.ends[l].a, run.ends[l].b);
    }
  }

  Real stiffness(std::size_t r,
                 const BlockLink& link,
                 const CoefficientsOf<Real>& c) const noexcept {
    const int block = layout_.runs[r].block;
    return block < 0 ? c.runs[r].fields[link.place]
                     : stiffnessOf(layout_.blocks[static_cast<std::size_t>(block)],
                                   c.blocks[static_cast<std::size_t>(block)], link);
  }

  const Layout& layout_;
  const Points<Real>& points_;
  std::vector<Limit> limits_;  // [sections]
};

}  // namespace ergotic::physics
