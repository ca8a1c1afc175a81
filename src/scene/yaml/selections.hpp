// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

/// Many modules by a few words: `plate/rim`, `plate/disc(0.5, 0.5, 0.1)`, `note_*.bridge`.
namespace ergotic::scene {

struct Selection {
  std::vector<int> mats;
  bool is_set = false;  ///< it stands for any number of modules, even where that is one
};

/// Modules that a value names where several are allowed: a module, a place on a grid, a selection,
/// a name with `*`, or a list of such, in which each module counts once.
/// \param what  for messages, as in `an end of link 'l'`
/// \throws TextError where there is nothing of that name, or nothing is selected
Selection selectionOf(SceneBuilder& builder,
                      const Node& node,
                      const std::string& what,
                      Place fallback);

/// Whether a text is more than the name of a module or of a place on a grid.
bool isSelection(const std::string& text);

/// The one module that a selection stands for: `near`, `middle` and `mean(...)`, which is a tap.
/// \throws TextError if it may be many
int selectedModule(SceneBuilder& builder, const std::string& text, Place place);

}  // namespace ergotic::scene
