// SPDX-License-Identifier: BSD-3-Clause
#include <sys/resource.h>

#include "scene/bad_text.hpp"
#include "support/alloc_count.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define SECTION_HEAD "ergotic: 1\nsections: {a: {}}\n"
#define TWO_MASSES SECTION_HEAD "mats: {m: {type: mass, mass: 1}, n: {type: mass, mass: 1}}\n"

TEST(YamlErrorsTest, BytesThatNoTextHasAreRefusedAtTheirPlace) {
  expectRefused({SECTION_HEAD "name: caf<!>\xE9\n", "byte 0xE9 is not UTF-8"}, "bad.yaml");
  expectRefused({SECTION_HEAD "name: a<!>\x04z\n", "control character 0x04"}, "bad.yaml");
}

TEST(YamlErrorsTest, TextsOfTwoBytesForEachLetterAreCalledSo) {
  using std::string_literals::operator""s;
  for (const std::string& text : {"\xFF\xFE"
                                  "e\0r\0"s,
                                  "\xFE\xFF\0e\0r"s, "e\0r\0g\0"s, "\0e\0r\0g"s}) {
    EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "a.yaml"); }),
                StartsWith("a.yaml:1:1: error: the text is UTF-16"));
  }
}

TEST(YamlErrorsTest, NulByteIsRefusedAtItsPlace) {
  const std::string text = std::string("ergotic: 1\nname: a") + '\0' + "b\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "nul.yaml"); }),
              "nul.yaml:2:8: error: control character 0x00 in a text, allowed: tab and line "
              "ends only");
}

TEST(YamlErrorsTest, ATextThatEndsWithinAnEscapeIsRefusedAtItsEnd) {
  for (const char* const text : {"a: [3,\"b\\<!>", "ergotic: 1\nname: \"b\\<!>"}) {
    expectRefused({text, "not valid YAML"}, "bad.yaml");
  }
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

/// As many nodes as bytes, and each takes half a kB.
TEST(YamlErrorsTest, TooManyNodesAreRefusedBeforeTheyTakeRoom) {
  const auto most_kb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  std::string text = "ergotic: 1\nname: [";
  for (int i = 0; i < 2'000'001; ++i) {
    text += "a,";
  }
  text += "]\n";
  const auto before_kb = most_kb();
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "many.yaml"); }),
              AllOf(StartsWith("many.yaml:2:"), HasSubstr("more than 2000000 scalars")));
  if (test::AllocationScope::isAvailable()) {  // a sanitizer's heap gives nothing back for long
    EXPECT_LT(most_kb() - before_kb, 100'000);
  }
}

TEST(YamlErrorsTest, TitlesThatEveryStatusCarriesAreShort) {
  const std::string most(200, 't');
  EXPECT_EQ(readYaml(SECTION_HEAD "name: " + most + "\n", "title.yaml").name, most);
  expectRefused(
      {(SECTION_HEAD "name: <!>" + most + "t\n").c_str(), "has 201 bytes, allowed: at most 200"},
      "bad.yaml");
}

TEST(YamlErrorsTest, AliasesAreRefused) {
  expectRefused({SECTION_HEAD "mats: {m: &m {type: mass, mass: 1}, n: <!>*m}\n",
                 "an alias, allowed: what it stands for, written out"},
                "bad.yaml");
}

TEST(YamlErrorsTest, TablesThatManyLinksShareAreLimitedInAll) {
  std::string text = TWO_MASSES "lias:\n";
  for (int i = 0; i < 257; ++i) {
    text += "  l" + std::to_string(i) + ": {type: bow, between: [m, n], table: {file: t}}\n";
  }
  text += "---\ntables: {t: [";
  for (int i = 0; i < 4096; ++i) {
    text += "[" + std::to_string(i) + ", 0],";
  }
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text + "]}\n", "tables.yaml"); }),
              AllOf(StartsWith("tables.yaml:261:"), HasSubstr("more than 1048576 points")));
}

TEST(YamlErrorsTest, PointsOfAgentsOfOneFileAreLimitedInAll) {
  std::string points = "time_s,slice,target_m\n";
  for (int i = 0; i < 65536; ++i) {
    points += std::to_string(i) + ",0,0\n";
  }
  const test::ScratchFile file(points);
  std::string text =
      "ergotic: 1\nsections: {h: {rate: gestural}}\nmats: {m: {type: mass, mass: 1}}\nagents:\n";
  for (int i = 0; i < 17; ++i) {
    text += "  a" + std::to_string(i) +
            ": {mat: m, stiffness: 1, gesture: {file: " + file.path().substr(5) + ", slice: 0}}\n";
  }
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "/tmp/agents.yaml"); }),
              AllOf(StartsWith("/tmp/agents.yaml:21:"), HasSubstr("more than 1048576 points")));
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
