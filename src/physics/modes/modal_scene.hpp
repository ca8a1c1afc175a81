// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// What a module that nothing touches shows of its motion: that of the lowest modes.
struct ModalPicture {
  int mat = 0;    ///< of the scene as it was written
  int first = 0;  ///< first mode
  std::vector<float> weights;
};

/// Where modules and links of the scene as it was written are in the one that is played.
struct AsWritten {
  std::vector<int> mats;               ///< [mats as written] index as played; -1: a picture only
  std::vector<int> lias;               ///< [links as played] index as written
  std::vector<ModalPicture> pictures;  ///< by module
};

/// Forces in the very first step, before links have acted: index of a module, N.
using FirstForces = std::vector<std::pair<int, double>>;

/// A scene in which modes, cells behind taps, stand in for linear parts of sections, for `compile`
/// alone: everything else knows the scene as it was written.
struct ModalScene {
  scene::Scene scene;
  AsWritten as_written;
  FirstForces first_forces;
};

/// Replaces what sections ask for (Section::modes); nothing if none does or gets it.
/// \param notes  is told what was chosen and why, section by section
/// \throws TextError if a section cannot have the modes it asks for, with the place of what is in
///         the way
/// Realtime: no. Cost: that of `modesOf` for each part
/// Source: docs/physics.md, "Modes instead of modules".
std::optional<ModalScene> withModes(const scene::Scene& scene,
                                    const Rates& rates,
                                    std::vector<std::string>& notes);

}  // namespace ergotic::physics
