// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/scene_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "ergotic/scene/grid.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/laws/matched_cell.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Grid lines between which a place can be: all of them, from the one before to the one after.
struct Lines {
  std::vector<double> fractions;  // one: it does not move
};

Lines linesOf(
    const scene::Scene& scene, const scene::Value& v, Range allowed, bool moves, int count) {
  Range span = rangeOf(scene, v);
  if (moves || v.audio >= 0) {
    span = allowed;
  }
  const double low = std::clamp(span.lowest, allowed.lowest, allowed.highest);
  const double high = std::clamp(span.highest, allowed.lowest, allowed.highest);
  if (low == high || count < 2) {
    return {{low}};
  }
  Lines lines;
  const int last = static_cast<int>(std::ceil(high * (count - 1)));
  for (int line = static_cast<int>(std::floor(low * (count - 1))); line <= last; ++line) {
    lines.fractions.push_back(static_cast<double>(line) / (count - 1));
  }
  return lines;
}

}  // namespace

/// A network being built, with the nodes of its modules.
struct SceneNetwork::Builder {
  NetworkBound network;
  int divisor;
  int group;
  std::unordered_map<int, int> nodes;  // by module

  int nodeOf(int mat, double mass) {
    const auto [known, is_new] = nodes.try_emplace(mat, 0);
    if (is_new) {
      known->second = network.addNode(mass, mat);
    }
    return known->second;
  }
};

SceneNetwork::SceneNetwork(const scene::Scene& scene, const Rates& rates)
    : scene_(scene),
      rates_(rates),
      connection_of_(scene.mats.size(), -1),
      group_(scene.mats.size()),
      is_linked_(scene.mats.size(), 0) {
  for (const scene::Lia& lia : scene.lias) {
    slopes_.push_back(slopesOf(scene, lia));
  }
  for (std::size_t c = 0; c < scene.connections.size(); ++c) {
    connection_of_[at(scene.connections[c].mat)] = static_cast<int>(c);
  }
  joinGroups();
}

void SceneNetwork::joinGroups() {
  DisjointSets sets(group_.size());
  for (const scene::Lia& lia : scene_.lias) {
    if (!isExplicit(lia)) {
      continue;
    }
    int first = -1;
    for (const int end : {lia.a, lia.b}) {
      for (const std::vector<Share>& place : placesOf(end)) {
        for (const Share& share : place) {
          is_linked_[at(share.node)] = 1;
          first = first < 0 ? share.node : first;
          sets.join(share.node, first);
        }
      }
    }
  }
  for (int m = 0; m < static_cast<int>(group_.size()); ++m) {
    group_[at(m)] = sets.setOf(m);
  }
}

int SceneNetwork::divisorOfMat(int mat) const {
  return divisorOf(scene_.sectionOf(scene_.mats[at(mat)]), rates_);
}

bool SceneNetwork::isFreeModule(int mat) const {
  const MatType type = scene_.mats[at(mat)].type;
  return type == MatType::kMass || type == MatType::kCell;
}

double SceneNetwork::inverseMass(int mat) const {
  double inverse = 0.0;
  for (const std::vector<Share>& place : placesOf(mat)) {
    for (const Share& share : place) {
      inverse = std::max(inverse, 1.0 / smallest(scene_, scene_.mats[at(share.node)].mass));
    }
  }
  return inverse;
}

double SceneNetwork::stepOf(const scene::Lia& lia) const {
  const int a = divisorOfMat(lia.a);
  const int b = divisorOfMat(lia.b);
  return StepUnits(scene_, rates_, std::min(a, b)).step;
}

double SceneNetwork::inverseMassStep(const scene::Lia& lia) const {
  return stepOf(lia) * (inverseMass(lia.a) + inverseMass(lia.b));
}

double SceneNetwork::inverseMassStep2(const scene::Lia& lia) const {
  return stepOf(lia) * inverseMassStep(lia);
}

