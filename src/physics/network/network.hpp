// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/scene.hpp"
#include "scene/laws/slopes.hpp"

namespace ergotic::physics {

using scene::Range;
using scene::Slopes;

/// How much a node counts at an end of a link.
struct Share {
  int node = 0;
  double weight = 1.0;
};
using Shares = std::vector<Share>;

/// A number of the scene: at the present values of the parameters, and over their ranges.
struct Varying {
  double now = 0.0;
  Range range;
};

/// A scene as masses and what pulls at them: assembled from its modules and links once, and read by
/// all that judges or chooses. A link is a load k u u^T, z u u^T with u the shares of its ends,
/// those of b negative; what no force moves has none. Plain data, in the scene's units.
struct Network {
  /// A module or point; forces move the free ones.
  struct Node {
    int section = 0;
    bool is_free = false;     ///< a mass or a cell; only these have what follows
    bool is_matched = false;  ///< its coefficients are those of the continuous oscillator
    Varying mass;
    Varying stiffness;  ///< stiffness to the ground
    Varying damping;    ///< damping to the ground, its section's medium included
  };
  /// Modules on which a point or a tap depends, with their weights.
  struct Point {
    Shares now;                  ///< at the present values of the parameters
    std::vector<Shares> places;  ///< on all grid lines that it can reach: the worst is among them
  };
  struct Link {
    int a = 0;  ///< nodes
    int b = 0;
    Slopes slopes;          ///< the steepest, over all ranges
    double at_rest = 0.0;   ///< slope at rest, at the present values; 0 of links that may let go
    double at_least = 0.0;  ///< slope that it has wherever it is, over all ranges; 0: it may let go
  };

  /// A link of many ends: a load of its own, which the links that it is stepped as are not.
  struct Bend {
    Shares ends;  ///< the free ones
    Range stiffness;
    Range damping;
    int first_link = 0;  ///< of those links
  };

  /// \param scene  must outlive it
  explicit Network(const scene::Scene& scene);

  const scene::Scene& scene;
  std::vector<Node> nodes;    ///< [Scene::mats]
  std::vector<Link> links;    ///< [Scene::lias]
  std::vector<Bend> bends;    ///< [Scene::bends]
  std::vector<Point> points;  ///< [Scene::connections], then [Scene::taps]
  std::vector<int> point_of;  ///< [nodes] index in `points`, -1: no point
};

/// Free modules at a module or point: as it is now, and at every place that it can lie on.
Shares sharesNow(const Network& network, int node);
std::vector<Shares> placesOf(const Network& network, int node);

/// Shares of a module or point, or of both ends of a link, as they are now, in the numbers of a
/// part of the network. \param row_of  [nodes] -1: outside, held
Shares sharesAmong(const Network& network, const std::vector<int>& row_of, int node);
Shares endsAmong(const Network& network, const std::vector<int>& row_of, const Network::Link& link);

bool isTap(const Network& network, int node);

/// True if a section is to be played by fewer modes than it has free modules.
bool leavesModesOut(const Network& network, int section);

/// Links of every node.
std::vector<std::vector<int>> linksOfNodes(const Network& network);

}  // namespace ergotic::physics
