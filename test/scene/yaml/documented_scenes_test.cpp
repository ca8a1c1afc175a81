// SPDX-License-Identifier: BSD-3-Clause
// All that docs/scene.md shows of YAML, read as a scene: whole ones as they are, pieces within
// another.
#include <yaml-cpp/yaml.h>

#include <regex>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/documents.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

/// Has all that pieces of docs/scene.md refer to.
constexpr const char* kHost = R"(
ergotic: 1
parameters: {place: {value: 0.5, range: [0, 1]}}
sections: {a: {rate: audio}, hand: {rate: gestural}, plate: {rate: audio, geometry: plane}}
mats:
  slider: {type: slice, section: hand}
  thumb: {type: mass, section: hand, mass: 0.1}
  m2: {type: mass, section: plate, mass: 1e-4, at: [0.02, 0]}
  mallet: {type: mass, section: plate, mass: 1e-2, at: [0.15, 0.1]}
  hook: {type: ground, section: plate, at: [0.15, 0.4]}
  head: {type: mass, section: plate, mass: 1e-2, at: [0.12, 0.05]}
generators:
  - {type: string, name: s, section: a, masses: 9, mass: 1e-4, stiffness: 3000, to: [0.65, 0]}
  - {type: mesh, name: plate, section: plate, columns: 8, rows: 8, spacing: 0.1, mass: 1e-4,
     stiffness: 3000}
ports: {slide: {mat: slider, slice: 0}}
)";

/// Entries of `piece` beside those of `host`, map by map.
YAML::Node merged(YAML::Node host, const YAML::Node& piece) {
  for (const auto& entry : piece) {
    const auto key = entry.first.as<std::string>();
    host[key] = host[key] && host[key].IsMap() ? merged(host[key], entry.second) : entry.second;
  }
  return host;
}

Scene read(const std::string& text) {
  return readYaml(text, "docs/scene.md");
}

TEST(DocumentedScenesTest, AreWholeScenesOrPiecesOfOne) {
  int pieces = 0;
  for (const std::string& block : test::yamlIn("docs/scene.md")) {
    if (block.find("ergotic: 1") != std::string::npos) {
      EXPECT_NO_THROW(read(block)) << block;
    } else if (block.find("table: ") != 0) {
      const YAML::Node scene = merged(YAML::Load(kHost), YAML::Load(block));
      EXPECT_NO_THROW(read(YAML::Dump(scene))) << block;
      ++pieces;
    }
  }
  EXPECT_EQ(pieces, 11);
}

TEST(DocumentedScenesTest, ShowEachWayToWriteATable) {
  const test::ScratchFile felt("-1,-2\n0,0\n1,2\n");
  int tables = 0;
  for (const std::string& block : test::yamlIn("docs/scene.md")) {
    std::istringstream lines(block);
    for (std::string line; block.find("table: ") == 0 && std::getline(lines, line); ++tables) {
      YAML::Node scene = YAML::Load(kHost);
      scene["lias"]["l"] = YAML::Load("{type: bow, between: [slider, thumb]}");
      scene["lias"]["l"]["table"] = YAML::Load(line)["table"];
      const std::string text =
          std::regex_replace(YAML::Dump(scene), std::regex("felt.csv"), felt.path().substr(5));
      EXPECT_NO_THROW(readYaml(text, "/tmp/scene.yaml")) << line;
    }
  }
  EXPECT_EQ(tables, 3);
}

}  // namespace
}  // namespace ergotic::scene
