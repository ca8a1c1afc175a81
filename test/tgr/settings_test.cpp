// SPDX-License-Identifier: BSD-3-Clause

#include "tgr/settings.hpp"

#include <yaml-cpp/yaml.h>

#include "scene/text/number.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"
#include "tgr/scripted_driver.hpp"

namespace ergotic::tgr {
namespace {

Settings settingsOf(const std::string& text) {
  return Settings(parseSettings(text, "s.yaml"), "s.yaml", "it");
}

TEST(SettingsTest, TakesNothingForAnEmptyMap) {
  for (const char* text : {"", "# only a comment\n", "{}", "~"}) {
    EXPECT_NO_THROW(settingsOf(text).top().allow({})) << text;
  }
}

TEST(SettingsTest, SaysWhatIsNotAMapOrNotYaml) {
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf("\n [1, 2]"); }),
            "s.yaml:2:2: error: it is a list of 2, allowed: a map");
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf("a: 1\nb: ["); }).substr(0, 32),
            "s.yaml:2:1: error: not valid YAM");
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf(std::string("a: 1\n\0", 6)); }).substr(0, 11),
            "s.yaml:2:1:");
}

TEST(SettingsTest, AreOneDocumentAndNothingBehindIt) {
  EXPECT_NO_THROW(settingsOf("---\na: 1\n...\n"));
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf("a: 1\n---\nb: 2\n"); }),
            "s.yaml:2:1: error: a second document, allowed: one");
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf("{a: 1}\n,"); }),
            "s.yaml:2:1: error: a second document, allowed: one");
  EXPECT_EQ(complaintOf<TextError>([] { settingsOf(" ,"); }),
            "s.yaml:1:2: error: a second document, allowed: one");
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
  EXPECT_EQ(complaintOf<TextError>([&] { part.top().allow({"list"}); }).substr(0, 18),
            "s.yaml:4:9: error:");
  EXPECT_EQ(complaintOf<TextError>([&] { part.top().word("list"); }).substr(0, 19),
            "s.yaml:5:15: error:");
  EXPECT_EQ(complaintOf<TextError>([&] { part.top().word("other"); }).substr(0, 18),
            "s.yaml:4:9: error:");
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

/// Some lines of aliases of aliases stand for more than any memory.
TEST(SettingsTest, RefuseAliases) {
  EXPECT_EQ(complaintOf<TextError>([] { parseSettings("a: &a [x]\nb: [*a, *a]\n", "s.yaml"); }),
            "s.yaml:2:5: error: an alias, allowed: what it stands for, written out");
}

TEST(SettingsTest, WritesNumbersThatReadBackTheSame) {
  EXPECT_EQ(scene::shortest(0.1), "0.1");
  EXPECT_EQ(std::stod(scene::shortest(1.0 / 3.0)), 1.0 / 3.0);
  EXPECT_EQ(scene::shortest(-2.0), "-2");
}

std::string complaint(const std::string& text) {
  return complaintOf([&] { readVirtualSettings(YAML::Load(text), "v.yaml"); });
}

TEST(VirtualSettingsTest, KeepTheDefaultsOfWhatIsNotSaid) {
  const VirtualDriverConfig config = readVirtualSettings(YAML::Load("{}"), "v.yaml");
  EXPECT_EQ(config.slices, 12);
  EXPECT_EQ(config.slice.bandwidth, 15000.0);
  EXPECT_EQ(config.slice.delay, 0.0);
  EXPECT_FALSE(config.slice.volts);
  EXPECT_TRUE(config.others.empty());
  EXPECT_TRUE(config.gesture_file.empty());
}

