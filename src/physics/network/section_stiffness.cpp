// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/section_stiffness.hpp"

#include <vector>

#include "at.hpp"
#include "physics/network/load_matrix.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::MatType;

/// Stiffness matrix of a spring of stiffness 1 between its two ends.
Eigen::Matrix3d tangent(const scene::Scene& scene, const scene::Lia& lia, Geometry geometry) {
  if (geometry == Geometry::kScalar || geometry == Geometry::kLine) {
    return Eigen::Matrix3d::Identity();
  }
  const Eigen::Vector3d line =
      movingPart(scene.mats[at(lia.a)].rest - scene.mats[at(lia.b)].rest, geometry);
  const double length = line.norm();
  if (!(length > 0.0)) {
    return lia.rest_length == 0.0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                  : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  }
  const double across = 1.0 - lia.rest_length / length;
  const Eigen::Vector3d n = line / length;
  return across * Eigen::Matrix3d::Identity() + (1.0 - across) * n * n.transpose();
}

}  // namespace

Eigen::SparseMatrix<double> stiffnessOf(const Network& network, int section) {
  const scene::Scene& scene = network.scene;
  const Geometry geometry = scene.sections[at(section)].geometry;
  std::vector<int> row_of(network.nodes.size(), -1);
  int rows = 0;
  for (std::size_t m = 0; m < row_of.size(); ++m) {
    row_of[m] = network.nodes[m].is_free && network.nodes[m].section == section ? rows++ : -1;
  }
  LoadMatrix stiffness(rows, scene::dimensionsOf(geometry));
  for (std::size_t m = 0; m < row_of.size(); ++m) {
    if (row_of[m] >= 0 && scene.mats[m].type == MatType::kCell) {
      stiffness.add(row_of[m], row_of[m],
                    network.nodes[m].stiffness.range.lowest * Eigen::Matrix3d::Identity());
    }
  }
  // Ground ends hold as well; points are not counted on, and neither is what is moved from outside.
  const auto isInside = [&](int m) {
    return row_of[at(m)] >= 0 ||
           (network.nodes[at(m)].section == section && scene.mats[at(m)].type == MatType::kGround);
  };
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    const Network::Link& link = network.links[l];
    if (link.at_least != 0.0 && isInside(link.a) && isInside(link.b)) {
      const Eigen::Matrix3d block = link.at_least * tangent(scene, scene.lias[l], geometry);
      stiffness.addLoad(endsAmong(network, row_of, link),
                        [&block](const Share& a, const Share& b) -> Eigen::Matrix3d {
                          return a.weight * b.weight * block;
                        });
    }
  }
  return stiffness.sum();
}

Eigen::Vector3d movingPart(const Eigen::Vector3d& v, Geometry geometry) {
  const int dimensions = scene::dimensionsOf(geometry);
  return {v.x(), dimensions > 1 ? v.y() : 0.0, dimensions > 2 ? v.z() : 0.0};
}

}  // namespace ergotic::physics
