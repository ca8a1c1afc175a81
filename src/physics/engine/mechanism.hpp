// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "physics/engine/energy_meter.hpp"
#include "physics/engine/energy_stable_runs.hpp"
#include "physics/engine/pickups.hpp"
#include "physics/engine/points.hpp"
#include "physics/engine/sleeper.hpp"
#include "physics/engine/slice_interpolation.hpp"
#include "physics/engine/stepper.hpp"
#include "physics/engine/touches.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// The parts that make up a tick, in the order of construction: each refers to those before it.
template <class Real>
struct Mechanism {
  /// \param written  modules of the scene as it was written, the first of those that are played
  Mechanism(std::shared_ptr<const scene::Scene> played,
            std::size_t written,
            const Rates& rates,
            const CompileOptions& options,
            Layout&& made_layout,
            Groups&& made_groups,
            std::unique_ptr<CoefficientsOf<Real>> made_coefficients,
            State<Real>&& made_state)
      : scene(std::move(played)),
        layout(std::move(made_layout)),
        groups(std::move(made_groups)),
        coefficients(std::move(made_coefficients)),
        state(std::move(made_state)),
        meter(*scene, layout, state),
        stepper(layout, options),
        interpolation(layout),
        points(*scene, layout, options.isa),
        energy_stable(*scene, layout, groups, points, state),
        pickups(layout),
        sleeper(*scene, layout, points, *coefficients),
        touches(*scene, written, rates, layout, *coefficients) {
    state.allocate();
  }
  Mechanism(const Mechanism&) = delete;  // its parts refer to each other
  Mechanism& operator=(const Mechanism&) = delete;

  const std::shared_ptr<const scene::Scene> scene;  ///< as it is played
  const Layout layout;
  const Groups groups;
  std::unique_ptr<CoefficientsOf<Real>> coefficients;
  State<Real> state;
  EnergyMeter<Real> meter;
  Stepper<Real> stepper;
  SliceInterpolation<Real> interpolation;
  Points<Real> points;
  EnergyStableRuns<Real> energy_stable;
  Pickups<Real> pickups;
  Sleeper<Real> sleeper;
  Touches<Real> touches;
};

}  // namespace ergotic::physics
