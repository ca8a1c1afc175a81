// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/energy_loss.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "at.hpp"
#include "physics/network/network_analysis.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {

EnergyLoss::EnergyLoss(const RatedNetwork& networks)
    : networks_(networks), joined_(networks.scene().mats.size()) {
  std::vector<int> of_tank(networks.scene().tanks.size(), -1);
  for (const scene::Lia& lia : networks.scene().lias) {
    const std::set<int> islands = networks.islandsAt(lia);
    for (const int island : islands) {
      joined_.join(island, *islands.begin());
    }
    if (lia.tank >= 0 && !islands.empty()) {
      int& first = of_tank[at(lia.tank)];
      first = first < 0 ? *islands.begin() : first;
      joined_.join(*islands.begin(), first);
    }
  }
  for (int m = 0; m < static_cast<int>(networks.scene().mats.size()); ++m) {
    const Network::Node& node = networks.network().nodes[at(m)];
    if (!node.is_free) {
      continue;
    }
    const int island = networks.islandOf(m);
    Group& group = groups_[joined_.setOf(island)];
    group.divisors.insert(networks.divisorOfMat(m));
    group.keeps = group.keeps || mayKeep(m);
    if (networks.isLinked(m) && island == m) {
      group.islands.push_back(island);
    }
  }
}

/// Alone, or where it may move along several axes or another than what a link joins it to, a link
/// damps along one line only: a module loses by its own damping or not at all.
bool EnergyLoss::mayKeep(int mat) const {
  const scene::Scene& scene = networks_.scene();
  const bool is_scalar = scene.sectionOf(scene.mats[at(mat)]).geometry == scene::Geometry::kScalar;
  return !(is_scalar && networks_.isLinked(mat)) &&
         !(networks_.network().nodes[at(mat)].damping.range.lowest > 0.0);
}

bool EnergyLoss::bears(const scene::Lia& lia) {
  return scene::lawOf(lia.type).is_held &&
         scene::rangeOf(networks_.scene(), lia.damping).highest <= 0.0 && surrounds(lia);
}

bool EnergyLoss::surrounds(const scene::Lia& lia) {
  const std::set<int> islands = networks_.islandsAt(lia);
  return !crossesToAMass(lia) &&
         std::all_of(islands.begin(), islands.end(), [this](int island) { return loses(island); });
}

bool EnergyLoss::crossesToAMass(const scene::Lia& lia) const {
  return networks_.crossesRates(lia) && networks_.inverseMass(networks_.slowEnd(lia)) > 0.0;
}

bool EnergyLoss::loses(int island) {
  const int name = joined_.setOf(island);
  const auto [known, is_new] = of_group_.try_emplace(name);
  if (is_new) {
    known->second = judge(groups_[name]);
  }
  return known->second;
}

bool EnergyLoss::judge(const Group& group) {
  if (group.keeps || group.divisors.size() != 1) {
    return false;
  }
  return std::all_of(group.islands.begin(), group.islands.end(), [&](int island) {
    return losesInEveryMotion(networks_.atOwnRate(*group.divisors.begin(), island, true));
  });
}

}  // namespace ergotic::physics
