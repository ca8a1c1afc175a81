// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "scene/scene_builder.hpp"

namespace ergotic::scene {

/// A string between two fixed points: mats `name.0` ... `name.<masses + 1>`, of which the first and
/// the last are grounds, and links `name.link.0` ... `name.link.<masses>`.
struct StringSpec {
  std::string name;
  int section = 0;
  int masses = 1;  ///< moving ones
  Value mass;      ///< of each, kg
  Value stiffness;
  Value damping;                         ///< of each link
  std::optional<Value> loss;             ///< of each mass to the ground
  Eigen::Vector2d from{0.0, 0.0};        ///< y, z of the first ground, m
  Eigen::Vector2d to{0.0, 0.0};          ///< y, z of the last ground, m
  std::optional<Eigen::Vector2d> pluck;  ///< where (0...1) and how high (m) it is held at start
  Place place;
};

/// Stiffness of the links with which the undamped string of `masses` moving masses `mass` has its
/// fundamental at `frequency_hz`, in continuous time: K = M (pi f / sin(pi / (2 (N+1))))^2.
Value stringStiffness(int masses, const Value& mass, double frequency_hz);

/// Appends the string, its modules and links. \throws TextError if a name is taken
void addString(SceneBuilder& builder, const StringSpec& spec);

/// The low-pass chaplet C2: two masses `name.0`, `name.1` and two links `name.link.0`,
/// `name.link.1` hung onto a module that moves at the gestural rate. The last mass is what touches
/// the structure.
struct ChapletSpec {
  std::string name;
  int from = 0;  ///< index of the module that carries it
  int section = 0;
  Value mass;  ///< of both together, kg
  Eigen::Vector2d at{0.0, 0.0};
  Place place;
};

/// Appends the chaplet, tuned to half the scene's gestural rate. \throws TextError if a name is
/// taken
void addChaplet(SceneBuilder& builder, const ChapletSpec& spec);

}  // namespace ergotic::scene