bool SceneNetwork::crossesRates(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) != divisorOfMat(lia.b);
}

int SceneNetwork::slowEnd(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) > divisorOfMat(lia.b) ? lia.a : lia.b;
}

int SceneNetwork::fastEnd(const scene::Lia& lia) const {
  return divisorOfMat(lia.a) > divisorOfMat(lia.b) ? lia.b : lia.a;
}

bool SceneNetwork::isExplicit(const scene::Lia& lia) const {
  return lia.scheme == scene::Scheme::kExplicit;
}

bool SceneNetwork::isMovingPoint(int mat) const {
  return placesOf(mat).size() > 1;
}

bool SceneNetwork::isMoving(const scene::Lia& lia) const {
  return isMovingPoint(lia.a) || isMovingPoint(lia.b);
}

int SceneNetwork::groupOf(const scene::Lia& lia) const {
  for (const int end : {lia.a, lia.b}) {
    for (const std::vector<Share>& place : placesOf(end)) {
      if (!place.empty()) {
        return groupOf(place.front().node);
      }
    }
  }
  return -1;
}

std::vector<Share> SceneNetwork::freeShares(std::vector<Share> shares) const {
  shares.erase(std::remove_if(shares.begin(), shares.end(),
                              [&](const Share& share) {
                                return share.weight == 0.0 || !isFreeModule(share.node);
                              }),
               shares.end());
  return shares;
}

SceneNetwork::Places SceneNetwork::placesOf(int mat) const {
  const int connection = connection_of_[at(mat)];
  if (connection >= 0) {
    return placesOf(scene_.connections[at(connection)]);
  }
  return {freeShares({{mat, 1.0}})};
}

/// The largest eigenvalue is convex in the place between two grid lines, so places on them suffice.
SceneNetwork::Places SceneNetwork::placesOf(const scene::Connection& connection) const {
  const scene::Grid& grid = scene_.grids[at(connection.grid)];
  const Range range{connection.along_minimum, connection.along_maximum};
  const Lines along = linesOf(scene_, connection.along, range, connection.guide >= 0, grid.columns);
  const Lines across = linesOf(scene_, connection.across, {0.0, 1.0}, false, grid.rows);
  Places places;
  for (const double x : along.fractions) {
    for (const double y : across.fractions) {
      const scene::GridPlace place = scene::placeOn(grid, x, y);
      std::vector<Share> shares;
      for (int i = 0; i < place.count; ++i) {
        shares.push_back({place.mats[at(i)], place.weights[at(i)]});
      }
      places.push_back(freeShares(std::move(shares)));
    }
  }
  return places;
}

/// Cells that ask for it, and masses in a medium.
bool SceneNetwork::isMatched(int m) const {
  const scene::Mat& mat = scene_.mats[at(m)];
  return mat.type == MatType::kCell
             ? mat.matched
             : isFreeModule(m) && largest(scene_, scene_.sectionOf(mat).medium) > 0.0;
}

bool SceneNetwork::hasLinkedMatched(int divisor) const {
  for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
    if (isMatched(m) && is_linked_[at(m)] != 0 && divisorOfMat(m) == divisor) {
      return true;
    }
  }
  return false;
}

/// What modules of one rate do by themselves.
void SceneNetwork::addModules(Builder& to, bool plain) const {
  for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
    const scene::Mat& mat = scene_.mats[at(m)];
    const bool is_member = to.group == kAll || groupOf(m) == to.group;
    const bool is_alone = is_linked_[at(m)] == 0;
    if (!isFreeModule(m) || divisorOfMat(m) != to.divisor || !is_member ||
        (is_alone && isMatched(m))) {
      continue;  // alone, its pole is that of the continuous oscillator: always stable
    }
    Range k;
    Range z = rangeOf(scene_, scene_.sectionOf(mat).medium);
    if (mat.type == MatType::kCell) {
      k = rangeOf(scene_, mat.stiffness);
      const Range own = rangeOf(scene_, mat.damping);
      z = {z.lowest + own.lowest, z.highest + own.highest};
    }
    if (isMatched(m) && !plain) {
      const double step = to.network.step();
      k = {0.0, matchedLoad(k, z, rangeOf(scene_, mat.mass), step) / (step * step)};
      z = {};
    }
    if (k.highest != 0.0 || z.highest != 0.0) {
      to.network.addLink({{to.nodeOf(m, smallest(scene_, mat.mass)), 1.0}}, k, z, -1);
    }
  }
}

