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

Settings settingsOf(const std::string& text) {
  return Settings(parseSettings(text, "s.yaml"), "s.yaml", "it");
}

TEST(SettingsTest, TakesNothingForAnEmptyMap) {
  for (const char* text : {"", "# only a comment\n", "{}", "~"}) {
    EXPECT_NO_THROW(settingsOf(text).top().allow({})) << text;
  }
}

TEST(SettingsTest, SaysWhatIsNotAMapOrNotYaml) {
  EXPECT_EQ(errorOf([] { settingsOf("\n [1, 2]"); }),
            "s.yaml:2:2: error: it is a list of 2, allowed: a map");
  EXPECT_EQ(errorOf([] { settingsOf("a: 1\nb: ["); }).substr(0, 32),
            "s.yaml:2:1: error: not valid YAM");
  EXPECT_EQ(errorOf([] { settingsOf(std::string("a: 1\n\0", 6)); }).substr(0, 11), "s.yaml:2:1:");
}

TEST(SettingsTest, KnowsThePlacesOfAPartOfAText) {
  const YAML::Node whole = parseSettings(
      "top:\n"
      "  - name: 'a \"b\"'   # a comment: {\n"
      "    settings:\n"
      "        wrong: 1\n"
      "        list: [{mass:   7}]\n",
      "s.yaml");
  const Settings part(whole["top"][0]["settings"], "s.yaml", "it");
  EXPECT_EQ(errorOf([&] { part.top().allow({"list"}); }).substr(0, 18), "s.yaml:4:9: error:");
  EXPECT_EQ(errorOf([&] { part.top().word("list"); }).substr(0, 19), "s.yaml:5:15: error:");
  EXPECT_EQ(errorOf([&] { part.top().word("other"); }).substr(0, 18), "s.yaml:4:9: error:");
}

TEST(SettingsTest, WritesAPartOnOneLine) {
  const YAML::Node whole = parseSettings(
      "a:\n  - b: 'x\\y'\n    c: |\n      two\n      lines\n"
      "    d: {e: ~, f: '~', g: 'true: {', h: 2e-6}\n",
      "s.yaml");
  const std::string line = textInLine(whole["a"]);
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  const YAML::Node again = YAML::Load(line)[0];
  EXPECT_EQ(again["b"].Scalar(), "x\\y");
  EXPECT_EQ(again["c"].Scalar(), "two\nlines\n");
  EXPECT_TRUE(again["d"]["e"].IsNull());
  EXPECT_EQ(again["d"]["f"].Scalar(), "~");
  EXPECT_EQ(again["d"]["g"].Scalar(), "true: {");
  EXPECT_EQ(again["d"]["h"].Scalar(), "2e-6");
}

/// Aliases of aliases are written as such: the text is not longer than the one that was read.
TEST(SettingsTest, WritesAliasesAsAliases) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int n = 1; n < 10; ++n) {
      text += ", " + last;
    }
    text += "]\n";
  }
  EXPECT_LT(textInLine(parseSettings(text, "s.yaml")["a8"]).size(), text.size());
}

TEST(SettingsTest, WritesNumbersThatReadBackTheSame) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(std::stod(shortest(1.0 / 3.0)), 1.0 / 3.0);
  EXPECT_EQ(shortest(-2.0), "-2");
}

}  // namespace
}  // namespace ergotic::tgr
