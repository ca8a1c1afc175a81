// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// YAML that reads back as the same: parts of a scene in blocks, each element on a line of its own.
std::string emit(const Node& scene);

}  // namespace ergotic::scene
