// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "rviz/model_graph.hpp"

namespace ergotic::panel {

/// What a module is drawn as. Its colour follows from it.
enum class ModuleLook : std::uint8_t {
  kHidden,   ///< a mode of a body whose outline is drawn
  kString,   ///< in a row: a string
  kBar,      ///< in a row that resists bending: a bar, or the outline of one
  kSurface,  ///< of a skin, a plate, or an outline
  kMass,     ///< by itself
  kGround,
  kHand,   ///< moved from outside: a slice, an end-effector, or an input
  kPoint,  ///< massless: a finger, the place of a bow
};
constexpr std::size_t kModuleLooks = 8;

/// How a model is drawn: which modules make strings, bars and surfaces together, and which stand by
/// themselves.
struct ModelShape {
  std::vector<ModuleLook> looks;       ///< [modules]
  std::vector<ModuleIndices> strings;  ///< [strings] modules from one end to the other
  std::vector<ModuleIndices> bars;     ///< [bars] modules from one end to the other
  ModuleIndices triangles;             ///< [triangles][3] modules of surfaces
  ModuleIndices bodies;                ///< modules by themselves
  ModuleIndices links;  ///< [links][2] modules, of links that are no part of the above
};

/// \pre isConsistent(structure)
ModelShape shapeOf(const ModelStructure& structure);

}  // namespace ergotic::panel
