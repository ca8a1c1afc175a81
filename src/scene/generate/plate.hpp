// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "scene/generate/body.hpp"
#include "scene/generate/hard_links.hpp"

namespace ergotic::scene {

enum class PlateEdges { kSupported, kClamped, kFree };

/// A plate: modules `name.<row>.<column>` of a square grid, unless it is free the outermost
/// grounds, and bends `name.bend.0` ... with `name.link.0` ... beside them: what holds a clamped
/// edge, and dampers between neighbours where two decays are asked for. A grid. One that hardens
/// has `name.hard.0` ... along rows and columns.
struct PlateSpec {
  std::string name;
  int section = 0;
  int rows = 3;  ///< with the grounds
  int columns = 3;
  PlateEdges edges = PlateEdges::kFree;
  double poisson = 0.3;                          ///< Poisson's ratio, for free edges
  double mass = 1.0;                             ///< mass of the whole, kg
  double spacing = 0.01;                         ///< m
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of the first module, m
  BodyWish wish;
  Hardening hardening = Hardening::kNone;
  double thickness = 1e-3;  ///< m: how far it must be drawn to be twice as stiff, about
  Place place;
};

/// Appends the plate. \throws TextError if a name is taken, or as `finishBody`
void addPlate(SceneBuilder& builder, const PlateSpec& spec);

}  // namespace ergotic::scene
