// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// What is wrong, and where.
struct Fault {
  Place place;
  std::string text;
};

/// Whether it is a body of the model, and not a tap or another point without mass.
inline bool isModule(const Mat& mat) {
  return mat.type == MatType::kMass || mat.type == MatType::kCell || mat.type == MatType::kGround;
}

}  // namespace ergotic::scene
