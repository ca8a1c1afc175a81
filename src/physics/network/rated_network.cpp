// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/rated_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/laws/matched_cell.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

/// (w h)^2 of a matched module, up to 0.1 % below half the rate.
constexpr double kMaxAngle2 = 9.85;

}  // namespace

/// A network being built, with the nodes of its modules.
struct RatedNetwork::Builder {
  NetworkBound network;
  int divisor;
  int island;
  std::unordered_map<int, int> nodes;  // by module
  Part part = Part::kSteepest;

  int nodeOf(int mat, double mass) {
    const auto [known, is_new] = nodes.try_emplace(mat, 0);
    if (is_new) {
      known->second = network.addNode(mass, mat);
    }
    return known->second;
  }
};

RatedNetwork::RatedNetwork(const Network& network, const Rates& rates)
    : network_(network),
      scene_(network.scene),
      rates_(rates),
      island_(network.nodes.size()),
      is_linked_(network.nodes.size(), 0) {
  joinGroups();
}

void RatedNetwork::joinGroups() {
  DisjointSets sets(island_.size());
  for (const scene::Lia& lia : scene_.lias) {
    if (!isExplicit(lia)) {
      continue;
    }
    int first = -1;
    for (const int end : {lia.a, lia.b}) {
      for (const Shares& place : placesOf(end)) {
        for (const Share& share : place) {
          is_linked_[at(share.node)] = 1;
          first = first < 0 ? share.node : first;
          sets.join(share.node, first);
        }
      }
    }
  }
  for (int m = 0; m < static_cast<int>(island_.size()); ++m) {
    island_[at(m)] = sets.setOf(m);
  }
}

int RatedNetwork::divisorOfMat(int mat) const {
  return divisorOf(scene_.sections[at(nodeOf(mat).section)], rates_);
}

double RatedNetwork::inverseMass(int mat) const {
  double largest = 0.0;
  for (const Shares& place : placesOf(mat)) {
    double inverse = 0.0;
    for (const Share& share : place) {
      inverse += share.weight * share.weight / nodeOf(share.node).mass.range.lowest;
    }
    largest = std::max(largest, inverse);
  }
  return largest;
}

double RatedNetwork::stepOf(const scene::Lia& lia) const {
  const int a = divisorOfMat(lia.a);
  const int b = divisorOfMat(lia.b);
  return StepUnits(scene_, rates_, std::min(a, b)).step;
}

double RatedNetwork::inverseMassStep(const scene::Lia& lia) const {
  return stepOf(lia) * (inverseMass(lia.a) + inverseMass(lia.b));
}

double RatedNetwork::inverseMassStep2(const scene::Lia& lia) const {
  return stepOf(lia) * inverseMassStep(lia);
}

bool RatedNetwork::crossesRates(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) != divisorOfMat(lia.b);
}

int RatedNetwork::slowEnd(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) > divisorOfMat(lia.b) ? lia.a : lia.b;
}

int RatedNetwork::fastEnd(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) > divisorOfMat(lia.b) ? lia.b : lia.a;
}

bool RatedNetwork::isExplicit(const scene::Lia& lia) const {
  return lia.scheme == scene::Scheme::kExplicit;
}

bool RatedNetwork::isMovingPoint(int mat) const {
  const int point = network_.point_of[at(mat)];
  return point >= 0 && network_.points[at(point)].places.size() > 1;
}

bool RatedNetwork::isMoving(const scene::Lia& lia) const {
  return isMovingPoint(lia.a) || isMovingPoint(lia.b);
}

bool RatedNetwork::hasLineThatTurns(const scene::Lia& lia) const {
  const scene::Geometry a = scene_.sectionOf(scene_.mats[at(lia.a)]).geometry;
  const scene::Geometry b = scene_.sectionOf(scene_.mats[at(lia.b)]).geometry;
  return a != scene::Geometry::kScalar && b != scene::Geometry::kScalar &&
         (scene::dimensionsOf(a) > 1 || scene::dimensionsOf(b) > 1);
}

