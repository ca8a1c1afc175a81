// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/hand_slopes.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;

constexpr double kRigidDamping = 1e30;  // N s/m, of what sticks together

/// Position of a module or point at the start, in the coordinates of its section, m.
Eigen::Vector3d startOf(const scene::Scene& scene, int mat) {
  for (const scene::Connection& connection : scene.connections) {
    if (connection.mat == mat) {
      const scene::GridPlace place = scene::placeOf(scene, connection);
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < at(place.count); ++i) {
        mean += place.weights[i] * scene.mats[at(place.mats[i])].position;
      }
      return mean;
    }
  }
  return scene.mats[at(mat)].position;
}

/// Vector from b to a at the start, in the section that a link acts in; only x if that is scalar.
Eigen::Vector3d lineOf(const scene::Scene& scene, const scene::Lia& lia) {
  const scene::Section& a = scene.sectionOf(scene.mats[at(lia.a)]);
  const scene::Section& b = scene.sectionOf(scene.mats[at(lia.b)]);
  const scene::Section& frame = b.geometry < a.geometry ? b : a;
  const auto seen = [&](int mat, const scene::Section& section) -> Eigen::Vector3d {
    const Eigen::Vector3d place = startOf(scene, mat);
    return a.geometry == Geometry::kScalar && b.geometry == Geometry::kScalar
               ? place
               : frame.pose.inverse() * (section.pose * place);
  };
  Eigen::Vector3d line = seen(lia.a, a) - seen(lia.b, b);
  line.tail(3 - scene::dimensionsOf(frame.geometry)).setZero();
  return line;
}

bool isScalar(const scene::Scene& scene, const scene::Lia& lia) {
  return scene.sectionOf(scene.mats[at(lia.a)]).geometry == Geometry::kScalar ||
         scene.sectionOf(scene.mats[at(lia.b)]).geometry == Geometry::kScalar;
}

/// How far a link is from where it has no force, m, >= 0.
double elongationAtStart(const scene::Scene& scene, const scene::Lia& lia) {
  const Eigen::Vector3d line = lineOf(scene, lia);
  if (scene::lawOf(lia.type).kind == scene::Law::Kind::kGap) {
    const double reach = scene::largest(scene, lia.law->width);
    return std::max(reach + (isScalar(scene, lia) ? line.x() : -line.norm()), 0.0);
  }
  return std::abs((isScalar(scene, lia) ? line.x() : line.norm()) - lia.rest_length);
}

/// m of the model for a metre of the hands at a link, the largest.
double scaleAt(const scene::Scene& scene, const scene::Lia& lia) {
  double scale = 0.0;
  for (const scene::Port& port : scene.ports) {
    if (port.agent < 0 && (port.mat == lia.a || port.mat == lia.b)) {
      scale = std::max(scale, 1.0 / std::abs(port.position_scale));
    }
  }
  return scale > 0.0 ? scale : 1.0;
}

}  // namespace

scene::Slopes slopesInHand(const scene::Scene& scene, const scene::Lia& lia) {
  if (scene::sticks(lia.type)) {
    return scene::slopesUpTo(0.0, kRigidDamping);
  }
  return scene::slopesAt(scene, lia,
                         elongationAtStart(scene, lia) + scaleAt(scene, lia) * kHandDepth);
}

}  // namespace ergotic::physics
