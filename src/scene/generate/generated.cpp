// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/generated.hpp"

#include <utility>

namespace ergotic::scene {

Mat generatedMat(
    const SceneBuilder& builder, int section, Name name, const Eigen::Vector3d& rest, Place place) {
  Mat mat;
  mat.name = std::move(name);
  mat.section = section;
  mat.rest = rest;
  const int moving = dimensionsOf(builder.scene().sectionOf(mat).geometry);
  mat.position.head(moving) = rest.head(moving);
  mat.place = place;
  return mat;
}

Name linkStem(const std::string& generator) {
  return generator + ".link.";
}

Lia generatedLink(const Name& stem, int index, int a, int b, Place place) {
  Lia lia;
  lia.name = stem.numbered(index);
  lia.a = a;
  lia.b = b;
  lia.place = place;
  return lia;
}

}  // namespace ergotic::scene
