// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/couplings.hpp"

#include <algorithm>

#include "at.hpp"

namespace ergotic::physics {
namespace {

void addCrossing(const RatedNetwork& networks, int l, Coupling& coupling) {
  const scene::Lia& lia = networks.scene().lias[at(l)];
  const int slow = networks.slowEnd(lia);
  const int divisor = networks.divisorOfMat(slow);
  const int fast_divisor = networks.divisorOfMat(networks.fastEnd(lia));
  const int section = networks.scene().mats[at(slow)].section;
  coupling.slow_divisors.insert(divisor);
  if (divisor > coupling.slowest) {
    coupling.slowest = divisor;
    coupling.slow_section = section;
    coupling.fastest = fast_divisor;
  } else if (section == coupling.slow_section) {
    coupling.fastest = std::min(coupling.fastest, fast_divisor);
  }
  coupling.coupling_damping =
      std::max(coupling.coupling_damping, networks.slopes(l).damping.highest);
}

bool isCrossing(const RatedNetwork& networks, const scene::Lia& lia) {
  return networks.isExplicit(lia) && networks.crossesRates(lia) &&
         networks.inverseMass(networks.slowEnd(lia)) > 0.0;
}

}  // namespace

std::map<int, Coupling> findCouplings(const RatedNetwork& networks) {
  const std::vector<scene::Lia>& lias = networks.scene().lias;
  std::map<int, Coupling> found;
  for (std::size_t l = 0; l < lias.size(); ++l) {
    if (isCrossing(networks, lias[l])) {
      addCrossing(networks, static_cast<int>(l), found[networks.islandOf(lias[l])]);
    }
  }
  for (std::size_t l = 0; l < lias.size() && !found.empty(); ++l) {
    const scene::Lia& lia = lias[l];
    if (lia.type == scene::LiaType::kSpringDamper && networks.isExplicit(lia)) {
      continue;
    }
    for (const int name : networks.islandsAt(lia)) {
      const auto coupling = found.find(name);
      if (coupling != found.end()) {
        coupling->second.nonlinear.push_back(static_cast<int>(l));
      }
    }
  }
  return found;
}

}  // namespace ergotic::physics
