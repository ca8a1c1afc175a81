// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/preset_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ros/interface/file_name.hpp"
#include "ros/interface/variant_file.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

class PresetFileTest : public ::testing::Test {
 protected:
  PresetFileTest() { fs::remove_all(folder_); }
  ~PresetFileTest() override { fs::remove_all(folder_); }
  std::string read(const std::string& path) const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(folder_);
    std::ofstream(folder_ / name) << text;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("presets_" + std::to_string(getpid()));
  const PresetFile file_{folder_.string(), "harp"};
};

TEST_F(PresetFileTest, HoldsWhatWasKeptToTheLastBit) {
  EXPECT_TRUE(file_.read().empty());
  const PresetValues warm = {{"loss", 1.0 / 3.0}, {"on", -1.7e-5}};
  file_.keep("warm", warm);
  file_.keep("1", {{"loss", 0.0}});
  file_.keep("no", {{"loss", 2.0}});
  EXPECT_EQ(file_.at("warm"), warm);
  EXPECT_EQ(file_.at("no"), (PresetValues{{"loss", 2.0}}));
  file_.keep("warm", {{"loss", 4.0}});
  EXPECT_EQ(file_.at("warm"), (PresetValues{{"loss", 4.0}}));
  EXPECT_EQ(file_.read().size(), 3U);
}

TEST_F(PresetFileTest, ForgetsOneAndSaysWhichThereAre) {
  file_.keep("warm", {{"loss", 1.0}});
  file_.keep("cold", {{"loss", 2.0}});
  EXPECT_THAT(complaintOf([&] { file_.forget("wram"); }),
              AllOf(HasSubstr("there is no preset 'wram'"), HasSubstr("known: cold, warm")));
  file_.forget("cold");
  EXPECT_EQ(file_.read().count("cold"), 0U);
  EXPECT_EQ(file_.read().count("warm"), 1U);
}

TEST_F(PresetFileTest, IsLeftAsItIsWhereItCannotBeRead) {
  write("harp.yaml", "warm: {loss: 1\n");
  EXPECT_THAT(complaintOf([&] { file_.keep("cold", {{"loss", 2.0}}); }), HasSubstr("harp.yaml:"));
  EXPECT_EQ(read(file_.path()), "warm: {loss: 1\n");
  write("harp.yaml", "warm: {loss: much}\n");
  EXPECT_THAT(complaintOf([&] { file_.read(); }), HasSubstr("harp.yaml:1:14"));
  write("harp.yaml", "warm: 5\n");
  EXPECT_THAT(complaintOf([&] { file_.read(); }), HasSubstr("harp.yaml:1:"));
  write("harp.yaml", "[1, 2]\n");
  EXPECT_THAT(complaintOf([&] { file_.read(); }), HasSubstr("harp.yaml:1:"));
  write("harp.yaml", "warm: {loss: 1}\nwarm: {loss: 2}\n");
  EXPECT_THAT(complaintOf([&] { file_.read(); }), HasSubstr("harp.yaml:2:"));
}

TEST_F(PresetFileTest, HoldsAHundredAtMost) {
  for (std::size_t i = 0; i < PresetFile::kMaxPresets; ++i) {
    file_.keep("p" + std::to_string(i), {{"loss", 1.0}});
  }
  file_.keep("p7", {{"loss", 2.0}});
  EXPECT_THAT(complaintOf([&] { file_.keep("other", {{"loss", 1.0}}); }), HasSubstr("allowed"));
  EXPECT_EQ(file_.read().size(), PresetFile::kMaxPresets);
}

TEST(FittingValuesTest, LeaveOutWhatTheSceneDoesNotHaveOrAllowAndSaySo) {
  scene::Parameter loss;
  loss.name = "loss";
  loss.minimum = 0.0;
  loss.maximum = 1.0;
  loss.unit = "N s/m";
  scene::Parameter tension = loss;
  tension.name = "tension";
  const FittingValues fitting =
      fittingValues({{"loss", 2.0}, {"tension", 1.0}, {"width", 3.0}}, {loss, tension});
  EXPECT_EQ(fitting.values, (PresetValues{{"tension", 1.0}}));
  EXPECT_EQ(fitting.left_out,
            "'loss' is 2 N s/m, allowed: 0...1 N s/m; the scene has no parameter 'width'");
  EXPECT_EQ(fittingValues({{"loss", 0.5}}, {loss}).left_out, "");
}

TEST(FileNameTest, IsOneThatEveryFolderTakes) {
  for (const char* const name : {"", ".x", "../x", "a b", "a/b", "é"}) {
    EXPECT_THAT(complaintOf([&] { requireFileName("preset", name); }),
                HasSubstr("a preset cannot be named"));
  }
  requireFileName("preset", "a-1_b.c");
  EXPECT_EQ(toFileName("a string / one"), "a_string___one");
}

