// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/split_tables.hpp"

#include <set>
#include <utility>

#include "at.hpp"
#include "physics/network/network_spectrum.hpp"
#include "physics/network/rated_network.hpp"
#include "scene/laws/table_ends.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;
using scene::LiaType;
using scene::MatType;
using scene::Scene;
using scene::Scheme;

/// Of what holds a table, that it takes away. What the two parts store apart, and could make motion
/// of, is more than what they store together, by about this share.
constexpr double kShare = 1e-3;

/// While nothing moves.
scene::TableEnds elasticEndsOf(const Lia& lia) {
  return endsOf(lia.law->table) + forceAtRest(lia);
}

bool isPlain(const Scene& scene, int mat) {
  const MatType type = scene.mats[at(mat)].type;
  return type == MatType::kMass || type == MatType::kCell || type == MatType::kGround;
}

/// Along one axis, at one rate, between modules that stay what they are.
bool mayBeSplit(const RatedNetwork& networks, const Lia& lia) {
  const Scene& scene = networks.scene();
  const auto isScalar = [&](int mat) {
    return scene.sectionOf(scene.mats[at(mat)]).geometry == scene::Geometry::kScalar;
  };
  return isPlain(scene, lia.a) && isPlain(scene, lia.b) && !networks.crossesRates(lia) &&
         isScalar(lia.a) && isScalar(lia.b) && networks.inverseMassStep2(lia) > 0.0;
}

bool isOfOneRate(const RatedNetwork& networks, int island, int divisor) {
  for (int m = 0; m < static_cast<int>(networks.scene().mats.size()); ++m) {
    if (networks.network().nodes[at(m)].is_free && networks.islandOf(m) == island &&
        networks.divisorOfMat(m) != divisor) {
      return false;
    }
  }
  return true;
}

/// The stiffness with which linear springs hold the ends of a link together; 0 if they do not.
double heldBy(const RatedNetwork& networks, const Lia& lia) {
  const int divisor = networks.divisorOfMat(lia.a);
  double softness = 0.0;
  for (const int island : std::set<int>{networks.islandAt(lia.a), networks.islandAt(lia.b)}) {
    if (island < 0) {
      continue;
    }
    if (!isOfOneRate(networks, island, divisor)) {
      return 0.0;
    }
    const NetworkBound network = networks.atOwnRate(divisor, island);
    Shares ends;
    for (int node = 0; node < network.nodes(); ++node) {
      const int owner = network.ownerOf(node);
      if (owner == lia.a || owner == lia.b) {
        ends.push_back({node, owner == lia.a ? 1.0 : -1.0});
      }
    }
    softness += NetworkSpectrum::softness(network, ends);
  }
  return softness > 0.0 ? 1.0 / softness : 0.0;
}

/// \return -k (e - e0)
Lia splitOff(Lia& lia, double k) {
  const double e0 = elasticEndsOf(lia).constant() / k;
  Lia push;
  push.name = scene::Name(lia.name + ".push");
  push.a = lia.a;
  push.b = lia.b;
  push.stiffness = {-k};
  push.rest_length = lia.rest_length + e0;
  push.place = lia.place;
  lia.stiffness = {k};
  lia.law.edit().width = {e0};
  lia.scheme = Scheme::kGuarded;
  return push;
}

}  // namespace

void splitTables(Scene& scene, const Rates& rates) {
  const std::size_t count = scene.lias.size();
  for (std::size_t l = 0; l < count; ++l) {
    const Lia& lia = scene.lias[l];
    if (lia.type != LiaType::kTable || lia.scheme == Scheme::kExplicit ||
        !elasticEndsOf(lia).push()) {
      continue;
    }
    const Network network(scene);
    const RatedNetwork networks(network, rates);
    const scene::TableEnds ends = elasticEndsOf(lia);
    const bool is_constant = ends.low <= ends.high;
    const double held = is_constant && mayBeSplit(networks, lia) ? heldBy(networks, lia) : 0.0;
    if (held > 0.0) {
      Lia push = splitOff(scene.lias[l], kShare * held);
      scene.lias.push_back(std::move(push));
    } else if (lia.scheme == Scheme::kAuto && !lia.law->viscous_table.empty()) {
      scene.lias[l].scheme = Scheme::kExplicit;
    }
  }
}

}  // namespace ergotic::physics
