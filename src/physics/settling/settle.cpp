// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "physics/settling/automatic_rate.hpp"
#include "physics/settling/body_tuning.hpp"
#include "physics/settling/coupled_strings.hpp"
#include "physics/settling/coupling_choice.hpp"
#include "physics/settling/filters.hpp"
#include "physics/settling/pitch_pull.hpp"
#include "physics/settling/play_warnings.hpp"
#include "physics/settling/raise_rates.hpp"
#include "physics/settling/scheme_choice.hpp"
#include "physics/settling/share_tanks.hpp"
#include "physics/settling/sleep_bound.hpp"
#include "physics/settling/split_springs.hpp"
#include "physics/settling/split_tables.hpp"
#include "physics/settling/stops.hpp"
#include "physics/settling/string_tuning.hpp"
#include "scene/generate/stretch.hpp"

namespace ergotic::physics {
namespace {

/// Everything but the rates. A chaplet is tuned to the springs of what it touches; schemes depend
/// on the masses that a link ends on.
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
  const Complete unsaid = [&](scene::Scene candidate) {
    std::vector<std::string> notes;
    return complete(std::move(candidate), rates, notes);
  };
  chooseAutomaticRates(scene, rates, unsaid, settled.notes);
  chooseCouplings(scene, rates, unsaid, settled.notes);
  raiseRates(scene, rates, unsaid, settled.notes);
  settled.scene = complete(std::move(scene), rates, settled.notes);
  noteSleep(settled.scene, settled.notes);
  notePitchPull(settled.scene, settled.notes);
  warnAboutPlaying(settled.scene, settled.scene.warnings);
  return settled;
}

}  // namespace ergotic::physics
