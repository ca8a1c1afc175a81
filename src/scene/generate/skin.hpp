// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/body.hpp"
#include "scene/generate/hard_links.hpp"

namespace ergotic::scene {

/// How much heavier a skin is from place to place; r is the distance from its middle, 1 at the rim.
struct SkinLoad {
  double ratio = 1.0;  ///< load in the middle over that at the rim
  /// Within this r, a patch whose edge is as wide as one cell; none: ratio falls towards the rim as
  /// 1 + (ratio - 1) (1 - r^2)^power, as air does beside a kettledrum.
  std::optional<double> radius;
  double power = 1.0;
  /// \param cells  of the radius
  double at(double r, double cells) const;
};

/// A membrane: `rows` x `columns` modules `name.<row>.<column>` of a square grid, the outermost
/// grounds, and links `name.link.0` ... to the next ones and the diagonals, which have a quarter of
/// the stiffness: so waves travel alike in all directions. Of a round one what lies outside the
/// circle is ground, too, and a link that crosses the rim ends there: K over the part of it that is
/// inside, half of it at least. A grid. One that hardens has `name.hard.0` ... beside these links.
struct MembraneSpec {
  std::string name;
  int section = 0;
  int rows = 3;
  int columns = 3;
  bool is_round = false;  ///< rows = columns, odd
  bool has_diagonals = true;
  double mass = 1.0;  ///< of the whole without its load, kg
  SkinLoad load;
  double spacing = 0.01;                         ///< m
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of the first module, m
  BodyWish wish;
  Hardening hardening = Hardening::kNone;
  double strain = 1e-3;  ///< strain by its tension
  Place place;
};

/// Appends the membrane. \throws TextError if a name is taken, or as `finishBody`
void addMembrane(SceneBuilder& builder, const MembraneSpec& spec);

}  // namespace ergotic::scene
