// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

/// All generators, a row each.
struct Generator {
  const char* type;
  void (*read)(SceneBuilder& builder, const std::string& name, const YamlMap& map);
};
constexpr Generator kGenerators[] = {
    {"string", readString},     {"mesh", readMesh},   {"bar", readBar},
    {"membrane", readMembrane}, {"plate", readPlate}, {"resonator", readResonator},
    {"chaplet", readChaplet},
};

}  // namespace

void readGenerators(SceneBuilder& builder, const YamlMap& top) {
  if (!top.has("generators")) {
    return;
  }
  const Node& list = top.at("generators");
  if (!list.isList()) {
    top.fail("generators", "'generators' is not a list, allowed: a list of maps");
  }
  std::vector<std::string> kinds;
  for (const Generator& generator : kGenerators) {
    kinds.emplace_back(generator.type);
  }
  for (const Node& node : list) {
    const YamlMap map(builder, node, "generator", placeOf(node, top.placeAt("generators")));
    const std::size_t type = map.choice("type", kinds);
    const std::string name = map.word("name");
    checkName(builder, name, map.placeAt("name"));
    kGenerators[type].read(builder, name, map);
  }
}

}  // namespace ergotic::scene
