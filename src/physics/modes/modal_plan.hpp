// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "physics/modes/modal_choice.hpp"
#include "physics/modes/modal_parts.hpp"

namespace ergotic::physics {

/// An attachment to a part: a module, or a position between modules.
struct ModalTouch {
  int mat = 0;
  int part = -1;                          ///< -1: it does not move
  std::vector<scene::Tap::Share> shares;  ///< weights of modules of the part, and of grounds
  double offset = 0.0;                    ///< where these are at rest, m from its own
};

/// The part of one section that modes replace, and the attachments to it.
struct ModalPlan {
  int section = 0;
  LinearParts linear;
  std::vector<ModalTouch> touches;
  std::vector<int> connections;  ///< indices in Scene::connections, of those among the touches
  std::vector<int> taps;         ///< the same in Scene::taps
  std::vector<ModalPart> parts;  ///< [linear.parts]
  ModalError error;              ///< error of leaving modes out
};

constexpr int kMaxModalModules = 3000;  ///< of one part: eigenvectors fill 8 bytes times its square
constexpr int kMaxModalTouches = 64;    ///< of one section

/// Plans the modes of one section. \return false if it stays a network, which only
/// kAutomaticModes allows; `notes` is told in either case
/// \throws TextError with the place of what is in the way
bool planModes(const Network& network,
               const Rates& rates,
               int section,
               ModalPlan& plan,
               std::vector<std::string>& notes);

}  // namespace ergotic::physics
