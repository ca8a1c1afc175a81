// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/mdl/mdl_lexer.hpp"

namespace ergotic::scene {

/// Generation of the language of a text. The older one has no brackets; its masses end with the
/// position of a sample before, where the newer ones end with a velocity per second.
struct MdlDialect {
  enum class Age { kUnknown, kOlder, kNewer };
  Age age = Age::kUnknown;
  Place place;       ///< place of the construct that shows it
  std::string sign;  ///< that construct, as in `'massG'`

  bool isOld() const { return age == Age::kOlder; }
};

/// The newer language if a construct of it alone is used, else the older one if one of its own is.
MdlDialect dialectOf(const std::vector<MdlLine>& lines);

/// Note after a message about a line of the older language in a text of the newer; else empty.
std::string olderNote(const MdlLine& line, const MdlDialect& dialect);

/// \param usage  the arguments that are allowed
/// \throws TextError unless `least`...`most` holds their number
void expectArguments(const SceneBuilder& builder,
                     const MdlLine& line,
                     const MdlDialect& dialect,
                     std::size_t least,
                     std::size_t most,
                     const std::string& usage);

/// Writes lines of the older language like those of the newer: a `spring` with a damping becomes a
/// springDamper, coordinates at the end of a line go to the macros that they are of, and the
/// buffers of the display are left out. What numbers mean stays.
/// \throws TextError if a macro at the end of a link or tap has no coordinate
void renew(const SceneBuilder& builder, std::vector<MdlLine>& lines);

/// Groups are for displays and say nothing that sounds. Warns of those that do not begin or end.
void checkGroups(SceneBuilder& builder, const std::vector<MdlLine>& lines);

}  // namespace ergotic::scene
