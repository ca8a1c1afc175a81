// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/settling/steps.hpp"
#include "support/documents.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> warningsOf(const std::string& yaml) {
  return settle(scene::readYaml(yaml, "play.yaml"), {44100.0, 14}).scene.warnings;
}

/// A string and a plectrum of 6 mm.
std::string pluckedFrom(const std::string& rest) {
  return "ergotic: 1\nsections: {s: {rate: audio}, k: {rate: gestural}}\ngenerators:\n"
         "  - {type: string, name: s, section: s, masses: 30, pitch: A3, impedance: 0.3, to: [1, "
         "0]}\n"
         "mats: {pick: {type: slice, section: k, rest: " +
         rest +
         "}}\nlias: {pluck: {type: pluck, between: [pick, s@0.2], stiffness: 500, width: 6 mm}}\n"
         "ports: {p: {mat: pick, slice: 0}}\n";
}

TEST(PlayWarningsTest, APluckThatIsHeldAtTheStartIsTold) {
  EXPECT_THAT(warningsOf(pluckedFrom("-4 mm")),
              ElementsAre(testing::AllOf(
                  HasSubstr("play.yaml:6:8: warning: link 'pluck' plucks as soon as"),
                  HasSubstr("4 mm apart"), HasSubstr("width of 6 mm"))));
  EXPECT_THAT(warningsOf(pluckedFrom("5.9 mm")), ElementsAre(HasSubstr("5.9 mm apart")));
  EXPECT_THAT(warningsOf(pluckedFrom("-6 mm")), IsEmpty());
}

TEST(PlayWarningsTest, ASceneThatNothingExcitesIsTold) {
  const std::string still =
      "ergotic: 1\nsections: {a: {rate: audio}}\nmats: {c: {type: cell, section: a, mass: 1, "
      "stiffness: 10";
  EXPECT_THAT(warningsOf(still + "}}\n"), ElementsAre(HasSubstr("nothing can set this scene")));
  EXPECT_THAT(warningsOf(still + ", v: 1}}\n"), IsEmpty());
  EXPECT_THAT(warningsOf(still + ", x: 1 mm}}\n"), IsEmpty());
  EXPECT_THAT(warningsOf(still + "}}\ninputs: {i: {mat: c, quantity: force, channel: 1}}\n"),
              IsEmpty());
}

TEST(PlayWarningsTest, WhatTheDocumentsShowCanBePlayed) {
  int scenes = 0;
  for (const std::string& block : test::yamlIn("docs/scene.md")) {
    if (block.find("ergotic: 1") != std::string::npos) {
      EXPECT_THAT(warningsOf(block), IsEmpty()) << block;
      ++scenes;
    }
  }
  EXPECT_GE(scenes, 2);
}

}  // namespace
}  // namespace ergotic::physics
