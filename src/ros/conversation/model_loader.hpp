// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"
#include "ergotic/station/performer.hpp"

namespace ergotic::node {

/// Reads and validates a model; text of more than one line is YAML, anything else a path, with
/// `#variant` behind it if a variant of the scene is meant.
/// \throws TextError with file:line:col; Exception if the file cannot be read
scene::Scene readModel(const std::string& model);

/// What a player should know of a model that is about to play: warnings of the scene and of its
/// certificate, changed rates. Empty if there is nothing, else one thing a line.
std::string noteOn(const station::Performer& performer);

/// FNV-1a, 64 bit, 16 hexadecimal digits: names a scene text in recordings.
std::string textHash(const std::string& text);

}  // namespace ergotic::node
