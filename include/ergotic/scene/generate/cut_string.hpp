// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// How a string is cut into masses.
struct StringCut {
  int masses = 0;  ///< moving ones
  bool coarse = false;
};

/// The cut that a string has now.
StringCut cutOf(const StringInfo& string);

/// Why a string cannot be cut in another way without changing what it is; empty: it can.
/// \param string  index in Scene::strings
std::string reasonAgainstCutting(const Scene& scene, int string);

/// True if the string may be coarse: a scalar one whose pitch no parameter changes.
bool canBeCoarse(const Scene& scene, int string);

/// Fundamental of the undamped string in continuous time, Hz, whatever it is cut into; the one that
/// is wanted, if one is. Parameters have their present values.
double idealPitchHz(const Scene& scene, const StringInfo& string);

/// A scene with the same string cut into another number of masses: mass, tension, losses, pitch and
/// shape at the start stay those of the whole. Links, inputs and outputs at one of its modules now
/// are at the point `<string>@<fraction>` of the same position, unless it falls onto a module.
/// Modules and links that come after the string get other indices; new points come last.
/// \param string  index in Scene::strings
/// \pre not settled; nothing is against it; cut.masses >= 1, coarse ones >= kFewestCoarseMasses
/// Realtime: no. Cost: O(modules + links)
Scene cutString(const Scene& scene, int string, const StringCut& cut);

}  // namespace ergotic::scene
