// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"
#include "ergotic/station/performer.hpp"

namespace ergotic::node {

/// Whether a model is the YAML text of a scene: it has more than one line then.
bool isText(const std::string& model);

/// Reads and validates a model; what is no text is a path, with `#variant` behind it if a variant
/// of the scene is meant.
/// \throws TextError with file:line:col; Exception if the file cannot be read
scene::Scene readModel(const std::string& model);

/// `end_effectors` of a request: those of the scene itself, see handsBeside.
constexpr const char* kOwnEndEffectors = "auto";

/// File of the end-effectors for a scene `folder/NAME.yaml`: `folder/hands/NAME.yaml`.
/// \param model  path, path#variant, or a text, which has none
/// \return its path; empty if there is no such file
std::string handsBeside(const std::string& model);

/// Resolves kOwnEndEffectors for a model. The end-effectors of a device that can hurt somebody are
/// not changed by loading an instrument.
/// \param playing  file of the scene that plays
/// \return the file of handsBeside; `none` if only the scene that plays has one; empty: no change
std::string endEffectorsWith(const std::string& model, const std::string& playing, bool can_hurt);

/// Notes about a model that is about to play: warnings of the scene and of its certificate, changed
/// rates. Empty if there are none, else one note a line.
std::string noteAbout(const station::Performer& performer);

/// Answer to a request to load a model: its name, the steps to get force, and the warnings of
/// `note`, a line each. Notes on how the model is stepped stay in `status.message`.
/// \param force_waits  for `engage`
std::string answerOn(const std::string& model, const std::string& note, bool force_waits);

/// "the model has no parameter 'x', it has: loss = 0...1 N s/m, ...".
std::string unknownParameter(const std::string& name, const scene::Scene& scene);

/// FNV-1a, 64 bit, 16 hexadecimal digits: names a scene text in recordings.
std::string textHash(const std::string& text);

}  // namespace ergotic::node
