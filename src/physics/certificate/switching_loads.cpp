// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/switching_loads.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {

SwitchingLoads::SwitchingLoads(const RatedNetwork& networks)
    : networks_(networks), load_(networks.scene().mats.size(), 0.0) {
  const scene::Scene& scene = networks.scene();
  std::vector<int> modules;
  for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
    const scene::Lia& lia = scene.lias[at(l)];
    if (lia.scheme == scene::Scheme::kGuarded || !scene::lawOf(lia.type).switches) {
      continue;
    }
    modules.clear();
    for (const int end : {lia.a, lia.b}) {
      for (const Shares& place : placesOf(networks.network(), end)) {
        for (const Share& share : place) {
          modules.push_back(share.node);
        }
      }
    }
    std::sort(modules.begin(), modules.end());
    modules.erase(std::unique(modules.begin(), modules.end()), modules.end());
    const double step = networks.stepOf(lia);
    for (const int m : modules) {
      load_[at(m)] += step * step * networks.slopes(l).stiffness.highest * networks.inverseMass(m);
    }
  }
}

double SwitchingLoads::kappa(const scene::Lia& lia) const {
  return loadOn(lia.a) + loadOn(lia.b);
}

double SwitchingLoads::leastDamping(const scene::Lia& lia) const {
  const double stiffness =
      networks_.slopes(static_cast<int>(&lia - networks_.scene().lias.data())).stiffness.highest;
  return kLossOfHit * networks_.stepOf(lia) * stiffness * std::sqrt(kappa(lia));
}

bool SwitchingLoads::losesMore(const scene::Lia& lia) const {
  return scene::rangeOf(networks_.scene(), lia.damping).lowest >= leastDamping(lia);
}

double SwitchingLoads::loadOn(int end) const {
  double load = 0.0;
  for (const Shares& place : placesOf(networks_.network(), end)) {
    for (const Share& share : place) {
      load = std::max(load, load_[at(share.node)]);
    }
  }
  return load;
}

}  // namespace ergotic::physics
