// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "scene/generate/scene_builder.hpp"
#include "scene/mdl/mdl_dialect.hpp"
#include "scene/mdl/mdl_lexer.hpp"
#include "scene/mdl/mdl_numbers.hpp"

/// Macros of `.mdl` texts: one line that stands for many modules and links.
namespace ergotic::scene {

enum class MacroEdges {
  kFree,
  kFixed,    ///< grounds at both ends, or all around
  kCorners,  ///< grounds in the corners
};

struct MdlMacro {
  const char* keyword;
  std::size_t sides;  ///< 1: N modules in a row; 2: X rows of Y
  bool is_stiff;      ///< also with springs to the second neighbours
  MacroEdges edges;
  double fewest;  ///< modules of a side
  const char* usage;

  /// Arguments before the positions, without Zo.
  std::size_t numbers() const { return sides + (is_stiff ? 4 : 3); }
};

/// Null if the keyword is none of a macro.
const MdlMacro* findMacro(const std::string& keyword);

/// How many modules a line becomes; 0 if it is no macro. \throws TextError if an argument is wrong
std::size_t macroModules(SceneBuilder& builder,
                         MdlNumbers& numbers,
                         const MdlLine& line,
                         const MdlDialect& dialect);

/// Appends the modules `name.<i>` or `name.<row>.<column>`, the links `name.link.<n>` and the grid
/// of a macro; of a `string`, also what its pitch is computed from. In the older language one
/// position follows the numbers, in place of Zo, a position and a velocity.
/// \pre the line is a macro
/// \throws TextError if an argument is wrong, and before it takes room for too many modules
void addMacro(SceneBuilder& builder,
              MdlNumbers& numbers,
              const MdlLine& line,
              const MdlDialect& dialect);

/// Index of the point at the coordinates `at.at` of a macro, which is found again where it exists.
/// Coordinates outside 0...1 are cut to that, with a warning; those that follow an audio input
/// while it plays.
int macroPoint(SceneBuilder& builder, MdlNumbers& numbers, const MdlToken& at);

}  // namespace ergotic::scene
