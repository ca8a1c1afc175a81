// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

Varying varying(const scene::Scene& scene, const scene::Value& v) {
  return {scene.valueOf(v), rangeOf(scene, v)};
}

/// Mass of a module. Nothing is proven of a mass that follows an audio input: it counts as too
/// heavy to move, so that the module is not reported as unstable, either.
Varying massOf(const scene::Scene& scene, const scene::Mat& mat) {
  constexpr double kHeavy = 1e6;  // kg
  return mat.mass.audio < 0 ? varying(scene, mat.mass) : Varying{kHeavy, {kHeavy, kHeavy}};
}

Varying operator+(const Varying& a, const Varying& b) {
  return {a.now + b.now, {a.range.lowest + b.range.lowest, a.range.highest + b.range.highest}};
}

/// Cells that ask for matched coefficients have them, and so have masses in a medium.
Network::Node nodeOf(const scene::Scene& scene, const scene::Mat& mat) {
  Network::Node node;
  node.section = mat.section;
  node.is_free = mat.type == MatType::kMass || mat.type == MatType::kCell;
  if (!node.is_free) {
    return node;
  }
  const scene::Value& medium = scene.sectionOf(mat).medium;
  node.mass = massOf(scene, mat);
  node.damping = varying(scene, medium);
  node.is_matched = largest(scene, medium) > 0.0;
  if (mat.type == MatType::kCell) {
    node.stiffness = varying(scene, mat.stiffness);
    node.damping = node.damping + varying(scene, mat.damping);
    node.is_matched = mat.matched;
  }
  return node;
}

Network::Link linkOf(const scene::Scene& scene, const scene::Lia& lia) {
  Network::Link link;
  link.a = lia.a;
  link.b = lia.b;
  const scene::Law& law = scene::lawOf(lia.type);
  link.slopes = law.slopes(scene, lia);
  link.at_rest = law.has_linear_part ? scene.valueOf(lia.stiffness) : 0.0;
  link.at_least = law.leastStiffness(scene, lia);
  if (lia.bend >= 0) {
    // All its springs are soft together, those that are negative too.
    const Range& k = link.slopes.stiffness;
    link.at_least = k.lowest < 0.0 ? k.highest : k.lowest;
  }
  return link;
}

Network::Bend bendOf(const scene::Scene& scene,
                     const std::vector<Network::Node>& nodes,
                     const scene::Bend& bend) {
  Shares ends;
  for (const scene::Bend::End& end : bend.ends) {
    if (nodes[at(end.mat)].is_free) {
      ends.push_back({end.mat, end.weight});
    }
  }
  return {std::move(ends), rangeOf(scene, bend.stiffness), rangeOf(scene, bend.damping),
          bend.first_lia};
}

/// Fractions of a grid at which its lines are that a place can lie between; one if it stays.
std::vector<double> linesOf(const scene::Scene& scene,
                            const scene::Connection::Way& way,
                            int count) {
  const Range allowed{way.minimum, way.maximum};
  const Range range = way.guide >= 0 || way.at.audio >= 0 ? allowed : rangeOf(scene, way.at);
  const double low = std::clamp(range.lowest, allowed.lowest, allowed.highest);
  const double high = std::clamp(range.highest, allowed.lowest, allowed.highest);
  if (low == high || count < 2) {
    return {low};
  }
  std::vector<double> lines;
  const int last = static_cast<int>(std::ceil(high * (count - 1)));
  for (int line = static_cast<int>(std::floor(low * (count - 1))); line <= last; ++line) {
    lines.push_back(static_cast<double>(line) / (count - 1));
  }
  return lines;
}

void addShare(const std::vector<Network::Node>& nodes, int mat, double weight, Shares& to) {
  if (weight != 0.0 && nodes[at(mat)].is_free) {
    to.push_back({mat, weight});
  }
}

Shares freeShares(const std::vector<Network::Node>& nodes, const scene::GridPlace& place) {
  Shares shares;
  for (std::size_t i = 0; i < at(place.count); ++i) {
    addShare(nodes, place.mats[i], place.weights[i], shares);
  }
  return shares;
}

