// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "scene/generate/modal_body.hpp"
#include "scene/generate/plate.hpp"

namespace ergotic::scene {

/// A thin round plate, as its modes. Places are fractions of the square around it.
struct RoundPlateSpec {
  std::string name;
  int section = 0;
  PlateEdges edges = PlateEdges::kFree;
  double poisson = 0.3;
  double mass = 1.0;                             ///< of the whole, kg
  double radius = 0.15;                          ///< of the picture, m
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of its middle, m
  BodyWish wish;
  BodyForm form;
  Place place;
};

/// A vibration of a round plate of radius 1: scale (J_n(k r) + of_i I_n(k r)/I_n(k)) times the
/// cosine or sine of n phi.
struct RoundMode {
  int diameters = 0;  ///< n
  bool is_sine = false;
  double k = 0.0;  ///< its frequency goes as k^2
  double of_i = 0.0;
  double scale = 1.0;  ///< for a mean square of 1 over the plate

  double shapeAt(double r, double phi) const;
};

/// The lowest vibrations of a plate of thin-plate theory, exactly; motions as a whole are left out.
/// Source: Leissa, Vibration of Plates, NASA SP-160, 1969, ch. 2.
/// \param poisson  0...0.5; of clamped edges without influence
std::vector<RoundMode> roundModes(PlateEdges edges, double poisson, int count);

/// Appends the plate. \throws TextError if a name is taken, or a place lies beyond its rim
void addRoundPlate(SceneBuilder& builder, const RoundPlateSpec& spec);

}  // namespace ergotic::scene
