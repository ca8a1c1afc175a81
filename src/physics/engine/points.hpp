// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ergotic/scene/grid.hpp"
#include "physics/engine/taps.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Massless modules through which links see others: places on grids, taps, other frames.
/// Each takes its position as a weighted sum and hands its force back with the same weights, so
/// that no work is lost between.
template <class Real>
class Points {
 public:
  /// \param isa  of the sums over modules
  Points(const scene::Scene& scene, const Layout& layout, rt::Isa isa)
      : layout_(layout), taps_(layout, isa) {
    for (const PlacePoint& point : layout.places) {
      const scene::Connection& connection =
          scene.connections[static_cast<std::size_t>(point.connection)];
      grids_.push_back(scene.grids[static_cast<std::size_t>(connection.grid)]);
    }
    for (std::size_t m = 0; m < scene.mats.size() && !grids_.empty(); ++m) {
      rests_.push_back(scene.mats[m].rest);
    }
  }

  /// Sets all points and taps to their positions at the start.
  void placeAtStart(const CoefficientsOf<Real>& c, Real* x, Real* d, double* places) const {
    for (std::size_t t = 0; t < layout_.taps.size(); ++t) {
      taps_.gather(t, x, d);
    }
    for (std::size_t p = 0; p < layout_.places.size(); ++p) {
      const PlaceCoefficients& wanted = c.places[p];
      for (std::size_t k = 0; k < wanted.ways.size(); ++k) {
        const PlaceCoefficients::Way& way = wanted.ways[k];
        places[2 * p + k] = std::clamp(way.at, way.minimum, way.maximum);
      }
      gatherPlace(p, x, d, places);
    }
    for (const ProjectedPoint& point : layout_.projections) {
      gatherProjection(point, x, d);
    }
  }

  /// Positions of the points of a group whose sections are due, from those of the modules.
  void gather(const Group& group,
              const CoefficientsOf<Real>& c,
              std::int64_t now,
              State<Real>& state) const noexcept {
    Real* x = state.x();
    Real* d = state.d();
    for (const std::size_t t : group.taps) {
      const TapPoint& tap = layout_.taps[t];
      if (layout_.isDue(tap.section, now)) {
        keepLast(tap.slot, tap.dimensions, state);
        taps_.gather(t, x, d);
        copyMoved(tap.slot, tap.dimensions, state);
      }
    }
    for (const std::size_t p : group.places) {
      const PlacePoint& point = layout_.places[p];
      if (layout_.isDue(point.section, now)) {
        keepLast(point.slot, point.dimensions, state);
        gatherPlace(p, x, d, state.places());
        std::copy_n(d + point.slot, point.dimensions, state.placeD() + point.coordinate);
        // What is asleep has no force by which it would pay.
        if (state.asleep()[point.section] == 0 && state.placesOwe()[p] <= c.places[p].credit) {
          glide(p, c.places[p], now, state);
        }
        for (int k = point.slot; k < point.slot + point.dimensions; ++k) {
          state.moved()[k] += x[k];
        }
      }
    }
    for (const std::size_t p : group.projections) {
      const ProjectedPoint& point = layout_.projections[p];
      if (layout_.isDue(point.of.section, now)) {
        keepLast(point.slot, point.dimensions, state);
        gatherProjection(point, x, d);
        copyMoved(point.slot, point.dimensions, state);
      }
    }
  }

  void clearForces(const Group& group, Real* f) const noexcept {
    const auto clear = [f](const auto& point) {
      std::fill_n(f + point.slot, point.dimensions, Real(0));
    };
    for (const std::size_t t : group.taps) {
      clear(layout_.taps[t]);
    }
    for (const std::size_t p : group.places) {
      clear(layout_.places[p]);
    }
    for (const std::size_t p : group.projections) {
      clear(layout_.projections[p]);
    }
  }

