// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/attached.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "at.hpp"
#include "physics/network/section_stiffness.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

constexpr double kSway = 0.01;    // m
constexpr double kMaxLead = 0.1;  // of what a link itself answers
constexpr int kNearest = 16;      // of more than can be worked out
constexpr double kAxisRounding = 1e-9;

/// True if what moves along the axes of one section is not all seen in another.
bool isHidden(const scene::Section& axes, const scene::Section& from) {
  const Eigen::Matrix3d turn = from.pose.linear().transpose() * axes.pose.linear();
  const Eigen::Index seen = scene::dimensionsOf(from.geometry);
  for (Eigen::Index axis = 0; axis < scene::dimensionsOf(axes.geometry); ++axis) {
    if (turn.col(axis).head(seen).norm() < 1.0 - kAxisRounding) {
      return true;
    }
  }
  return false;
}

/// True if a link acts along axes that are not those of a mass at its end, which by that is slower
/// than its weight tells. A slice that is turned only feels less.
bool hidesAMass(const scene::Scene& scene, const scene::Lia& lia) {
  const auto isSlice = [&](int mat) { return scene.mats[at(mat)].type == MatType::kSlice; };
  const scene::Section& a = scene.sectionOf(scene.mats[at(lia.a)]);
  const scene::Section& b = scene.sectionOf(scene.mats[at(lia.b)]);
  if (&a == &b || (a.geometry == b.geometry && a.geometry == scene::Geometry::kScalar)) {
    return false;
  }
  const bool is_of_b = b.geometry < a.geometry;
  return is_of_b ? !isSlice(lia.a) && isHidden(b, a) : !isSlice(lia.b) && isHidden(a, b);
}

/// How far the force of a link to a point leads, per metre, when what guides it moves by a metre:
/// the modules under it lie so much apart at the start, or come to by moving a centimetre.
double leadOf(const scene::Scene& scene,
              const scene::Connection& connection,
              const scene::Connection::Way& way) {
  const scene::Grid& grid = scene.grids[at(connection.grid)];
  const scene::Geometry geometry = scene.sectionOf(scene.mats[at(connection.mat)]).geometry;
  const bool is_along = &way == &connection.along;
  const int next = is_along ? 1 : grid.columns;
  double apart = 0.0;
  for (int m = grid.first; m < grid.first + grid.columns * grid.rows - next; ++m) {
    const bool ends_row = is_along && (m - grid.first + 1) % grid.columns == 0;
    const Eigen::Vector3d step = scene.mats[at(m + next)].position - scene.mats[at(m)].position;
    apart = ends_row ? apart : std::max(apart, movingPart(step, geometry).norm());
  }
  const int count = is_along ? grid.columns : grid.rows;
  return std::abs(way.scale) * (apart * (count - 1) + kSway);
}

/// Modules under every point, and points on every module: as they are now, or wherever they may be.
std::vector<std::set<int>> joinedByPoints(const Network& network, bool anywhere) {
  std::vector<std::set<int>> joined(network.nodes.size());
  for (int node = 0; node < static_cast<int>(network.nodes.size()); ++node) {
    for (const Shares& shares :
         anywhere ? placesOf(network, node) : std::vector<Shares>{sharesNow(network, node)}) {
      for (const Share& share : shares) {
        if (share.node != node) {
          joined[at(node)].insert(share.node);
          joined[at(share.node)].insert(node);
        }
      }
    }
  }
  return joined;
}

/// Collects what links join to a slice, up to so many masses, the nearest first.
Attached reachedFrom(int slice,
                     const Network& network,
                     const std::vector<std::set<int>>& joined,
                     const Hands& hands,
                     int most) {
  const std::vector<std::vector<int>> links_of = linksOfNodes(network);
  Attached attached{{slice}, {slice}};
  std::vector<int> reached{slice};
  const auto reach = [&](int node) {
    const bool is_slice = hands[at(node)] != 0;
    const bool is_free = network.nodes[at(node)].is_free;
    if ((!is_slice && !is_free && network.point_of[at(node)] < 0) ||
        attached.nodes.count(node) != 0) {
      return;
    }
    if (is_free && attached.masses == most) {
      attached.is_cut = true;
      return;
    }
    attached.nodes.insert(node);
    reached.push_back(node);
    attached.masses += is_free ? 1 : 0;
    if (is_slice) {
      attached.slices.push_back(node);
    }
  };
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const int node = reached[i];
    for (const int other : joined[at(node)]) {
      reach(other);
    }
    for (const int l : links_of[at(node)]) {
      reach(network.links[at(l)].a);
      reach(network.links[at(l)].b);
    }
  }
  return attached;
}

