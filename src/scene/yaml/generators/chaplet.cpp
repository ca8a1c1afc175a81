// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/chaplet.hpp"

#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {

void readChaplet(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(chapletKeys());
  ChapletSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  const Section& section = sectionAt(builder, spec.section);
  if (section.gestural || section.automatic_rate || section.divisor != 1 ||
      section.geometry != Geometry::kScalar) {
    builder.fail(map.has("section") ? map.placeAt("section") : map.place(),
                 map.what() + " is in section " + quoted(section.name) +
                     ", allowed: scalar sections with rate: audio");
  }
  spec.from = builder.mat(map.word("from"), map.placeAt("from"));
  spec.mass = map.value("mass", kMassLimits);
  const Mat& carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];
  const Eigen::Vector3d at = map.has("at") ? readRest(section, map, "at") : carrier.rest;
  spec.at = at.tail<2>();
  addChaplet(builder, spec);
}

}  // namespace ergotic::scene