TEST(VirtualSettingsTest, TakeEveryNumber) {
  const VirtualDriverConfig config = readVirtualSettings(
      YAML::Load(
          "slices: 5\nseed: 9\ngesture: hands/wave.csv\ngesture_rate: 3150\nextra_delay_ticks: 2\n"
          "mechanics: {mass: 0.5, damping: 1, dry_friction: 0.2, stop: 0.02, quantum: 2e-6,\n"
          "  noise_rms: 3e-6, force_limit: 100, bandwidth: 5000, delay: 0.001, hand_mass: 0.2,\n"
          "  hand_stiffness: 300, hand_damping: 4}\n"
          "volts: {metres_per_volt: 0.005, volts_per_newton: 0.04}\n"
          "others:\n  3: {mass: 0.7, volts: {metres_per_volt: -0.01, volts_per_newton: 0.04}}\n"),
      "/etc/tgr/v.yaml");
  EXPECT_EQ(config.slices, 5);
  EXPECT_EQ(config.seed, 9U);
  EXPECT_EQ(config.gesture_file, "/etc/tgr/hands/wave.csv") << "beside the file";
  EXPECT_EQ(config.gesture_rate, 3150.0);
  EXPECT_EQ(config.extra_delay_ticks, 2);
  const VirtualSliceConfig& slice = config.slice;
  EXPECT_EQ(slice.mass, 0.5);
  EXPECT_EQ(slice.damping, 1.0);
  EXPECT_EQ(slice.dry_friction, 0.2);
  EXPECT_EQ(slice.stop, 0.02);
  EXPECT_EQ(slice.quantum, 2e-6);
  EXPECT_EQ(slice.noise_rms, 3e-6);
  EXPECT_EQ(slice.force_limit, 100.0);
  EXPECT_EQ(slice.bandwidth, 5000.0);
  EXPECT_EQ(slice.delay, 0.001);
  EXPECT_EQ(slice.hand_mass, 0.2);
  EXPECT_EQ(slice.hand_stiffness, 300.0);
  EXPECT_EQ(slice.hand_damping, 4.0);
  EXPECT_EQ(slice.volts->metres_per_volt, 0.005);
  ASSERT_EQ(config.others.size(), 1U);
  const VirtualSliceConfig& other = config.others.at(3);
  EXPECT_EQ(other.mass, 0.7);
  EXPECT_EQ(other.stop, 0.02) << "as all slices";
  EXPECT_EQ(other.volts->metres_per_volt, -0.01);
}

TEST(VirtualSettingsTest, LeaveTheMechanicsToADeviceProcess) {
  const auto config =
      readVirtualSettings(YAML::Load("{shared_memory: tgr, slices: 3, is_raw: true}"), "");
  EXPECT_EQ(config.shared_memory, "tgr");
  EXPECT_EQ(config.slices, 3);
  EXPECT_TRUE(config.is_raw);
  EXPECT_EQ(complaint("shared_memory: tgr\nmechanics: {mass: 1}").substr(0, 51),
            "v.yaml:2:1: error: unknown key 'mechanics' of drive");
}

TEST(VirtualSettingsTest, SayWhereTheyAreWrong) {
  EXPECT_EQ(complaint("mechanics: {mass: 0}"),
            "v.yaml:1:19: error: 'mass' of 'mechanics' of driver virtual = 0 kg is out of range, "
            "allowed: 0.001...100 kg");
  EXPECT_EQ(complaint("mechanics: {bandwidth: 5}"),
            "v.yaml:1:24: error: 'bandwidth' of 'mechanics' of driver virtual = 5 Hz is out of "
            "range, allowed: >= 10 Hz");
  EXPECT_EQ(complaint("mechanics: {delay: 0.1}"),
            "v.yaml:1:20: error: 'delay' of 'mechanics' of driver virtual = 0.1 s is out of range, "
            "allowed: 0...0.005 s");
  EXPECT_EQ(complaint("slices: 65").substr(0, 19), "v.yaml:1:9: error: ");
  EXPECT_EQ(complaint("slices: 3\nothers: {3: {mass: 1}}"),
            "v.yaml:2:10: error: slice '3' of 'others', allowed: 0...2");
  EXPECT_EQ(complaint("others: {1.5: {mass: 1}}"),
            "v.yaml:1:10: error: slice '1.5' of 'others', allowed: 0...11");
  EXPECT_EQ(complaint("volts: {metres_per_volt: 0.005}").substr(0, 60),
            "v.yaml:1:8: error: 'volts' of driver virtual lacks a number,");
  EXPECT_EQ(complaint("mass: 1").substr(0, 46), "v.yaml:1:1: error: unknown key 'mass' of drive");
  EXPECT_EQ(complaint("seed: -1").substr(0, 18), "v.yaml:1:7: error:");
  EXPECT_EQ(complaint("extra_delay_ticks: 17").substr(0, 20), "v.yaml:1:20: error: ");
}

}  // namespace
}  // namespace ergotic::tgr
