// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// Stops below a string: grounds `name.0` ... below places of it, each with a contact `name.stop.0`
/// ..., whose stiffness `settle` finds: a Tuning without modes. Where a place falls between two
/// masses, or if it may be moved, the contact is with a point `name.at.<n>`.
struct StopsSpec {
  struct Stop {
    double along = 0.0;   ///< 0...1, of the grid
    double height = 0.0;  ///< height of the ground, m, from where the string rests
  };
  std::string name;
  int grid = 0;  ///< index in Scene::grids, of one row in a scalar section
  std::vector<Stop> stops;
  bool are_points = false;  ///< `settle` may move them: points even where a mass is
  Value damping;            ///< of each contact, N s/m
  Place place;
};

/// Frets k = 1 ... count of equal temperament, in a line below the string: 2^(-k/12) of it sounds.
/// \param at_nut, at_bridge  how far the line is below the string at rest there, m
/// \param is_from_last  the nut is the last module of the string, not the first
std::vector<StopsSpec::Stop> fretsOf(int count, double at_nut, double at_bridge, bool is_from_last);

/// Appends them. \throws TextError if a name is taken
void addStops(SceneBuilder& builder, const StopsSpec& spec);

}  // namespace ergotic::scene
