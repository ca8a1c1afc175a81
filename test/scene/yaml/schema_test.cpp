// SPDX-License-Identifier: BSD-3-Clause
// What the schema tells editors is what the readers allow, key for key.
#include "ergotic/scene/text/schema.hpp"

#include <yaml-cpp/yaml.h>

#include <set>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

using Keys = std::set<std::string>;

Keys keysIn(const YAML::Node& schema) {
  Keys keys;
  for (const auto& entry : schema["properties"]) {
    keys.insert(entry.first.Scalar());
  }
  return keys;
}

/// Whether a reader knows a key: not by a message that it is unknown.
bool isKnown(const std::string& before, const std::string& key, const std::string& after) {
  const std::string text = "ergotic: 1\nsections: {a: {}, h: {rate: gestural}}\n" + before + key +
                           ": [[]]" + after + "\n";
  const std::string says = complaintOf<TextError>([&] { readYaml(text, "s.yaml"); });
  return says.find("unknown key '" + key + "'") == std::string::npos;
}

/// A kind of element, and where a key of it stands in a scene, in one way or another.
struct Where {
  std::string definition;
  std::vector<std::pair<std::string, std::string>> around;
};

std::vector<Where> elements(const YAML::Node& schema) {
  std::vector<Where> all = {
      {"agent", {{"agents: {one: {", "}}"}}},
      {"port", {{"ports: {one: {", "}}"}}},
      {"input", {{"inputs: {one: {", "}}"}}},
      {"output", {{"outputs: {one: {", "}}"}}},
      {"instance", {{"define: {d: {}}\nuse: [{is: d, as: x, ", "}]"}}},
      {"definition", {{"define: {d: {", "}}"}}},
      {"variant", {{"variants: {one: {", "}}"}}},
      {"parameter", {{"parameters: {p: {", "}}"}}},
  };
  for (const auto& entry : schema["definitions"]) {
    const std::string name = entry.first.Scalar();
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) {
      continue;
    }
    const std::string part = name.substr(0, dot);
    const std::string type = name.substr(dot + 1);
    if (part == "generator") {
      const std::string head = "generators: [{name: one, type: " + type;
      all.push_back({name, {{head + ", ", "}]"}}});
      if (type == "string") {  // of two kinds
        all.back().around.push_back({head + ", pitch: 100, ", "}]"});
      }
      if (type == "plate") {
        all.back().around.push_back({head + ", shape: round, as: modes, ", "}]"});
      }
    } else {
      all.push_back({name, {{part + "s: {one: {type: " + type + ", ", "}}"}}});
    }
  }
  return all;
}

TEST(SchemaTest, HasTheKeysThatReadersKnowAndNoOthers) {
  const YAML::Node schema = YAML::Load(schemaOfScenes());
  Keys universe = {"nonsense"};
  for (const auto& entry : schema["definitions"]) {
    const Keys more = keysIn(entry.second);
    universe.insert(more.begin(), more.end());
  }
  universe.erase("rows");  // makes a table of an element
  const std::vector<Where> all = elements(schema);
  EXPECT_GT(all.size(), 40U);
  for (const Where& where : all) {
    const YAML::Node definition = schema["definitions"][where.definition];
    ASSERT_TRUE(definition) << where.definition;
    EXPECT_FALSE(definition["additionalProperties"].as<bool>()) << where.definition;
    const Keys told = keysIn(definition);
    for (const std::string& key : universe) {
      bool is_known = false;
      for (const auto& [before, after] : where.around) {
        const bool is_there = before.find(" " + key + ":") != std::string::npos ||
                              before.find("{" + key + ":") != std::string::npos;
        is_known = is_known || is_there || isKnown(before, key, after);
      }
      EXPECT_EQ(is_known, told.count(key) == 1) << key << " of " << where.definition;
    }
  }
}

TEST(SchemaTest, HasThePartsOfAScene) {
  const YAML::Node schema = YAML::Load(schemaOfScenes());
  const Keys told = keysIn(schema);
  for (const char* const key :
       {"name", "about", "let", "use", "variants", "speakers", "rows", "nonsense"}) {
    EXPECT_EQ(isKnown("", key, ""), told.count(key) == 1) << key;
  }
  for (const std::string& key : told) {
    if (key != "ergotic" && key != "sections") {
      EXPECT_TRUE(isKnown("", key, "")) << key;
    }
  }
}

}  // namespace
}  // namespace ergotic::scene
