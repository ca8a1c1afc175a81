// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_names.hpp"

namespace ergotic::tools {

const char* nameOf(scene::MatType type) {
  switch (type) {
    case scene::MatType::kMass:
      return "mass";
    case scene::MatType::kGround:
      return "ground";
    case scene::MatType::kCell:
      return "cell";
    case scene::MatType::kDriven:
      return "driven";
    case scene::MatType::kSlice:
      return "slice";
    case scene::MatType::kPoint:
      return "point";
  }
  return "";
}

const char* nameOf(scene::LiaType type) {
  switch (type) {
    case scene::LiaType::kSpringDamper:
      return "spring-damper";
    case scene::LiaType::kContact:
      return "contact";
    case scene::LiaType::kQuadratic:
      return "quadratic spring";
    case scene::LiaType::kCubic:
      return "cubic spring";
    case scene::LiaType::kClippedCubic:
      return "clipped cubic spring";
    case scene::LiaType::kCubicContact:
      return "cubic contact";
    case scene::LiaType::kPluck:
      return "pluck";
    case scene::LiaType::kBow:
      return "bow";
    case scene::LiaType::kSmoothBow:
      return "smooth bow";
    case scene::LiaType::kPowerContact:
      return "power-law contact";
    case scene::LiaType::kTable:
      return "table";
    case scene::LiaType::kConditional:
      return "conditional spring-damper";
  }
  return "";
}

const char* nameOf(scene::Quantity quantity) {
  switch (quantity) {
    case scene::Quantity::kPosition:
      return "position";
    case scene::Quantity::kVelocity:
      return "velocity";
    case scene::Quantity::kForce:
      return "force";
  }
  return "";
}

const char* nameOf(scene::Geometry geometry) {
  switch (geometry) {
    case scene::Geometry::kScalar:
      return "scalar";
    case scene::Geometry::kLine:
      return "1D";
    case scene::Geometry::kPlane:
      return "2D";
    case scene::Geometry::kSpace:
      return "3D";
  }
  return "";
}

}  // namespace ergotic::tools
