// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// Words behind the slash, as in `disc(0.5, 0.5, 0.1)`.
struct GridWords {
  std::string word;
  std::vector<std::string> arguments;
};

/// \throws TextError if it is none of `rim`, `all`, ..., or has not as many arguments as that
GridWords gridWordsOf(const SceneBuilder& builder, const std::string& text, Place place);

/// Whether these words stand for one module.
bool isOne(const GridWords& words);

/// The modules of a grid that they mean, those that move; a rim and a ring go round, from along on.
/// \param whole  text, for messages
/// \throws TextError if there are none, or if they mean nothing on such a grid
std::vector<int> selectedOn(const SceneBuilder& builder,
                            const Grid& grid,
                            const GridWords& words,
                            const std::string& whole,
                            Place place);

}  // namespace ergotic::scene
