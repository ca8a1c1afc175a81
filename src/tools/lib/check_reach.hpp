// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/end_effector.hpp"

namespace CLI {
class App;
}

namespace ergotic::tools {

/// Options of the reach of slices by `check`.
struct ReachChoice {
  bool is_wanted = false;
  double stroke_m = 0.0;  ///< stroke of a slice to either side
  ReachChoice();
};

void addOptions(CLI::App& app, ReachChoice& choice);

/// Prints the contacts of each slice and their positions on stdout, and nothing else.
/// \param scene          settled
/// \param end_effectors  of the slices: their coordinates are reported as ports of them
/// \throws TextError from the map beside the scene
void checkReach(const scene::Scene& scene,
                const tgr::EndEffectors& end_effectors,
                const ReachChoice& choice,
                bool json);

/// Finds errors in the reach of slices that move their ports by themselves.
std::vector<std::string> reachFindings(const scene::Scene& scene,
                                       const std::vector<int>& taken_ports,
                                       const ReachChoice& choice);

}  // namespace ergotic::tools
