// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/mesh.hpp"

#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr double kIsotropic = 0.25;  // of the stiffness: waves travel alike in all directions

}  // namespace

void readMesh(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(meshKeys());
  MeshSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  if (map.has("edges")) {
    spec.edges = static_cast<MeshEdges>(map.choice("edges", {"fixed", "free", "corners"}));
  }
  const Limits sides{"", spec.edges == MeshEdges::kFixed ? 3.0 : 2.0, kMaxMats / 2};
  spec.rows = map.integer("rows", sides);
  spec.columns = map.integer("columns", sides);
  spec.spacing = map.number("spacing", kSpacingLimits);
  spec.at = readRest(sectionAt(builder, spec.section), map, "at");
  spec.mass = map.value("mass", kMassLimits);
  spec.stiffness = map.value("stiffness", kStiffnessLimits);
  spec.damping = map.value("damping", kDampingLimits, {});
  spec.rest_length_ratio = readRestLengthRatio(builder, map, spec.section);
  spec.scheme = readScheme(builder, map, sectionAt(builder, spec.section), spec.damping,
                           spec.rest_length_ratio);
  if (map.has("neighbours") && map.choice("neighbours", {"4", "8"}) == 1) {
    spec.diagonal_stiffness =
        map.value("diagonal_stiffness", kStiffnessLimits, kIsotropic * spec.stiffness);
  } else if (map.has("diagonal_stiffness")) {
    builder.fail(map.keyPlaceAt("diagonal_stiffness"), "'diagonal_stiffness' of " + map.what() +
                                                           " without diagonals, allowed with "
                                                           "neighbours: 8");
  }
  addMesh(builder, spec);
}

}  // namespace ergotic::scene
