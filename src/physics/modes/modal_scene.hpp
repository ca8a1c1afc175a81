// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A scene in which modes, cells behind taps, stand in for linear parts of sections: its first
/// modules are those of the scene as it was written, its links some of those, in their order. For
/// `compile` alone: everything else knows the scene as it was written.
/// \param notes  is told what was chosen and why, section by section
/// \return nothing if no section asks for modes (Section::modes), or none gets them
/// \throws TextError if a section cannot have the modes it asks for, with the place of what is in
///         the way
/// Realtime: no. Cost: that of `modesOf` for each part
/// Source: docs/physics/bodies.md, "Modes instead of modules".
std::optional<scene::Scene> withModes(const scene::Scene& scene,
                                      const Rates& rates,
                                      std::vector<std::string>& notes);

}  // namespace ergotic::physics
