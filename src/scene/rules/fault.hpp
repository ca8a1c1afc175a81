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

}  // namespace ergotic::scene
