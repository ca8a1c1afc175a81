// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>

#include "ergotic/scene/origin.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// `file:line:col: note: `, the start of what `settle` says about a choice.
inline std::string noteAt(const scene::Scene& scene, const scene::Place& place) {
  return scene::textOf(scene, place) + ": note: ";
}

/// A number as a player reads it.
inline std::string shortly(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

}  // namespace ergotic::physics
