// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "rviz/model_graph.hpp"

namespace ergotic::panel {

/// Drawing style of a module. Its colour follows from it.
enum class ModuleLook : std::uint8_t {
  kHidden,   ///< a mode of a body whose outline is drawn
  kString,   ///< in a row: a string
  kBar,      ///< in a row that resists bending: a bar, or the outline of one
  kSurface,  ///< part of a skin, a plate, or an outline
  kMass,     ///< single mass
  kGround,
  kHand,   ///< moved from outside: a slice, an end-effector, or an input
  kPoint,  ///< massless: a finger, the place of a bow
};
constexpr std::size_t kModuleLooks = 8;

/// Decomposition of a model for drawing: modules that form strings, bars and surfaces, and single
/// modules.
struct ModelShape {
  std::vector<ModuleLook> looks;       ///< [modules]
  std::vector<ModuleIndices> strings;  ///< [strings] modules from one end to the other
  std::vector<ModuleIndices> bars;     ///< [bars] modules from one end to the other
  ModuleIndices triangles;             ///< [triangles][3] modules of surfaces
  ModuleIndices bodies;                ///< modules by themselves
  ModuleIndices links;                 ///< [links][2] modules, of the remaining links
};

/// \pre isConsistent(structure)
ModelShape shapeOf(const ModelStructure& structure);

}  // namespace ergotic::panel