Network::Point pointOf(const std::vector<Network::Node>& nodes, const scene::Tap& tap) {
  Network::Point point;
  for (const scene::Tap::Share& share : tap.shares) {
    addShare(nodes, share.mat, share.weight, point.now);
  }
  point.places = {point.now};
  return point;
}

/// The largest eigenvalue is convex in the place between two grid lines, so places on them suffice.
Network::Point pointOf(const scene::Scene& scene,
                       const std::vector<Network::Node>& nodes,
                       const scene::Connection& connection) {
  const scene::Grid& grid = scene.grids[at(connection.grid)];
  const std::vector<double> across = linesOf(scene, connection.across, grid.rows);
  Network::Point point;
  point.now = freeShares(nodes, scene::placeOf(scene, connection));
  for (const double x : linesOf(scene, connection.along, grid.columns)) {
    for (const double y : across) {
      point.places.push_back(freeShares(nodes, scene::placeOn(grid, x, y)));
    }
  }
  return point;
}

}  // namespace

Network::Network(const scene::Scene& of) : scene(of), point_of(of.mats.size(), -1) {
  nodes.reserve(scene.mats.size());
  for (const scene::Mat& mat : scene.mats) {
    nodes.push_back(nodeOf(scene, mat));
  }
  links.reserve(scene.lias.size());
  for (const scene::Lia& lia : scene.lias) {
    links.push_back(linkOf(scene, lia));
  }
  for (const scene::Bend& bend : scene.bends) {
    bends.push_back(bendOf(scene, nodes, bend));
  }
  for (const scene::Connection& connection : scene.connections) {
    point_of[at(connection.mat)] = static_cast<int>(points.size());
    points.push_back(pointOf(scene, nodes, connection));
  }
  for (const scene::Tap& tap : scene.taps) {
    point_of[at(tap.mat)] = static_cast<int>(points.size());
    points.push_back(pointOf(nodes, tap));
  }
}

Shares sharesNow(const Network& network, int node) {
  const int point = network.point_of[at(node)];
  if (point >= 0) {
    return network.points[at(point)].now;
  }
  return network.nodes[at(node)].is_free ? Shares{{node, 1.0}} : Shares{};
}

std::vector<Shares> placesOf(const Network& network, int node) {
  const int point = network.point_of[at(node)];
  return point >= 0 ? network.points[at(point)].places
                    : std::vector<Shares>{sharesNow(network, node)};
}

Shares sharesAmong(const Network& network, const std::vector<int>& row_of, int node) {
  Shares shares;
  for (const auto& [module, weight] : sharesNow(network, node)) {
    if (row_of[at(module)] >= 0) {
      shares.push_back({row_of[at(module)], weight});
    }
  }
  return shares;
}

Shares endsAmong(const Network& network,
                 const std::vector<int>& row_of,
                 const Network::Link& link) {
  Shares ends = sharesAmong(network, row_of, link.a);
  for (const auto& [row, weight] : sharesAmong(network, row_of, link.b)) {
    ends.push_back({row, -weight});
  }
  return ends;
}

bool isTap(const Network& network, int node) {
  return network.point_of[at(node)] >= static_cast<int>(network.scene.connections.size());
}

bool leavesModesOut(const Network& network, int section) {
  int modules = 0;
  for (const Network::Node& node : network.nodes) {
    modules += node.is_free && node.section == section ? 1 : 0;
  }
  const int most = network.scene.sections[at(section)].modes;
  return most > scene::kNoModes && modules > most;
}

std::vector<std::vector<int>> linksOfNodes(const Network& network) {
  std::vector<std::vector<int>> links(network.nodes.size());
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    links[at(network.links[l].a)].push_back(static_cast<int>(l));
    links[at(network.links[l].b)].push_back(static_cast<int>(l));
  }
  return links;
}

}  // namespace ergotic::physics
