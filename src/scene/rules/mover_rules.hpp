// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// What is wrong, and where.
struct Fault {
  Place place;
  std::string text;
};

/// One port for a slice, one port for a coordinate of a module, one position input for a driven
/// module.
std::optional<Fault> movedTwice(const Scene& scene);

}  // namespace ergotic::scene
