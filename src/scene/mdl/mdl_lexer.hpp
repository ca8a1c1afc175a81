// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// One argument of an `.mdl` line.
struct MdlToken {
  enum class Kind { kBare, kBracket, kQuoted };
  Kind kind = Kind::kBare;
  std::string text;  ///< without brackets or quotes
  Place place;       ///< of the first character of `text`
};

/// One element: `@name keyword arguments...`
struct MdlLine {
  std::string name;  ///< without the `@`
  MdlToken keyword;
  std::vector<MdlToken> arguments;
  Place place;  ///< of the `@`
};

/// Cuts `.mdl` text into elements. Comments (`#` to the end of the line), `~begin`, `~end` and
/// lines that do not begin with `@` are skipped. A line that looks like an element without its `@`
/// is skipped with a warning. \throws TextError if an element cannot be cut
std::vector<MdlLine> cutMdl(SceneBuilder& builder, const std::string& text);

/// The keywords of dialect D2, also those that are not read.
const std::vector<std::string>& mdlKeywords();

}  // namespace ergotic::scene
