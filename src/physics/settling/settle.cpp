// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "physics/settling/coupled_strings.hpp"
#include "physics/settling/pitch_pull.hpp"
#include "physics/settling/sleep_bound.hpp"
#include "physics/settling/steps.hpp"
#include "scene/generate/stretch.hpp"

namespace ergotic::physics {
namespace {

/// Settles everything but the rates. A chaplet is tuned to the springs that it is attached to;
/// schemes depend on the masses at the ends of a link.
scene::Scene complete(scene::Scene scene, const Rates& rates, std::vector<std::string>& notes) {
  const std::vector<CoupledString> coupled = coupledStrings(scene);
  tuneStrings(scene, rates, notes);
  tuneBodies(scene, rates, notes);
  tuneCoupledStrings(scene, coupled, rates, notes);
  scene::settleStretches(scene);
  settleStops(scene, rates, notes);
  askForChaplets(scene, rates);
  insertFilters(scene, rates, notes);
  splitTables(scene, rates);
  shareTanks(scene, notes);
  chooseSchemes(scene, rates, notes);
  splitSprings(scene);
  return scene;
}

}  // namespace

Settled settle(scene::Scene scene, const Rates& rates) {
  Settled settled;
  const Complete completed = [&](scene::Scene candidate) {
    std::vector<std::string> notes;
    return complete(std::move(candidate), rates, notes);
  };
  chooseAutomaticRates(scene, rates, completed, settled.notes);
  chooseCouplings(scene, rates, completed, settled.notes);
  raiseRates(scene, rates, completed, settled.notes);
  settled.scene = complete(std::move(scene), rates, settled.notes);
  startInEquilibrium(settled.scene, rates, settled.notes);
  noteSleep(settled.scene, settled.notes);
  notePitchPull(settled.scene, settled.notes);
  warnAboutPlaying(settled.scene, settled.scene.warnings);
  return settled;
}

}  // namespace ergotic::physics