/// True if what is attached there moves a point that it pulls at: far along what is not straight,
/// or at all by way of other bodies that it moves points of.
bool leadsBack(const Attached& body, const Network& network) {
  const scene::Scene& scene = network.scene;
  const Hands hands = handsOn(scene, slicesInHands(scene));
  const auto isOfBody = [&](int mat) { return body.nodes.count(mat) != 0; };
  std::set<int> moved = body.nodes;
  for (bool grows = true; grows;) {
    grows = false;
    for (const scene::Connection& connection : scene.connections) {
      for (const scene::Connection::Way* way : {&connection.along, &connection.across}) {
        if (moved.count(way->guide) == 0 || way->scale == 0.0) {
          continue;
        }
        const double most = isOfBody(way->guide) ? kMaxLead : 0.0;
        if (isOfBody(connection.mat) && leadOf(scene, connection, *way) > most) {
          return true;
        }
        if (moved.count(connection.mat) == 0) {
          const Attached other = bodyOn(connection.mat, network, hands);
          moved.insert(other.nodes.begin(), other.nodes.end());
          grows = true;
        }
      }
    }
  }
  return false;
}

}  // namespace

bool isFree(const scene::Mat& mat) {
  return mat.type == MatType::kMass || mat.type == MatType::kCell;
}

std::vector<int> slicesInHands(const scene::Scene& scene) {
  std::set<int> slices;
  for (const scene::Port& port : scene.ports) {
    if (port.agent < 0) {
      slices.insert(port.mat);
    }
  }
  return {slices.begin(), slices.end()};
}

Hands handsOn(const scene::Scene& scene, const std::vector<int>& slices) {
  Hands hands(scene.mats.size(), 0);
  for (const int slice : slices) {
    hands[at(slice)] = 1;
  }
  return hands;
}

Attached attachedTo(int slice, const Network& network, const Hands& hands, int most) {
  const std::vector<std::set<int>> joined = joinedByPoints(network, false);
  const Attached all = reachedFrom(slice, network, joined, hands, most);
  return all.is_cut ? reachedFrom(slice, network, joined, hands, kNearest) : all;
}

Attached bodyOn(int slice, const Network& network, const Hands& hands) {
  return reachedFrom(slice, network, joinedByPoints(network, true), hands,
                     std::numeric_limits<int>::max());
}

scene::Scene onlyOf(const Attached& attached, scene::Scene scene) {
  const auto isIn = [&](int node) { return attached.nodes.count(node) != 0; };
  scene.lias.erase(
      std::remove_if(scene.lias.begin(), scene.lias.end(),
                     [&](const scene::Lia& lia) { return !isIn(lia.a) && !isIn(lia.b); }),
      scene.lias.end());
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    if (isFree(scene.mats[m]) && !isIn(static_cast<int>(m))) {
      scene.mats[m].type = MatType::kGround;
    }
  }
  return scene;
}

const char* notTold(const Attached& body, const Network& network) {
  for (const int node : body.nodes) {
    if (network.nodes[at(node)].is_free &&
        leavesModesOut(network, network.nodes[at(node)].section)) {
      return "a section that is played by fewer modes";
    }
  }
  return leadsBack(body, network) ? "a point that it moves and pulls at" : nullptr;
}

const char* notWorkedOut(const Attached& attached, const scene::Scene& scene, const Rates& rates) {
  for (const int node : attached.nodes) {
    const scene::Mat& mat = scene.mats[at(node)];
    if (isFree(mat) && divisorOf(scene.sectionOf(mat), rates) > rates.ratio) {
      return "a section that is slower than the slice";
    }
  }
  const auto isIn = [&](int node) { return attached.nodes.count(node) != 0; };
  const bool is_hidden = std::any_of(scene.lias.begin(), scene.lias.end(), [&](const auto& lia) {
    return isIn(lia.a) && isIn(lia.b) && hidesAMass(scene, lia);
  });
  return is_hidden ? "masses that move along other axes than their links" : nullptr;
}

}  // namespace ergotic::physics
