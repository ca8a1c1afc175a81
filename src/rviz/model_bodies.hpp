// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rviz/model_hands.hpp"
#include "rviz/model_solids.hpp"

namespace ergotic::panel {

constexpr std::size_t kMaxBodies = 600;  ///< above it bodies are points: each vertex has its price

/// How a module by itself is drawn, around its place.
struct DrawnBody {
  std::uint32_t module = 0;
  const Solid* solid = nullptr;
  float radius = 0.0F;                                 ///< m, of 1 of the solid
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();  ///< from the solid to frame `model`
};

/// The bodies of a model, in the order of `shape.bodies`; none if they are so many that they are
/// drawn as points.
/// \param size_m  from corner to corner of what the model fills
/// \pre shape = shapeOf(structure)
std::vector<DrawnBody> bodiesOf(const ModelStructure& structure,
                                const ModelShape& shape,
                                float size_m);

/// Both ends of a body along its longest side, m from the place of its module, frame `model`.
std::array<Eigen::Vector3f, 2> axisOf(const DrawnBody& body);

}  // namespace ergotic::panel
