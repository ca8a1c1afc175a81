// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "physics/layout/layout.hpp"
#include "physics/state/arena.hpp"
#include "physics/state/link_memory.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {

/// A run remembers its forces if they cannot be worked out from positions: nonlinear laws,
/// distances, energy-stable links and links between sections.
inline bool remembers(const LinkRun& run) {
  return run.energy_stable || scene::lawOf(run.law).kind != scene::Law::Kind::kLinear ||
         run.dimensions > 0 || run.section_a != run.section_b || run.slow_section >= 0;
}

/// Force of explicit links on a coordinate of a grid point: mean over the step under way so far,
/// and over the last one.
template <class Real>
struct PlaceForce {
  static constexpr std::size_t kDoubles =
      sizeof(Real) == sizeof(double) ? 2 : 0;  ///< see numbersOf
  Real mean;
  Real last;
};

/// Force on an interpolated slice along a coordinate.
template <class Real>
struct InterpolatedForce {
  static constexpr std::size_t kDoubles =
      sizeof(Real) == sizeof(double) ? 3 : 0;  ///< see numbersOf
  Real last;                                   ///< the force of the last step
  Real answer;  ///< answer to its motion in the tick before: the tick under way ends with it
  Real next;    ///< answer to its motion in this tick, so far
};

/// All mutable state of an instrument, in one arena. Unmetered, it holds nothing that only the
/// energy accounts need: of links, only the memory of those between sections.
template <class Real>
class State {
 public:
  State(const Layout& layout, bool metered) : metered_(metered) {
    const auto slots = static_cast<std::size_t>(layout.slots());
    frame_at_ = arena_.add<std::int64_t>("frame", 1);
    x_at_ = arena_.add<Real>("x", slots);
    d_at_ = arena_.add<Real>("d", slots);
    d_last_at_ = arena_.add<Real>("d_last", slots);
    f_at_ = arena_.add<Real>("f", slots);
    moved_at_ = layout.places.empty() ? d_at_ : arena_.add<Real>("moved", slots);
    places_at_ = arena_.add<double>("places", 2 * layout.places.size());
    place_d_at_ = arena_.add<Real>("place_d", coordinatesOf(layout.places));
    place_forces_at_ = arena_.add<PlaceForce<Real>>("place_forces", coordinatesOf(layout.places));
    places_owe_at_ = arena_.add<double>("places_owe", layout.places.size());
    interpolated_forces_at_ =
        arena_.add<InterpolatedForce<Real>>("glide_forces", coordinatesOf(layout.interpolated));
    last_forces_at_ = arena_.add<Real>("last_force_outputs", layout.pickups.size());
    radiated_at_ = arena_.add<double>("radiated", static_cast<std::size_t>(layout.radiations));
    asleep_at_ = arena_.add<unsigned char>("asleep", layout.sections.size());
    work_at_ = arena_.add<LinkWork>("link_work", metered ? layout.runs.size() : 0);
    for (const LinkRun& run : layout.runs) {
      runs_.push_back(addRun(run));
    }
  }

  void allocate() { arena_.allocate(); }
  bool isMetered() const noexcept { return metered_; }
  Arena& arena() noexcept { return arena_; }
  const Arena& arena() const noexcept { return arena_; }

