// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_names.hpp"

#include "scene/laws/law.hpp"

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
  return scene::lawOf(type).name;
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
