// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

constexpr const char* kBeginGroup = "~begin";
constexpr const char* kEndGroup = "~end";

/// One argument of an `.mdl` line.
struct MdlToken {
  enum class Kind { kBare, kBracket, kQuoted };
  Kind kind = Kind::kBare;
  std::string text;  ///< without brackets or quotes
  Place place;       ///< place of the first character of `text`
  /// Coordinates of a point of a macro; `text` is then the macro's `@name`.
  std::vector<MdlToken> at{};
};

/// One element: `@name keyword arguments...`; or the keyword `~begin` or `~end` and a name.
struct MdlLine {
  std::string name;  ///< without the `@`
  MdlToken keyword;
  std::vector<MdlToken> arguments;
  Place place;  ///< place of the `@`
};

/// Cuts `.mdl` text into elements. Comments (`#` to the end of the line) and other lines that do
/// not begin with `@` are skipped. A line that looks like an element without its `@` is skipped
/// with a warning. \throws TextError if an element cannot be cut
std::vector<MdlLine> cutMdl(SceneBuilder& builder, const std::string& text);

/// The keywords of elements, `massG`, `nlSpring` and `detent` of the older language included.
const std::vector<std::string>& mdlKeywords();

/// `stiffness of '@s'`
std::string ofElement(const std::string& what, const MdlLine& line);

}  // namespace ergotic::scene