  std::int64_t& frame() noexcept { return *arena_.at<std::int64_t>(frame_at_); }
  std::int64_t frame() const noexcept { return *arena_.at<std::int64_t>(frame_at_); }
  Real* x() noexcept { return arena_.at<Real>(x_at_); }
  Real* d() noexcept { return arena_.at<Real>(d_at_); }
  Real* dLast() noexcept { return arena_.at<Real>(d_last_at_); }
  Real* f() noexcept { return arena_.at<Real>(f_at_); }
  const Real* moved() const noexcept { return arena_.at<Real>(moved_at_); }
  Real* moved() noexcept { return arena_.at<Real>(moved_at_); }  ///< d itself without places
  const Real* x() const noexcept { return arena_.at<Real>(x_at_); }
  const Real* d() const noexcept { return arena_.at<Real>(d_at_); }
  const Real* f() const noexcept { return arena_.at<Real>(f_at_); }
  /// [coordinates of places] what d would be had the place not moved
  Real* placeD() noexcept { return arena_.at<Real>(place_d_at_); }
  const Real* placeD() const noexcept { return arena_.at<Real>(place_d_at_); }
  /// [coordinates of places]
  PlaceForce<Real>* placeForces() noexcept { return arena_.at<PlaceForce<Real>>(place_forces_at_); }
  const PlaceForce<Real>* placeForces() const noexcept {
    return arena_.at<PlaceForce<Real>>(place_forces_at_);
  }
  /// [coordinates of interpolated slices]
  InterpolatedForce<Real>* interpolatedForces() noexcept {
    return arena_.at<InterpolatedForce<Real>>(interpolated_forces_at_);
  }
  /// [places] energy that moving it has brought beyond what it may bring, so far
  double* placesOwe() noexcept { return arena_.at<double>(places_owe_at_); }
  double* places() noexcept { return arena_.at<double>(places_at_); }
  Real* lastForces() noexcept { return arena_.at<Real>(last_forces_at_); }
  /// [Layout::radiations] memory of the high passes of outputs
  double* radiated() noexcept { return arena_.at<double>(radiated_at_); }
  unsigned char* asleep() noexcept { return arena_.at<unsigned char>(asleep_at_); }
  /// [runs], if metered
  LinkWork* work() noexcept { return arena_.at<LinkWork>(work_at_); }
  const LinkWork* work() const noexcept { return arena_.at<LinkWork>(work_at_); }

  LinkMemory<Real> memory(std::size_t run) noexcept {
    return split<Real>(runs_[run], arena_.at<Real>(runs_[run].memory));
  }
  LinkMemory<const Real> memory(std::size_t run) const noexcept {
    return split<const Real>(runs_[run], arena_.at<Real>(runs_[run].memory));
  }
  /// State of the law of a run, if the law has one, see scene::ExplicitForm.
  Real* lawState(std::size_t run) noexcept { return arena_.at<Real>(runs_[run].law_state); }
  /// Numbers in each array of the memory of a run; 0: it remembers nothing.
  std::size_t remembered(std::size_t run) const noexcept { return runs_[run].links; }

 private:
  struct RunEntries {
    std::size_t links = 0;
    bool across = false;
    std::size_t memory = 0;
    std::size_t law_state = 0;
  };

  template <class T>
  static LinkMemory<T> split(const RunEntries& at, T* base) noexcept {
    const std::size_t n = at.links;
    if (n == 0) {
      return {};
    }
    if (!at.across) {
      return {base, base + n};
    }
    return {base, base + n, base + 2 * n, base + 3 * n, base + 4 * n, base + 5 * n};
  }

  RunEntries addRun(const LinkRun& run) {
    RunEntries at;
    const std::string name = "run" + std::to_string(runs_.size());
    const bool is_inside = run.section_a == run.section_b && run.slow_section < 0;
    if (remembers(run) && run.tank < 0 && (metered_ || !is_inside || run.presses)) {
      at.links =
          run.ends.size() * static_cast<std::size_t>(run.dimensions == 0 ? 1 : run.dimensions);
      at.across = run.slow_section >= 0;
      at.memory = arena_.add<Real>(name + ".forces", (at.across ? 6 : 2) * at.links);
    }
    if (const std::size_t states = scene::lawOf(run.law).explicit_form.states; states > 0) {
      at.law_state = arena_.add<Real>(name + ".law", states * run.ends.size());
    }
    return at;
  }

  bool metered_;
  Arena arena_;
  std::vector<RunEntries> runs_;
  std::size_t frame_at_ = 0;
  std::size_t x_at_ = 0;
  std::size_t d_at_ = 0;
  std::size_t d_last_at_ = 0;
  std::size_t f_at_ = 0;
  std::size_t moved_at_ = 0;
  std::size_t places_at_ = 0;
  std::size_t place_d_at_ = 0;
  std::size_t place_forces_at_ = 0;
  std::size_t places_owe_at_ = 0;
  std::size_t interpolated_forces_at_ = 0;
  std::size_t last_forces_at_ = 0;
  std::size_t radiated_at_ = 0;
  std::size_t asleep_at_ = 0;
  std::size_t work_at_ = 0;
};

}  // namespace ergotic::physics
