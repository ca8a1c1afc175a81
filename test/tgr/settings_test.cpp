// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include <string>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"

namespace ergotic::tgr {
namespace {

template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const TextError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SettingsTest, TakesNothingForAnEmptyMap) {
  for (const char* text : {"", "# only a comment\n", "{}", "~"}) {
    EXPECT_NO_THROW(Settings(text, "s.yaml", "it").top().allow({})) << text;
  }
}

TEST(SettingsTest, SaysWhatIsNotAMapOrNotYaml) {
  EXPECT_EQ(errorOf([] { Settings("\n [1, 2]", "s.yaml", "it"); }),
            "s.yaml:2:2: error: it is a list of 2, allowed: a map");
  EXPECT_EQ(errorOf([] { Settings("a: 1\nb: [", "s.yaml", "it"); }).substr(0, 32),
            "s.yaml:2:1: error: not valid YAM");
  EXPECT_EQ(errorOf([] { Settings(std::string("a: 1\n\0", 6), "s.yaml", "it"); }).substr(0, 11),
            "s.yaml:2:1:");
}

/// Places at which a wrong word is found, in a text and in what is left of a part of it.
TEST(SettingsTest, KeepsPlacesInAPartOfAText) {
  const std::string text =
      "top:\n"
      "  - name: 'a \"b\"'   # a comment: {\n"
      "    settings:\n"
      "        wrong: 1\n"
      "        list:\n"
      "          - mass:   7\n"
      "            stop: 3\n"
      "          -\n"
      "          - {x: 1,   y: \"z: 2\", n: ~}\n"
      "  - settings: {wrong: 2}\n";
  const Settings whole(text, "s.yaml", "it");
  const YAML::Node& devices = whole.top().at("top");
  const std::string part = textInPlace(whole.builder(), devices[0]["settings"]);
  EXPECT_EQ(part,
            "{\n\n\n        wrong: 1, \n        list: [{\n            mass:   7, \n"
            "            stop: 3}, ~, \n\n            {x: 1,   y: \"z: 2\", n: ~}]}");
  const Settings settings(part, "s.yaml", "it");
  EXPECT_EQ(settings.top().placeAt("wrong").line, 4);
  EXPECT_EQ(settings.top().placeAt("wrong").column, 16);
  const YAML::Mark stop = settings.top().at("list")[0]["stop"].Mark();
  EXPECT_EQ(stop.line + 1, 7);
  EXPECT_EQ(stop.column + 1, 19);
  EXPECT_TRUE(settings.top().at("list")[1].IsNull());
  EXPECT_EQ(settings.top().at("list")[2]["y"].Scalar(), "z: 2");
  EXPECT_EQ(textInPlace(whole.builder(), devices[1]["settings"]),
            std::string(9, '\n') + "              {wrong: 2}");
}

TEST(SettingsTest, WritesAPartOnOneLine) {
  const Settings whole("a:\n  - b: 'x\\y'\n    c: |\n      two\n      lines\n", "s.yaml", "it");
  const std::string line = textInLine(whole.builder(), whole.top().at("a"));
  EXPECT_EQ(line, R"([{b: "x\\y", c: "two\nlines\n"}])");
  EXPECT_EQ(YAML::Load(line)[0]["c"].Scalar(), "two\nlines\n");
}

TEST(SettingsTest, RefusesAliasesThatGrowWithoutEnd) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int n = 1; n < 10; ++n) {
      text += ", " + last;
    }
    text += "]\n";
  }
  const Settings whole(text, "s.yaml", "it");
  EXPECT_EQ(errorOf([&] { textInPlace(whole.builder(), whole.top().at("a8")); }),
            "s.yaml:1:28: error: too long with its aliases, allowed: 1 MB");
}

TEST(SettingsTest, WritesNumbersThatReadBackTheSame) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(std::stod(shortest(1.0 / 3.0)), 1.0 / 3.0);
  EXPECT_EQ(shortest(-2.0), "-2");
}

}  // namespace
}  // namespace ergotic::tgr
