// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"

/// Connection points: massless modules on strings and meshes.
namespace ergotic::scene {

/// Grid and position that a text such as `s@0.3` or `p@0.3:0.7` names.
struct NamedPlace {
  int grid = 0;
  double along = 0.0;
  double across = 0.0;  ///< 0 on a string
};

/// \throws TextError at `place` if there is no such string or mesh, or a fraction is outside 0...1
NamedPlace namedPlace(const SceneBuilder& builder, const std::string& text, Place place);

/// The one module that a place falls onto, -1: none.
int moduleOn(const Grid& grid, const NamedPlace& at);

/// Index of the module that a text names: a module; `s@0.3`, the point at that fraction of the way
/// from the first to the last module of the string `s`; or `p@0.3:0.7`, the point of the mesh `p`
/// at 0.3 of the way along its columns and 0.7 across its rows.
///
/// A point that falls onto a module (within 1e-9 of the spacing) is that module. Any other becomes
/// a massless module the first time it is named, and is found again after that. So does
/// `mean(p/rim)`; `p/near(0.1, 0.2)` and `p/middle` are modules (selections.hpp).
/// \throws TextError at `place` if there is no such module, string or mesh, or a fraction is
///         outside 0...1
int pointAt(SceneBuilder& builder, const std::string& text, Place place);

}  // namespace ergotic::scene
