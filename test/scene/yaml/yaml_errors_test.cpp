// SPDX-License-Identifier: BSD-3-Clause
#include "scene/bad_text.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define HEAD "ergotic: 1\nsections: {a: {}}\n"
#define TWO_MASSES HEAD "mats: {m: {type: mass, mass: 1}, n: {type: mass, mass: 1}}\n"

TEST(YamlErrorsTest, BytesThatNoTextHasAreRefusedAtTheirPlace) {
  expectRefused({HEAD "name: caf<!>\xE9\n", "byte 0xE9 is not UTF-8"}, "bad.yaml");
  expectRefused({HEAD "name: a<!>\x04z\n", "control character 0x04"}, "bad.yaml");
}

TEST(YamlErrorsTest, NulByteIsRefusedAtItsPlace) {
  const std::string text = std::string("ergotic: 1\nname: a") + '\0' + "b\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "nul.yaml"); }),
              "nul.yaml:2:8: error: control character 0x00 in a text, allowed: tab and line "
              "ends only");
}

TEST(YamlErrorsTest, DeepNestingIsAnErrorNotACrash) {
  for (const char* unit : {"[", "{a: ", "- ", "? "}) {
    std::string text = "ergotic: 1\nname: \n  ";
    for (int i = 0; i < 100000; ++i) {
      text += unit;
    }
    EXPECT_THROW(readYaml(text, "deep.yaml"), TextError) << unit;
  }
}

TEST(YamlErrorsTest, TooLongATextIsRefusedUnread) {
  const std::string text((std::size_t{64} << 20U) + 1, '#');
  EXPECT_THROW(readYaml(text, "long.yaml"), TextError);
}

TEST(YamlErrorsTest, TablesSharedByAliasesAreLimitedInAll) {
  std::string text = TWO_MASSES "lias:\n  l: {type: bow, between: [m, n], table: &t [";
  for (int i = 0; i < 4096; ++i) {
    text += "[" + std::to_string(i) + ", 0],";
  }
  text += "]}\n";
  for (int i = 0; i < 256; ++i) {
    text += "  l" + std::to_string(i) + ": {type: bow, between: [m, n], table: *t}\n";
  }
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "tables.yaml"); }),
              AllOf(StartsWith("tables.yaml:261:"), HasSubstr("more than 1048576 points")));
}

TEST(YamlErrorsTest, PointsOfAgentsSharedByAliasesAreLimitedInAll) {
  std::string text =
      "ergotic: 1\nsections: {h: {rate: gestural}}\nmats: {m: {type: mass, mass: 1}}\n"
      "agents:\n  a: {mat: m, stiffness: 1, points: &p [";
  for (int i = 0; i < 65536; ++i) {
    text += "[" + std::to_string(i) + ", 0],";
  }
  text += "]}\n";
  for (int i = 0; i < 17; ++i) {
    text += "  a" + std::to_string(i) + ": {mat: m, stiffness: 1, points: *p}\n";
  }
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "agents.yaml"); }),
              AllOf(StartsWith("agents.yaml:21:"), HasSubstr("more than 1048576 points")));
}

TEST(YamlErrorsTest, EveryTruncationOfASceneIsReadOrRefusedWithItsPlace) {
  const std::string whole = TWO_MASSES
      "lias:\n  l: {type: spring, between: [m, n], stiffness: 1}\n"
      "outputs:\n  o: {at: m, quantity: force, channel: 1}\n";
  int refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      readYaml(whole.substr(0, size), "cut.yaml");
    } catch (const TextError& e) {
      ++refused;
      EXPECT_GE(e.line(), 1);
      EXPECT_GE(e.column(), 1);
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size()) / 2);
}

}  // namespace
}  // namespace ergotic::scene
