// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "physics/engine/energy_meter.hpp"
#include "physics/engine/guarded_runs.hpp"
#include "physics/engine/points.hpp"
#include "physics/engine/sleeper.hpp"
#include "physics/engine/stepper.hpp"
#include "physics/engine/taps.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// What an instrument consists of.
template <class Real>
struct Parts {
  /// \param modal_points  of a scene in which modes stand in for modules
  Parts(const scene::Scene& scene,
        const Rates& rates,
        const CompileOptions& options,
        const std::vector<ModalPoint>& modal_points = {})
      : Parts(scene, rates, options, makeLayout(scene, rates, modal_points)) {}
  Parts(const Parts&) = delete;  // they refer to each other
  Parts& operator=(const Parts&) = delete;

  Layout layout;
  Groups groups;
  std::unique_ptr<CoefficientsOf<Real>> coefficients;
  State<Real> state;
  EnergyMeter<Real> meter;
  Stepper<Real> stepper;
  Points<Real> points;
  GuardedRuns<Real> guarded;
  Taps<Real> taps;
  Sleeper<Real> sleeper;

 private:
  Parts(const scene::Scene& scene, const Rates& rates, const CompileOptions& options, Layout&& made)
      : layout(std::move(made)),
        groups(makeGroups(scene, rates, layout)),
        coefficients(std::make_unique<CoefficientsOf<Real>>(scene, rates, layout)),
        state(layout, options.metered),
        meter(scene, layout, state),
        stepper(layout, options),
        points(scene, layout, options.isa),
        guarded(scene, layout, groups, points, state),
        taps(layout),
        sleeper(scene, layout, *coefficients) {
    state.allocate();
  }
};

}  // namespace ergotic::physics
