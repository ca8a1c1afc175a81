// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/exception.hpp"
#include "ergotic/scene/value.hpp"

namespace ergotic::scene {

struct Scene;

/// The file that a place of a scene is in.
const std::string& fileOf(const Scene& scene, Place place);
/// `file:line:col`
std::string textOf(const Scene& scene, Place place);
/// The instances that the place is in, a line each, the innermost first; empty if it is in none.
std::string chainOf(const Scene& scene, Place place);
/// An error at a place, with the instances that the place is in.
TextError errorAt(const Scene& scene, Place place, const std::string& what);

}  // namespace ergotic::scene
