// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "scene/generate/bend.hpp"
#include "scene/rules/rules.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

void refuseBend(const YamlMap& map, const std::string& key, const std::string& fault) {
  if (!fault.empty()) {
    map.fail(key, fault);
  }
}

void readBendEnds(const SceneBuilder& builder, const YamlMap& map, Bend& bend) {
  const Node& ends = map.at("between");
  if (!ends.isList()) {
    map.fail("between", "'between' of " + map.what() + " is " + kindOf(ends) +
                            ", allowed: a list of 3...5 modules");
  }
  for (const Node& end : ends) {
    const Place place = placeOf(end, map.placeAt("between"));
    const std::string name = wordOf(builder, end, "an end of " + map.what(), place);
    bend.ends.push_back({builder.mat(name, place), 0.0});
  }
  refuseBend(map, "between", endsFault(builder.scene(), bend));
}

}  // namespace

void readBend(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(bendKeys());
  Bend bend;
  bend.name = name;
  bend.place = map.place();
  readBendEnds(builder, map, bend);
  const std::vector<double> weights =
      map.numbers("weights", bend.ends.size(), bend.ends.size(), {});
  for (std::size_t i = 0; i < weights.size(); ++i) {
    bend.ends[i].weight = weights[i];
  }
  refuseBend(map, "weights", weightsFault(bend));
  bend.stiffness = map.value("stiffness", kStiffnessLimits);
  bend.damping = map.value("damping", kDampingLimits, {});
  refuseBend(map, "damping", dampingFault(builder.scene(), bend));
  bend.rest_length = map.number("rest_length", kMetreLimits, 0.0);
  refuseBend(map, "rest_length", restFault(builder.scene(), bend));
  addBend(builder, std::move(bend));
}

}  // namespace ergotic::scene