void SceneNetwork::addLink(Builder& to, int l, bool hold_a, bool hold_b) const {
  const scene::Lia& lia = scene_.lias[at(l)];
  const auto nodesOf = [&](const std::vector<Share>& place, double sign) {
    std::vector<Share> shares;
    for (const Share& share : place) {
      const double mass = smallest(scene_, scene_.mats[at(share.node)].mass);
      shares.push_back({to.nodeOf(share.node, mass), sign * share.weight});
    }
    return shares;
  };
  const Places held{{}};
  const Places at_a = hold_a ? held : placesOf(lia.a);
  const Places at_b = hold_b ? held : placesOf(lia.b);
  const Range& k = slopes(l).stiffness;
  const Range& z = slopes(l).damping;
  if (at_a.size() > 1 && at_b.size() > 1) {
    // (u - v)(u - v)^T <= 2 u u^T + 2 v v^T: each end by itself.
    for (const Places& end : {at_a, at_b}) {
      Places ends;
      std::transform(end.begin(), end.end(), std::back_inserter(ends),
                     [&](const std::vector<Share>& place) { return nodesOf(place, 1.0); });
      to.network.addMovingLink(ends, 2.0 * k.highest, 2.0 * z.highest, l);
    }
    return;
  }
  Places ends;
  for (const std::vector<Share>& a : at_a) {
    for (const std::vector<Share>& b : at_b) {
      ends.push_back(nodesOf(a, 1.0));
      const std::vector<Share> others = nodesOf(b, -1.0);
      ends.back().insert(ends.back().end(), others.begin(), others.end());
    }
  }
  if (ends.size() == 1) {
    to.network.addLink(ends.front(), k, z, l);
  } else {
    to.network.addMovingLink(ends, k.highest, z.highest, l);
  }
}

/// Of the meshes that are in the network.
void SceneNetwork::addCells(Builder& to) const {
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

NetworkBound SceneNetwork::atOwnRate(int divisor, int group, bool plain) const {
  Builder builder{NetworkBound(StepUnits(scene_, rates_, divisor).step), divisor, group, {}};
  addModules(builder, plain);
  for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const int a = divisorOfMat(lia.a);
    const int b = divisorOfMat(lia.b);
    if (isExplicit(lia) && std::min(a, b) == divisor && (group == kAll || groupOf(lia) == group)) {
      addLink(builder, l, a != divisor, b != divisor);
    }
  }
  addCells(builder);
  return std::move(builder.network);
}

NetworkBound SceneNetwork::atSlowRate(int divisor, int group) const {
  Builder builder{NetworkBound(StepUnits(scene_, rates_, divisor).step), divisor, group, {}};
  addModules(builder, false);
  for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const int a = divisorOfMat(lia.a);
    const int b = divisorOfMat(lia.b);
    // A slower end still is held; a held slow end leaves the link to the faster rate.
    const bool is_own = std::min(a, b) == divisor;
    const bool is_coupling = a != b && std::max(a, b) == divisor && inverseMass(slowEnd(lia)) > 0.0;
    if (isExplicit(lia) && (is_own || is_coupling) && (group == kAll || groupOf(lia) == group)) {
      addLink(builder, l, a > divisor, b > divisor);
    }
  }
  return std::move(builder.network);
}

}  // namespace ergotic::physics
