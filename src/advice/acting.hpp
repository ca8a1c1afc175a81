// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Open, of positions or distances; ends may be infinite.
struct Span {
  double from = 0.0;
  double to = 0.0;
};

/// The ends of a link over the position of a hand.
struct Separation {
  bool is_scalar = true;  ///< x counts alone, signed; else the distance
  Eigen::Vector3d apart;  ///< end a less end b with the hand at 0, m
  Eigen::Vector3d way;    ///< change of that per metre of the hand
};

/// Spans in which a link acts, over what is between its ends (signed or as a distance, without its
/// rest length): ascending, apart from each other. Friction acts everywhere, whatever presses it.
std::vector<Span> actingSpans(const scene::Scene& scene, const scene::Lia& lia, bool is_scalar);

/// Positions of the hand for which a link acts, ascending.
std::vector<Span> handSpans(const std::vector<Span>& acting, const Separation& ends);

/// The nearest that its ends come to each other, m. \pre they are not scalar, and something moves
double nearestOf(const Separation& ends);

}  // namespace ergotic::physics