  /// Forces go on to the modules, in the reverse order of gather().
  void scatter(const Group& group, State<Real>& state) const noexcept {
    scatterPlaces(group, state.f(), state.places());
    scatterTaps(group, state.f(), state.f());
    for (const std::size_t p : group.places) {
      const PlacePoint& point = layout_.places[p];
      for (int k = 0; k < point.dimensions; ++k) {
        state.placeForces()[point.coordinate + k].mean += state.f()[point.slot + k];
      }
    }
  }
  /// Passes the forces on points and projections on, down to modules and taps.
  void scatterPlaces(const Group& group, Real* f, const double* places) const noexcept {
    for (const std::size_t p : group.projections) {
      const ProjectedPoint& point = layout_.projections[p];
      for (int k = 0; k < point.dimensions; ++k) {
        for (int c = 0; c < point.source_dimensions; ++c) {
          f[point.of.slot + c * point.of.stride] +=
              static_cast<Real>(point.axes(k, c)) * f[point.slot + k];
        }
      }
    }
    for (const std::size_t p : group.places) {
      scatterPlace(p, f, places);
    }
  }
  void scatterPlace(std::size_t p, Real* f, const double* places) const noexcept {
    const PlacePoint& point = layout_.places[p];
    const scene::GridPlace here = around(p, places);
    for (int i = 0; i < here.count; ++i) {
      for (int k = 0; k < point.dimensions; ++k) {
        f[slotOf(here, i) + k * point.stride] += weight(here, i) * f[point.slot + k];
      }
    }
  }

  /// Places whose step is over pay for what moving them has brought.
  void endFrame(const Group& group,
                const CoefficientsOf<Real>& c,
                std::int64_t now,
                State<Real>& state) const noexcept {
    for (const std::size_t p : group.places) {
      if (layout_.isDue(layout_.places[p].section, now + 1)) {
        pay(p, c.places[p], state);
      }
    }
  }

  /// Passes the forces on taps on to their modules. \param f  added to
  void scatterTaps(const Group& group, const Real* forces, Real* f) const noexcept {
    for (const std::size_t t : group.taps) {
      taps_.scatter(t, forces, f);
    }
  }

  const Taps<Real>& taps() const noexcept { return taps_; }

 private:
  static constexpr int kTries = 4;  // a string that is not straight: less of the way may cost more

  scene::GridPlace around(std::size_t p, const double* places) const noexcept {
    return scene::placeOn(grids_[p], places[2 * p], places[2 * p + 1]);
  }
  int slotOf(const scene::GridPlace& around, int i) const noexcept {
    return layout_.slot_of_mat[static_cast<std::size_t>(around.mats[static_cast<std::size_t>(i)])];
  }

  static Real weight(const scene::GridPlace& around, int i) noexcept {
    return static_cast<Real>(around.weights[static_cast<std::size_t>(i)]);
  }

  /// Remembers the last step; `moved` holds -x until the new position is known.
  void keepLast(int slot, int count, State<Real>& state) const noexcept {
    for (int k = slot; k < slot + count; ++k) {
      state.dLast()[k] = state.d()[k];
      if (!layout_.places.empty()) {
        state.moved()[k] = -state.x()[k];
      }
    }
  }

  void copyMoved(int slot, int count, State<Real>& state) const noexcept {
    if (!layout_.places.empty()) {
      std::copy_n(state.d() + slot, count, state.moved() + slot);
    }
  }

  /// The work of moving a place is that of the force there over how far the place has gone across
  /// the string. A damper there takes Z v^2 of the string itself: what it seems to pay for the
  /// place is at most Z/4 (how fast the place goes)^2. Energy-stable links give back what the
  /// string gave them wherever they lie, so moving them brings nothing.
  void pay(std::size_t p, const PlaceCoefficients& allowed, State<Real>& state) const noexcept {
    const PlacePoint& point = layout_.places[p];
    PlaceForce<Real>* force = state.placeForces() + point.coordinate;
    const Real* place_d = state.placeD() + point.coordinate;
    double work = 0.0;
    for (int k = point.slot; k < point.slot + point.dimensions; ++k, ++force, ++place_d) {
      const auto moved = static_cast<double>(state.moved()[k]);
      const double way = static_cast<double>(state.d()[k]) - moved;
      const double way_last = static_cast<double>(*place_d) - moved;
      work += 0.5 * (way * static_cast<double>(force->mean) +
                     way_last * static_cast<double>(force->last)) +
              allowed.resistance * way * way;
      *force = {Real(0), force->mean};
    }
    double& owed = state.placesOwe()[p];
    owed = std::max(0.0, owed - allowed.allowance) + work;
  }

