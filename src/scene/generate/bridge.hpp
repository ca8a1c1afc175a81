// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// A bridge, on which strings end instead of the ground at one of their ends: a mass `name` of its
/// own, held by `name.spring` and slowed by `name.resistance` towards the ground `name.ground`, or
/// any module. The grounds of the strings stay where they are, for names and for what lies between.
struct BridgeSpec {
  std::string name;
  int section = 0;
  std::vector<int> grids;    ///< grids of the strings, each a scalar one of one row
  bool is_at_last = false;   ///< their last modules end here, not their first
  bool keeps_pitch = false;  ///< the strings are tuned together with what they end on
  int on = -1;               ///< a module that is there; -1: its own, of what follows
  Value mass;                ///< kg
  Value stiffness;           ///< N/m
  Value resistance;          ///< N s/m
  Place place;
};

/// Appends the bridge and attaches the strings to it.
/// \throws TextError if a name is taken, a string does not end on a ground there, or its bends
///         would end on a point, or if its pitch is to be kept and it has none
void addBridge(SceneBuilder& builder, const BridgeSpec& spec);

}  // namespace ergotic::scene
