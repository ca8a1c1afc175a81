// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/engine/energy.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

/// Whether what plays is what the scene says. Realtime: no.
namespace ergotic::station {

/// Share of the steps in which an energy-stable link may be cut before it is reported.
constexpr double kMaxClippedShare = 0.05;
/// Steps in which a link must have pushed before its share is significant.
constexpr std::int64_t kMinActiveSteps = 200;

/// Whether a link is cut so often that it is reported.
bool isCutTooOften(const physics::TankReport& tank);

/// Clipped over active steps; 0 if it never pushed.
double clippedShare(const physics::TankReport& tank);

/// Largest stiffness (slope of the force) of an energy-stable link at which its tank still holds
/// the energy that its law asks for, kg/time_unit^2: q K <= 1, with all energy-stable links of a
/// module at once; infinite between modules that no force moves. Source: docs/physics/schemes.md,
/// "Energy-stable links".
double mostStiffness(const scene::Scene& scene, const scene::Lia& lia, const physics::Rates& rates);

/// Makes one warning for each energy-stable link that is cut too often, worst first: the link, how
/// often it is cut, and what to change.
std::vector<std::string> tankWarnings(const scene::Scene& scene,
                                      const physics::Rates& rates,
                                      const std::vector<physics::TankReport>& tanks);

/// Residual of the balance over all the energy that there was: what is stored and what was
/// dissipated. Dimensionless; 0 if there was none.
double relativeResidual(const physics::Energies& energies);

}  // namespace ergotic::station
