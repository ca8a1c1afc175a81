// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::node {

/// The scene that a MIDI program change means: the one of that number, from 0 on, among the scenes
/// of a folder, as `scripts/station --list` shows them.
/// \param program  0...127
/// \param playing  file of the scene that plays, in whose folder it is looked for
/// \return its path
/// \throws Exception saying how many there are, or that what plays has no folder
std::string sceneOfProgram(int program, const std::string& playing);

}  // namespace ergotic::node
