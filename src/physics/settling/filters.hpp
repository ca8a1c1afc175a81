// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Puts a C2 between the slower end and every link with Lia::filtered, which then starts at the
/// last mass: modules `<link>.filter.0` and `.1`, links `<link>.filter.link.0` and `.1`, added last
/// and stepped as often as the faster end. A slower end that is a mass with springs of its own also
/// gets the small dashpot `<link>.filter.dashpot` to `<link>.filter.ground`.
///
/// The chaplet is as heavy as the structure at the faster end asks for, at the present values of
/// the parameters (docs/physics.md, "Chaplets"). One note for each.
/// \pre        the rates of all sections are chosen
/// \throws TextError at the link if the rates are too close for C2, if the chaplet would be too
///         heavy for the slower mass, or if there is nothing to filter for
/// Realtime: no.
void insertFilters(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