  /// A step of the way, or as much of it as can be paid for.
  void glide(std::size_t p,
             const PlaceCoefficients& wanted,
             std::int64_t now,
             State<Real>& state) const noexcept {
    const PlacePoint& point = layout_.places[p];
    double* place = state.places() + 2 * p;
    const double from[2] = {place[0], place[1]};
    Real before[3];
    std::copy_n(state.x() + point.slot, point.dimensions, before);
    if (!moveOn(p, wanted, now, state)) {
      return;
    }
    gatherPlace(p, state.x(), state.d(), state.places());
    const double budget = wanted.credit + wanted.allowance - state.placesOwe()[p];
    for (int tries = kTries; tries >= 0; --tries) {
      const double share = budget / costOf(point, wanted, before, state);
      if (!(share < 1.0)) {
        return;
      }
      for (std::size_t k = 0; k < 2; ++k) {
        place[k] = from[k] + (tries > 0 ? share : 0.0) * (place[k] - from[k]);
      }
      gatherPlace(p, state.x(), state.d(), state.places());
    }
  }

  /// Upper bound of the energy that moving a point from `before` has cost: by the last force, by
  /// what the string has added since, and by the displacement, with springs at their stiffest.
  double costOf(const PlacePoint& point,
                const PlaceCoefficients& wanted,
                const Real* before,
                State<Real>& state) const noexcept {
    double cost = 0.0;
    for (int k = 0; k < point.dimensions; ++k) {
      const auto way = static_cast<double>(std::abs(state.x()[point.slot + k] - before[k]));
      const auto step = static_cast<double>(std::abs(state.d()[point.slot + k]));
      const Real force = state.placeForces()[point.coordinate + k].last;
      cost += way * (static_cast<double>(std::abs(force)) + wanted.stiffness * (step + 0.5 * way));
    }
    return cost;
  }

  /// The place glides to what is asked for until that changes again, as fast as it may.
  /// \return true if it moved
  bool moveOn(std::size_t p,
              const PlaceCoefficients& wanted,
              std::int64_t now,
              State<Real>& state) const noexcept {
    bool moves = false;
    for (std::size_t k = 0; k < wanted.ways.size(); ++k) {
      const PlaceCoefficients::Way& way = wanted.ways[k];
      const int guide = layout_.places[p].guides[k];
      const double led = guide < 0 ? 0.0 : way.scale * static_cast<double>(state.x()[guide]);
      const double target = std::clamp(way.at + led, way.minimum, way.maximum);
      double& place = state.places()[2 * p + k];
      if (target == place) {
        continue;  // most places stand still
      }
      const std::int64_t divisor =
          layout_.sections[static_cast<std::size_t>(layout_.places[p].section)].divisor;
      const std::int64_t frames = way.glide - now % way.glide;
      const auto steps = static_cast<double>((frames + divisor - 1) / divisor);
      const double step = (target - place) / steps;
      place += wanted.speed > 0.0 ? std::clamp(step, -wanted.speed, wanted.speed) : step;
      moves = moves || step != 0.0;
    }
    return moves;
  }

  /// d is that of the modules: a place that moves along them is no velocity of the string.
  void gatherPlace(std::size_t p, Real* x, Real* d, const double* places) const noexcept {
    const PlacePoint& point = layout_.places[p];
    const scene::GridPlace here = around(p, places);
    const Eigen::Vector3d& rest =
        rests_[static_cast<std::size_t>(layout_.mat_of_slot[static_cast<std::size_t>(point.slot)])];
    for (int k = 0; k < point.dimensions; ++k) {
      Real position(0);
      Real velocity(0);
      for (int i = 0; i < here.count; ++i) {
        const int slot = slotOf(here, i) + k * point.stride;
        const Eigen::Vector3d& there =
            rests_[static_cast<std::size_t>(here.mats[static_cast<std::size_t>(i)])];
        position += weight(here, i) * (x[slot] + static_cast<Real>(there[k] - rest[k]));
        velocity += weight(here, i) * d[slot];
      }
      x[point.slot + k] = position;
      d[point.slot + k] = velocity;
    }
  }

  void gatherProjection(const ProjectedPoint& point, Real* x, Real* d) const noexcept {
    for (int k = 0; k < point.dimensions; ++k) {
      Real position(0);
      Real velocity(0);
      for (int c = 0; c < point.source_dimensions; ++c) {
        const Real axis = static_cast<Real>(point.axes(k, c));
        position += axis * x[point.of.slot + c * point.of.stride];
        velocity += axis * d[point.of.slot + c * point.of.stride];
      }
      x[point.slot + k] = position;
      d[point.slot + k] = velocity;
    }
  }

  const Layout& layout_;
  Taps<Real> taps_;
  std::vector<scene::Grid> grids_;      // [places]
  std::vector<Eigen::Vector3d> rests_;  // [mats], if there are places
};

}  // namespace ergotic::physics
