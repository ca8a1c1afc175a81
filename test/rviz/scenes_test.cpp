// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/scenes.hpp"

#include <algorithm>

#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::panel {
namespace {

TEST(ScenesTest, TheLeadingCommentDescribesAScene) {
  const auto scenes = scenesOf("/m/drum.yaml", R"(# SPDX-License-Identifier: BSD-3-Clause
# A drum.
#   It is struck.
ergotic: 1
name: big drum
# not this
)");
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_EQ(scenes[0].model, "/m/drum.yaml");
  EXPECT_EQ(scenes[0].name, "big drum");
  EXPECT_EQ(scenes[0].title, "big drum");
  EXPECT_EQ(scenes[0].about, "A drum. It is struck.");
}

TEST(ScenesTest, WhatASceneSaysOfItselfComesFirst) {
  const auto scenes = scenesOf("/m/a.yaml", R"(# A comment.
about: {title: A Harp, description: It has strings.}
ergotic: 1
)");
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_EQ(scenes[0].title, "A Harp");
  EXPECT_EQ(scenes[0].name, "A Harp");
  EXPECT_EQ(scenes[0].about, "It has strings.");
}

TEST(ScenesTest, VariantsCanBeChosen) {
  const auto scenes = scenesOf("/m/a.yaml", R"(# A harp.
name: harp
variants:
  soft: {doc: With felt.}
  hard: {}
)");
  ASSERT_EQ(scenes.size(), 3U);
  EXPECT_EQ(scenes[1].model, "/m/a.yaml#soft");
  EXPECT_EQ(scenes[1].name, "harp");
  EXPECT_EQ(scenes[1].title, "harp: soft");
  EXPECT_EQ(scenes[1].about, "With felt.");
  EXPECT_EQ(scenes[2].about, "A harp.");
}

TEST(ScenesTest, WhatIsNoSceneIsListedByItsFile) {
  for (const char* text : {"", "- 1", "{", "a: [", "name: [1]", "about: 3", "variants: 3", "\t:"}) {
    const auto scenes = scenesOf("/m/odd.yaml", text);
    ASSERT_EQ(scenes.size(), 1U) << text;
    EXPECT_EQ(scenes[0].title, "odd") << text;
  }
}

TEST(ScenesTest, APictureBesideASceneIsThatOfItsVariantsToo) {
  const std::string guitar = test::repository("models/guitar.yaml");
  const auto scenes = scenesOf(guitar, "variants: {soft: {}}");
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[0].picture, test::repository("models/pictures/guitar.png"));
  EXPECT_EQ(scenes[1].picture, scenes[0].picture);
  EXPECT_EQ(scenesOf("/m/guitar.yaml", "")[0].picture, "");
}

TEST(ScenesTest, FindsTheModelsOfTheProgramInOrder) {
  const auto scenes = scenesIn({"/no/such/folder", test::repository("models")});
  ASSERT_GE(scenes.size(), 5U);
  EXPECT_TRUE(std::is_sorted(scenes.begin(), scenes.end(),
                             [](const auto& a, const auto& b) { return a.title < b.title; }));
  for (const SceneEntry& scene : scenes) {
    EXPECT_NE(scene.about, "") << scene.model;
    EXPECT_EQ(scene.about.find("SPDX"), std::string::npos) << scene.model;
    EXPECT_EQ(scene.model.find("/lib/"), std::string::npos) << scene.model;
    EXPECT_EQ(scene.model.find("_truths"), std::string::npos) << scene.model;
    EXPECT_NE(scene.about.find("Notes (key Z is C3, Q is C4; "), std::string::npos) << scene.model;
  }
}

}  // namespace
}  // namespace ergotic::panel
