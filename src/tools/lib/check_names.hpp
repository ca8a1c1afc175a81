// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

/// What the elements of a scene are called in reports.
namespace ergotic::tools {

const char* nameOf(scene::MatType type);
const char* nameOf(scene::LiaType type);
const char* nameOf(scene::Quantity quantity);
const char* nameOf(scene::Geometry geometry);

}  // namespace ergotic::tools
