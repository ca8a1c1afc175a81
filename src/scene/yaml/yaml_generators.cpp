// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"
#include "scene/yaml/yaml_tables.hpp"

namespace ergotic::scene {
namespace {

KeyNames joined(KeyNames keys, const KeyNames& others) {
  for (const std::string& key : others) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      keys.push_back(key);
    }
  }
  return keys;
}

/// Readers of data beside the scene that generators may use.
struct Beside {
  YamlTables& tables;
  PointFiles& files;
};

using GeneratorReader = void (*)(SceneBuilder& builder,
                                 const std::string& name,
                                 const YamlMap& map,
                                 Beside& beside);

/// Reads a generator that needs nothing else.
template <void (*read)(SceneBuilder& builder, const std::string& name, const YamlMap& map)>
void alone(SceneBuilder& builder, const std::string& name, const YamlMap& map, Beside& /*beside*/) {
  read(builder, name, map);
}

void withTables(SceneBuilder& builder,
                const std::string& name,
                const YamlMap& map,
                Beside& beside) {
  readBarrier(builder, name, map, beside.tables);
}

void withFiles(SceneBuilder& builder, const std::string& name, const YamlMap& map, Beside& beside) {
  readResonator(builder, name, map, beside.files);
}

/// One generator, a row of the list of all.
struct Generator {
  const char* type;
  GeneratorReader read;
  KeyNames (*keys)();                ///< keys for the schema
  bool is_late = false;              ///< read when all bodies are there, those of instances, too
  GeneratorReader finish = nullptr;  ///< reads the rest of it then
};
constexpr Generator kGenerators[] = {
    {"string", alone<readString>, [] { return joined(limpStringKeys(), tunedStringKeys()); }, false,
     alone<readEnds>},
    {"mesh", alone<readMesh>, [] { return meshKeys(); }},
    {"bar", alone<readBar>, barKeys},
    {"membrane", alone<readMembrane>, membraneKeys},
    {"plate", alone<readPlate>, [] { return joined(plateKeys(), roundPlateKeys()); }},
    {"resonator", withFiles, [] { return resonatorKeys(); }},
    {"chaplet", alone<readChaplet>, [] { return chapletKeys(); }},
    {"frets", alone<readFrets>, [] { return fretsKeys(); }, true},
    {"barrier", withTables, [] { return barrierKeys(); }, true},
    {"bridge", alone<readBridge>, [] { return bridgeKeys(); }, true},
};

}  // namespace

KeysOfTypes keysOfGenerators() {
  KeysOfTypes all;
  for (const Generator& generator : kGenerators) {
    all.emplace_back(generator.type, generator.keys());
  }
  return all;
}

void readGenerators(SceneBuilder& builder,
                    const YamlMap& top,
                    YamlTables& tables,
                    PointFiles& files) {
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
  Beside beside{tables, files};
  for (const bool is_late : {false, true}) {
    for (const Node& node : list) {
      const YamlMap map(builder, node, "generator", placeOf(node, top.placeAt("generators")));
      const Generator& generator = kGenerators[map.choice("type", kinds)];
      const std::string name = map.word("name");
      if (generator.is_late == is_late) {
        checkName(builder, name, map.placeAt("name"));
        generator.read(builder, name, map, beside);
      } else if (is_late && generator.finish != nullptr) {
        generator.finish(builder, name, map, beside);
      }
    }
  }
}

}  // namespace ergotic::scene