bool RatedNetwork::turns(const scene::Lia& lia) const {
  const bool is_projected =
      scene_.sectionOf(scene_.mats[at(lia.a)]).geometry == scene::Geometry::kScalar ||
      scene_.sectionOf(scene_.mats[at(lia.b)]).geometry == scene::Geometry::kScalar;
  const scene::Law::Kind kind = scene::lawOf(lia.type).kind;
  const bool is_spring = kind == scene::Law::Kind::kLinear || kind == scene::Law::Kind::kRelaxing;
  if (!is_spring || is_projected || !(inverseMassStep2(lia) > 0.0)) {
    return false;
  }
  const Slopes& slopes = linkOf(static_cast<int>(&lia - scene_.lias.data())).slopes;
  return kind == scene::Law::Kind::kRelaxing ||
         (lia.rest_length > 0.0 && slopes.stiffness.highest > 0.0) ||
         (hasLineThatTurns(lia) && (slopes.damping.lowest != 0.0 || slopes.damping.highest != 0.0));
}

bool RatedNetwork::onlyBrakes(const scene::Lia& lia) const {
  const scene::Law& law = scene::lawOf(lia.type);
  const bool along_slip = law.kind == scene::Law::Kind::kFriction;
  return law.onlyBrakes(lia) && (along_slip || !hasLineThatTurns(lia));
}

std::set<int> RatedNetwork::islandsAt(const scene::Lia& lia) const {
  std::set<int> islands;
  for (const int end : {lia.a, lia.b}) {
    for (const Shares& place : placesOf(end)) {
      for (const Share& share : place) {
        islands.insert(islandOf(share.node));
      }
    }
  }
  return islands;
}

int RatedNetwork::islandOf(const scene::Lia& lia) const {
  for (const int end : {lia.a, lia.b}) {
    for (const Shares& place : placesOf(end)) {
      if (!place.empty()) {
        return islandOf(place.front().node);
      }
    }
  }
  return -1;
}

bool RatedNetwork::hasLinkedMatched(int divisor) const {
  for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
    if (nodeOf(m).is_matched && is_linked_[at(m)] != 0 && divisorOfMat(m) == divisor) {
      return true;
    }
  }
  return false;
}

/// Adds the springs and dampers to the ground of the modules of one rate.
void RatedNetwork::addModules(Builder& to, bool plain) const {
  for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
    const Network::Node& node = nodeOf(m);
    const bool is_member = to.island == kAll || islandOf(m) == to.island;
    Range k = node.stiffness.range;
    Range z = node.damping.range;
    const double step = to.network.step();
    // Alone, its pole is that of the continuous oscillator: stable, unless rounding makes a double
    // one of it at half the rate.
    const bool is_safe = is_linked_[at(m)] == 0 && node.is_matched &&
                         k.highest / node.mass.range.lowest * step * step <= kMaxAngle2;
    if (!node.is_free || divisorOfMat(m) != to.divisor || !is_member || is_safe) {
      continue;
    }
    if (node.is_matched && !plain) {
      k = {0.0, matchedLoad(k, z, node.mass.range, step) / (step * step)};
      z = {};
    }
    if (k.highest != 0.0 || z.highest != 0.0) {
      to.network.addLink({{to.nodeOf(m, node.mass.range.lowest), 1.0}}, k, z, -1);
    }
  }
}

Slopes RatedNetwork::slopesOf(const scene::Lia& lia, Part part) const {
  const scene::Law& law = scene::lawOf(lia.type);
  const bool is_linear =
      law.kind == scene::Law::Kind::kLinear || law.kind == scene::Law::Kind::kRelaxing;
  if (part == Part::kAtRest && !is_linear) {
    return law.has_linear_part
               ? Slopes{rangeOf(scene_, lia.stiffness), rangeOf(scene_, lia.damping)}
               : Slopes{};
  }
  const bool is_bounded =
      law.friction != nullptr || (law.is_held && rangeOf(scene_, lia.damping).highest <= 0.0);
  return part == Part::kUnbounded && is_bounded ? Slopes{}
                                                : scene::slopesInSteps(scene_, lia, stepOf(lia));
}

