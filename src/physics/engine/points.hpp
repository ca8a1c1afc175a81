// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ergotic/scene/grid.hpp"
#include "physics/engine/modal_points.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Massless modules through which links see others: places on grids, other frames.
/// Each takes its position as a weighted sum and hands its force back with the same weights, so
/// that no work is lost between.
template <class Real>
class Points {
 public:
  /// \param isa  of the sums over modes
  Points(const scene::Scene& scene, const Layout& layout, rt::Isa isa)
      : layout_(layout), modal_(layout, isa) {
    for (const PlacePoint& point : layout.places) {
      const scene::Connection& connection =
          scene.connections[static_cast<std::size_t>(point.connection)];
      grids_.push_back(scene.grids[static_cast<std::size_t>(connection.grid)]);
    }
    for (std::size_t m = 0; m < scene.mats.size() && !grids_.empty(); ++m) {
      rests_.push_back(scene.mats[m].rest);
    }
  }

  /// Where a place is at the start.
  void placeAtStart(const CoefficientsOf<Real>& c, Real* x, Real* d, double* places) const {
    for (std::size_t p = 0; p < layout_.modal_places.size(); ++p) {
      modal_.gather(p, x, d);
    }
    for (std::size_t p = 0; p < layout_.places.size(); ++p) {
      const PlaceCoefficients& wanted = c.places[p];
      places[2 * p] = std::clamp(wanted.along, wanted.minimum, wanted.maximum);
      places[2 * p + 1] = std::clamp(wanted.across, 0.0, 1.0);
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
    for (const std::size_t p : group.modal_places) {
      if (layout_.isDue(layout_.modal_places[p].section, now)) {
        gatherModes(p, state);
      }
    }
    for (const std::size_t p : group.places) {
      const PlacePoint& point = layout_.places[p];
      if (layout_.isDue(point.section, now)) {
        keepLast(point.slot, point.dimensions, state);
        gatherPlace(p, x, d, state.places());
        std::copy_n(d + point.slot, point.dimensions, state.placeD() + point.coordinate);
        if (moveOn(p, c.places[p], x, state.places())) {
          gatherPlace(p, x, d, state.places());
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
    for (const std::size_t p : group.modal_places) {
      f[layout_.modal_places[p].slot] = Real(0);
    }
    for (const std::size_t p : group.places) {
      clear(layout_.places[p]);
    }
    for (const std::size_t p : group.projections) {
      clear(layout_.projections[p]);
    }
  }

  /// Forces go on to the modules, in the reverse order of gather().
  void scatter(const Group& group, Real* f, const double* places) const noexcept {
    scatterToModules(group, f, places);
    scatterToModes(group, f, f);
  }
  /// As far as modules that are sums of modes.
  void scatterToModules(const Group& group, Real* f, const double* places) const noexcept {
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
      const PlacePoint& point = layout_.places[p];
      const scene::GridPlace around = scene::placeOn(grids_[p], places[2 * p], places[2 * p + 1]);
      for (int i = 0; i < around.count; ++i) {
        for (int k = 0; k < point.dimensions; ++k) {
          f[slotOf(around, i) + k * point.stride] += weight(around, i) * f[point.slot + k];
        }
      }
    }
  }

  /// What these have received goes on to the modes. \param f  forces on modes, added to
  void scatterToModes(const Group& group, const Real* forces, Real* f) const noexcept {
    for (const std::size_t p : group.modal_places) {
      modal_.scatter(p, forces, f);
    }
  }

  const ModalPoints<Real>& modal() const noexcept { return modal_; }
  /// The modules around a place, and their weights: what else acts through a point needs them.
  scene::GridPlace around(std::size_t p, const double* places) const noexcept {
    return scene::placeOn(grids_[p], places[2 * p], places[2 * p + 1]);
  }
  /// Slots of all modules that a place can come to. Realtime: no
  std::vector<int> slotsUnder(std::size_t p) const {
    const scene::Grid& grid = grids_[p];
    const auto first = layout_.slot_of_mat.begin() + grid.first;
    return {first, first + grid.columns * grid.rows};
  }
  int slotOf(const scene::GridPlace& around, int i) const noexcept {
    return layout_.slot_of_mat[static_cast<std::size_t>(around.mats[static_cast<std::size_t>(i)])];
  }

 private:
  static Real weight(const scene::GridPlace& around, int i) noexcept {
    return static_cast<Real>(around.weights[static_cast<std::size_t>(i)]);
  }

  /// The modes of a section at rest are all at 0.
  void gatherModes(std::size_t p, State<Real>& state) const noexcept {
    const ModalPlace& point = layout_.modal_places[p];
    keepLast(point.slot, 1, state);
    if (state.asleep()[point.section] == 0) {
      modal_.gather(p, state.x(), state.d());
    } else {
      state.x()[point.slot] = static_cast<Real>(point.offset);
      state.d()[point.slot] = Real(0);
    }
    copyMoved(point.slot, 1, state);
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

  /// The place follows what is asked for, as fast as it may. \return true if it moved
  bool moveOn(std::size_t p,
              const PlaceCoefficients& wanted,
              const Real* x,
              double* places) const noexcept {
    const int guide = layout_.places[p].guide;
    const double led = guide < 0 ? 0.0 : wanted.guide_scale * static_cast<double>(x[guide]);
    const double targets[2] = {std::clamp(wanted.along + led, wanted.minimum, wanted.maximum),
                               std::clamp(wanted.across, 0.0, 1.0)};
    bool moves = false;
    for (std::size_t k = 0; k < 2; ++k) {
      double& place = places[2 * p + k];
      const double way = targets[k] - place;
      place += wanted.speed > 0.0 ? std::clamp(way, -wanted.speed, wanted.speed) : way;
      moves = moves || way != 0.0;
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
  ModalPoints<Real> modal_;
  std::vector<scene::Grid> grids_;      // [places]
  std::vector<Eigen::Vector3d> rests_;  // [mats], if there are places
};

}  // namespace ergotic::physics
