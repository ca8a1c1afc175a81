// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Points of a table from the text of a file: two columns with a comma or blanks between them, the
/// first increasing; `#` begins a comment.
/// \param file  for messages
/// \throws TextError with line and column in that file
Table readTableCsv(const std::string& text, const std::string& file);

}  // namespace ergotic::scene