class VariantFileTest : public PresetFileTest {
 protected:
  scene::Scene played(const std::string& text) const {
    write("harp.yaml", text);
    return scene::readSceneFile((folder_ / "harp.yaml").string());
  }
  /// What the parameters are in the variant that was saved.
  PresetValues saved(const scene::Scene& scene, const PresetValues& values) {
    saved_ = saveVariant((folder_ / "presets").string(), scene, "warm", values);
    PresetValues read;
    for (const auto& parameter : scene::readSceneFile(saved_.path, {}, {"warm"}).parameters) {
      read[parameter.name] = parameter.value;
    }
    return read;
  }
  SavedVariant saved_;
};

const std::string kHarp =
    "# A harp.\nergotic: 1\nparameters: {loss: {value: 0.5, range: [0, 1]}}\n"
    "sections: {s: {rate: audio}}\nmats: {m: {type: cell, section: s, mass: 1, stiffness: 1, "
    "damping: $loss}}\noutputs: {o: {at: m, quantity: position, channel: 1}}\n";

TEST_F(VariantFileTest, IsACopyOfTheSceneWithAVariant) {
  const PresetValues values = {{"loss", 1.0 / 3.0}};
  EXPECT_EQ(saved(played(kHarp), values), values);
  EXPECT_FALSE(saved_.is_written_out);
  EXPECT_EQ(saved_.path, (folder_ / "presets/harp/warm.yaml").string());
  EXPECT_THAT(read(saved_.path), StartsWith("# A harp.\nergotic: 1\n"));
  EXPECT_EQ(scene::readSceneFile(saved_.path).parameters[0].value, 0.5) << "the scene itself";
}

TEST_F(VariantFileTest, KeepsTheVariantsThatAreThere) {
  const scene::Scene scene =
      played(kHarp + "variants:  # of it\n\n    cold: {set: {loss: 0.1}}\n# the end\n");
  EXPECT_EQ(saved(scene, {{"loss", 0.75}}), (PresetValues{{"loss", 0.75}}));
  EXPECT_THAT(scene::readSceneFile(saved_.path).variants,
              testing::UnorderedElementsAre("warm", "cold"));
}

TEST_F(VariantFileTest, IsOfTheVariantThatPlays) {
  std::string harp = kHarp;
  harp.replace(harp.find("mass: 1"), 7, "mass: =kg");
  played("let: {kg: 1}\n" + harp + "variants:\n  heavy: {let: {kg: 7}}\n");
  const scene::Scene heavy = scene::readSceneFile((folder_ / "harp.yaml").string(), {}, {"heavy"});
  EXPECT_EQ(saved(heavy, {{"loss", 0.75}}), (PresetValues{{"loss", 0.75}}));
  EXPECT_TRUE(saved_.is_written_out);
  EXPECT_EQ(scene::readSceneFile(saved_.path, {}, {"warm"}).mats[0].mass.factor, 7.0);
}

TEST_F(VariantFileTest, SaysWhatItCannotDoAndWritesNothing) {
  const auto complaint = [this](const scene::Scene& scene, const std::string& name) {
    return complaintOf([&] {
      saveVariant((folder_ / "presets").string(), scene, name, {{"loss", 0.75}});
    });
  };
  EXPECT_THAT(complaint(played(kHarp + "variants: {cold: {set: {loss: 0.1}}}\n"), "warm"),
              HasSubstr("harp.yaml:7:1: error: 'variants' is in flow style"));
  EXPECT_THAT(complaint(played(kHarp), "1.5"), HasSubstr("1.5"));
  scene::Scene mdl;
  mdl.file = "harp.mdl";
  EXPECT_THAT(complaint(mdl, "warm"), HasSubstr("an .mdl file has no variants"));
  EXPECT_FALSE(fs::exists(folder_ / "presets"));
}

TEST_F(VariantFileTest, IsTheTextOfShippedScenesWhetherTheyIncludeFilesOrNot) {
  for (const char* const name : {"string", "guitar"}) {
    const scene::Scene scene =
        scene::readSceneFile(repository(std::string("models/") + name + ".yaml"));
    PresetValues values;
    for (const scene::Parameter& parameter : scene.parameters) {
      values[parameter.name] = 0.3 * parameter.minimum + 0.7 * parameter.maximum;
    }
    EXPECT_EQ(saved(scene, values), values) << name;
    EXPECT_FALSE(saved_.is_written_out) << name;
  }
}

}  // namespace
}  // namespace ergotic::node
