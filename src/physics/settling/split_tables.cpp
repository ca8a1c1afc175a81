// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <utility>

#include "at.hpp"
#include "ergotic/scene/table.hpp"
#include "physics/network/network_spectrum.hpp"
#include "physics/network/rated_network.hpp"
#include "physics/settling/steps.hpp"
#include "scene/laws/slopes.hpp"
#include "scene/laws/table_ends.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;
using scene::LiaType;
using scene::MatType;
using scene::Scene;
using scene::Scheme;

/// Part of the stiffness around a one-sided table that the spring split off takes. By about this
/// share, the two parts store more energy apart, which could become motion, than together.
constexpr double kShare = 1e-3;
/// Largest part of the stiffness or damping around a table that may be taken.
constexpr double kMax = 0.9;

/// Force that is split off: -k (e - e0) - z v.
struct Push {
  double k = 0.0;
  double e0 = 0.0;
  double z = 0.0;
};

/// Elastic force at the ends of a table while nothing moves.
scene::TableEnds elasticEndsOf(const Lia& lia) {
  return endsOf(lia.law->table) + forceAtRest(lia);
}

bool isPlain(const Scene& scene, int mat) {
  const MatType type = scene.mats[at(mat)].type;
  return type == MatType::kMass || type == MatType::kCell || type == MatType::kGround;
}

/// True for a link along one axis, at one rate, between modules that stay what they are.
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

/// The explicit network of an island without what ends on a slice: a hand may let go of that.
NetworkBound withoutHands(const RatedNetwork& networks, int divisor, int island) {
  const Scene& scene = networks.scene();
  const auto isSlice = [&](int mat) { return scene.mats[at(mat)].type == MatType::kSlice; };
  const NetworkBound all = networks.atOwnRate(divisor, island);
  NetworkBound alone(all.step());
  for (int node = 0; node < all.nodes(); ++node) {
    alone.addNode(all.mass(node), all.ownerOf(node));
  }
  for (const NetworkBound::Link& link : all.links()) {
    const bool is_own = link.label < 0;  // of a module
    if (is_own ||
        !(isSlice(scene.lias[at(link.label)].a) || isSlice(scene.lias[at(link.label)].b))) {
      alone.addLink(link.ends, link.stiffness, link.damping, link.label);
    }
  }
  return alone;
}

using Give = double (*)(const NetworkBound& network, const Shares& ends);

/// The stiffness (damping) with which linear springs (dampers) hold the ends of a link together; 0
/// if they do not.
double heldBy(const RatedNetwork& networks, const Lia& lia, Give giveOf) {
  const int divisor = networks.divisorOfMat(lia.a);
  double give = 0.0;
  for (const int island : networks.islandsAt(lia)) {
    if (!isOfOneRate(networks, island, divisor)) {
      return 0.0;
    }
    const NetworkBound network = withoutHands(networks, divisor, island);
    Shares ends;
    for (int node = 0; node < network.nodes(); ++node) {
      const int owner = network.ownerOf(node);
      if (owner == lia.a || owner == lia.b) {
        ends.push_back({node, owner == lia.a ? 1.0 : -1.0});
      }
    }
    give += giveOf(network, ends);
  }
  return give > 0.0 ? 1.0 / give : 0.0;
}

/// Finds a spring that leaves the rest of the table a potential with a lower bound.
bool findSpring(const RatedNetwork& networks, const Lia& lia, Push& push) {
  const scene::TableEnds ends = elasticEndsOf(lia);
  if (!ends.push()) {
    return true;
  }
  const double held = heldBy(networks, lia, NetworkSpectrum::softness);
  if (ends.low <= ends.high) {
    push.k = kShare * held;
    push.e0 = ends.constant() / push.k;
    return held > 0.0;
  }
  // Between two ways out there may be wells, of which a tank would know the deepest: not so where
  // what is left nowhere falls.
  const Scene& scene = networks.scene();
  const scene::Curve curve = scene::interpolate(lia.law->table);
  const double e =
      scene.mats[at(lia.a)].rest.x() - scene.mats[at(lia.b)].rest.x() - lia.rest_length;
  push.k = -curve.smallest_slope;
  push.e0 = e + (scene::valueAt(curve, e) + forceAtRest(lia)) / push.k;
  return push.k <= kMax * held;
}

/// Finds a damper that leaves the rest of the table purely dissipative.
bool findDamper(const RatedNetwork& networks, const Lia& lia, Push& push) {
  push.z = scene::drive(lia.law->viscous_table);
  return push.z == 0.0 || push.z <= kMax * heldBy(networks, lia, NetworkSpectrum::mobility);
}

std::optional<Push> findPush(const RatedNetwork& networks, const Lia& lia) {
  Push push;
  const bool is_found = mayBeSplit(networks, lia) && findSpring(networks, lia, push) &&
                        findDamper(networks, lia, push);
  return is_found ? std::optional<Push>(push) : std::nullopt;
}

Lia splitOff(Lia& lia, const Push& push) {
  Lia off;
  off.name = scene::Name(lia.name + ".push");
  off.a = lia.a;
  off.b = lia.b;
  off.stiffness = {-push.k};
  off.damping = {-push.z};
  off.rest_length = lia.rest_length + push.e0;
  off.place = lia.place;
  lia.stiffness = {push.k};
  lia.damping = {push.z};
  lia.law.edit().width = {push.e0};
  lia.scheme = Scheme::kEnergyStable;
  return off;
}

}  // namespace

void splitTables(Scene& scene, const Rates& rates) {
  const std::size_t count = scene.lias.size();
  for (std::size_t l = 0; l < count; ++l) {
    const Lia& lia = scene.lias[l];
    if (lia.type != LiaType::kTable || lia.scheme == Scheme::kExplicit ||
        !(elasticEndsOf(lia).push() || scene::drive(lia.law->viscous_table) > 0.0)) {
      continue;
    }
    const Network network(scene);
    const std::optional<Push> push = findPush(RatedNetwork(network, rates), lia);
    if (push) {
      Lia off = splitOff(scene.lias[l], *push);
      scene.lias.push_back(std::move(off));
    } else if (lia.scheme == Scheme::kAuto && !lia.law->viscous_table.empty()) {
      scene.lias[l].scheme = Scheme::kExplicit;
    }
  }
}

}  // namespace ergotic::physics
