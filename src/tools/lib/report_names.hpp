// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "tools/lib/report.hpp"

/// Names of the elements of a scene in reports. Laws define their own names.
namespace ergotic::scene {

NLOHMANN_JSON_SERIALIZE_ENUM(MatType,
                             {{MatType::kMass, "mass"},
                              {MatType::kGround, "ground"},
                              {MatType::kCell, "cell"},
                              {MatType::kDriven, "driven"},
                              {MatType::kSlice, "slice"},
                              {MatType::kPoint, "point"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Quantity,
                             {{Quantity::kPosition, "position"},
                              {Quantity::kVelocity, "velocity"},
                              {Quantity::kForce, "force"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Geometry,
                             {{Geometry::kScalar, "scalar"},
                              {Geometry::kLine, "1D"},
                              {Geometry::kPlane, "2D"},
                              {Geometry::kSpace, "3D"}})

}  // namespace ergotic::scene
