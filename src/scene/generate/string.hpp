// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/body.hpp"

namespace ergotic::scene {

/// A string between two fixed points: mats `name.0` ... `name.<masses + 1>`, of which the first and
/// the last are grounds, and links `name.link.0` ... `name.link.<masses>`; those of a coarse string
/// in the order of ergotic/scene/coarse_string.hpp. It is a grid of one row.
struct StringSpec {
  std::string name;
  int section = 0;
  int masses = 1;  ///< moving ones
  Value mass;      ///< of each, kg
  Value stiffness;
  Value damping;              ///< of each link
  std::optional<Value> loss;  ///< of each mass to the ground
  double frequency_hz = 0.0;  ///< > 0: tuned to it when settled; the stiffness is a first guess
  bool coarse = false;        ///< also links to the second and third neighbours, 0 until settled
  double rest_length_ratio = 0.0;     ///< rest length of a link / its length at rest; not scalar
  Scheme scheme = Scheme::kExplicit;  ///< of links with a rest length
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< rest of the first ground, m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< rest of the last ground, m
  /// Position (0...1) and height (m) at which it is held at the start: along x, in a plane or in
  /// space along y.
  std::optional<Eigen::Vector2d> pluck;
  /// A body of a pitch, decay and inharmonicity, the stiffness and damping of which do not count; a
  /// scalar one. Its bends, around each mass, are `name.bend.0` ...
  std::optional<BodyWish> wish;
  Place place;
};

/// Stiffness of the links with which the undamped string of `masses` moving masses `mass` has its
/// fundamental at `frequency_hz`, in continuous time: K = M (pi f / sin(pi / (2 (N+1))))^2.
Value stringStiffness(int masses, const Value& mass, double frequency_hz);

/// Appends the string, its modules and links.
/// \throws TextError if a name is taken, or as `finishBody`
void addString(SceneBuilder& builder, const StringSpec& spec);

}  // namespace ergotic::scene
