// SPDX-License-Identifier: BSD-3-Clause
// Whose hand plays the string or bar that somebody clicks on.
#include "rviz/model_players.hpp"

#include <gmock/gmock.h>

#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ModelPlayersTest, TellsTheBodyOfAModuleByItsName) {
  EXPECT_EQ(bodyOf("string_4.body.25"), "string_4.body");
  EXPECT_EQ(bodyOf("string_4.body@0.83"), "string_4.body");
  EXPECT_EQ(bodyOf("bar_3.body.outline.12"), "bar_3.body");
  EXPECT_EQ(bodyOf("bar_3.body.side"), "bar_3.body");
  EXPECT_EQ(bodyOf("skin.4.11"), "skin");
  EXPECT_EQ(bodyOf("s.0"), "s");
  EXPECT_EQ(bodyOf("hammer"), "hammer");
  EXPECT_EQ(bodyOf(""), "");
}

/// Two strings of 5; a key whose hammer strikes the first, a finger at the second, and between both
/// keys a felt that a third hand lays on a rail.
TEST(ModelPlayersTest, AHandPlaysWhatItsHammerStrikesAndNotWhatOtherHandsDo) {
  StructureMaker maker;
  const auto string = [&maker](const std::string& name, float z) {
    const std::uint32_t first = maker.string(5, z);
    for (std::uint32_t i = 0; i < 5; ++i) {
      maker.structure.module_names[first + i] = name + "." + std::to_string(i);
    }
    return first;
  };
  const std::uint32_t low = string("low", 0.0F);
  const std::uint32_t high = string("high", 0.3F);
  const std::uint32_t key = maker.module(ModelStructure::SLICE, 0, 0.02F, -0.1F, "key");
  const std::uint32_t hammer = maker.module(ModelStructure::MASS, 0, 0.02F, -0.05F, "hammer");
  const std::uint32_t finger = maker.module(ModelStructure::SLICE, 0, 0.02F, 0.35F, "finger");
  const std::uint32_t rail = maker.module(ModelStructure::GROUND, 0, 0.02F, -0.2F, "rail");
  const std::uint32_t idle = maker.module(ModelStructure::SLICE, 0, 0.02F, -0.3F, "idle");
  maker.link(key, hammer);
  maker.link(hammer, low + 2);
  maker.link(key, rail);
  maker.link(idle, rail);
  maker.link(finger, high + 1);
  maker.link(finger, key);
  EXPECT_THAT(playedBy(maker.structure, {key, finger, idle}),
              ElementsAre(ElementsAre("low"), ElementsAre("high"), IsEmpty()));
}

}  // namespace
}  // namespace ergotic::panel