void RatedNetwork::addLink(Builder& to, int l, bool hold_a, bool hold_b) const {
  const scene::Lia& lia = scene_.lias[at(l)];
  const auto nodesOf = [&](const Shares& place, double sign) {
    Shares shares;
    for (const Share& share : place) {
      const int node = to.nodeOf(share.node, nodeOf(share.node).mass.range.lowest);
      shares.push_back({node, sign * share.weight});
    }
    return shares;
  };
  const std::vector<Shares> held(1);
  const std::vector<Shares> at_a = hold_a ? held : placesOf(lia.a);
  const std::vector<Shares> at_b = hold_b ? held : placesOf(lia.b);
  const Slopes steepest = slopesOf(lia, to.part);
  const Range& k = steepest.stiffness;
  const Range& z = steepest.damping;
  if (at_a.size() > 1 && at_b.size() > 1) {
    // (u - v)(u - v)^T <= 2 u u^T + 2 v v^T: each end by itself.
    for (const std::vector<Shares>& end : {at_a, at_b}) {
      std::vector<Shares> ends;
      std::transform(end.begin(), end.end(), std::back_inserter(ends),
                     [&](const Shares& place) { return nodesOf(place, 1.0); });
      to.network.addMovingLink(ends, 2.0 * k.highest, 2.0 * z.highest, l);
    }
    return;
  }
  std::vector<Shares> ends;
  for (const Shares& a : at_a) {
    for (const Shares& b : at_b) {
      ends.push_back(nodesOf(a, 1.0));
      const Shares others = nodesOf(b, -1.0);
      ends.back().insert(ends.back().end(), others.begin(), others.end());
    }
  }
  if (ends.size() == 1) {
    to.network.addLink(ends.front(), k, z, l);
  } else {
    to.network.addMovingLink(ends, k.highest, z.highest, l);
  }
}

/// The range, widened by the rounding of single precision.
Range roundedBend(const Range& range) {
  return {range.lowest * (1.0 - scene::kRoundingOfBends),
          range.highest * (1.0 + scene::kRoundingOfBends)};
}

/// Links of many ends, all of one section.
void RatedNetwork::addBends(Builder& to) const {
  for (const Network::Bend& bend : network_.bends) {
    if (bend.ends.empty() || divisorOfMat(bend.ends.front().node) != to.divisor ||
        (to.island != kAll && islandOf(bend.ends.front().node) != to.island)) {
      continue;
    }
    Shares ends = bend.ends;
    for (Share& end : ends) {
      end.node = to.nodeOf(end.node, nodeOf(end.node).mass.range.lowest);
    }
    to.network.addLink(ends, roundedBend(bend.stiffness), roundedBend(bend.damping),
                       bend.first_link);
  }
}

/// Adds the cells of the meshes whose modules are in the network.
void RatedNetwork::addCells(Builder& to) const {
  const auto nodeOf = [&](int mat) {
    const auto known = to.nodes.find(mat);
    return known == to.nodes.end() ? -1 : known->second;
  };
  for (const scene::Grid& grid : scene_.grids) {
    for (int row = 0; row + 1 < grid.rows; ++row) {
      for (int column = 0; column + 1 < grid.columns; ++column) {
        const int corner = grid.first + row * grid.columns + column;
        const int below = corner + grid.columns;
        const std::array<int, 4> nodes{nodeOf(corner), nodeOf(corner + 1), nodeOf(below),
                                       nodeOf(below + 1)};
        if (*std::max_element(nodes.begin(), nodes.end()) >= 0) {
          to.network.addCell(nodes);
        }
      }
    }
  }
}

NetworkBound RatedNetwork::ofOwnRate(int divisor, int island, bool plain, Part part) const {
  Builder builder{NetworkBound(StepUnits(scene_, rates_, divisor).step), divisor, island, {}, part};
  addModules(builder, plain);
  addBends(builder);
  for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const int a = divisorOfMat(lia.a);
    const int b = divisorOfMat(lia.b);
    if (isLoad(lia) && std::min(a, b) == divisor && (island == kAll || islandOf(lia) == island)) {
      addLink(builder, l, a != divisor, b != divisor);
    }
  }
  addCells(builder);
  return std::move(builder.network);
}

NetworkBound RatedNetwork::atSlowRate(int divisor, int island) const {
  Builder builder{NetworkBound(StepUnits(scene_, rates_, divisor).step), divisor, island, {}};
  addModules(builder, false);
  addBends(builder);
  for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const int a = divisorOfMat(lia.a);
    const int b = divisorOfMat(lia.b);
    // A slower end still is held; a held slow end leaves the link to the faster rate.
    const bool is_own = std::min(a, b) == divisor;
    const bool is_coupling = a != b && std::max(a, b) == divisor && inverseMass(slowEnd(lia)) > 0.0;
    if (isLoad(lia) && (is_own || is_coupling) && (island == kAll || islandOf(lia) == island)) {
      addLink(builder, l, a > divisor, b > divisor);
    }
  }
  return std::move(builder.network);
}

}  // namespace ergotic::physics
