// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/origin.hpp"

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {
namespace {

const Origin* originOf(const Scene& scene, Place place) {
  return place.origin > 0 ? &scene.origins[static_cast<std::size_t>(place.origin) - 1] : nullptr;
}

}  // namespace

const std::string& fileOf(const Scene& scene, Place place) {
  const Origin* const origin = originOf(scene, place);
  return origin == nullptr ? scene.file : origin->file;
}

std::string textOf(const Scene& scene, Place place) {
  return fileOf(scene, place) + ":" + std::to_string(place.line) + ":" +
         std::to_string(place.column);
}

std::string chainOf(const Scene& scene, Place place) {
  const Origin* const origin = originOf(scene, place);
  return origin == nullptr ? "" : origin->chain;
}

TextError errorAt(const Scene& scene, Place place, const std::string& what) {
  return {fileOf(scene, place), place.line, place.column, what + chainOf(scene, place)};
}

}  // namespace ergotic::scene
