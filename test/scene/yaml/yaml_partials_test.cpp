// SPDX-License-Identifier: BSD-3-Clause
// Resonators whose partials are in a file.
#include <unistd.h>

#include <filesystem>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

class YamlPartialsTest : public testing::Test {
 protected:
  YamlPartialsTest() { std::filesystem::create_directories(folder_); }
  ~YamlPartialsTest() override { std::filesystem::remove_all(folder_); }

  Scene read(const std::string& csv, const std::string& more = "") const {
    std::ofstream(folder_ + "b.csv", std::ios::binary) << csv;
    return readYaml(text("{file: b.csv}", more), folder_ + "scene.yaml");
  }
  static std::string text(const std::string& partials, const std::string& more = "") {
    return "ergotic: 1\nsections: {a: {}}\ngenerators: [{type: resonator, name: b, places: [p, q], "
           "partials: " +
           partials + more + "}]\n";
  }
  void expectRefused(const std::string& csv,
                     const std::string& message,
                     const std::string& more = "") const {
    EXPECT_THAT(complaintOf<TextError>([&] { read(csv, more); }),
                StartsWith(folder_ + "b.csv:" + message))
        << csv;
  }

  std::string folder_ = testing::TempDir() + "ergotic_partials_" + std::to_string(::getpid()) + "/";
};

void expectAlike(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.mats.size(), b.mats.size());
  for (std::size_t i = 0; i < a.mats.size(); ++i) {
    EXPECT_EQ(a.mats[i].mass.factor, b.mats[i].mass.factor) << i;
    EXPECT_EQ(a.mats[i].stiffness.factor, b.mats[i].stiffness.factor) << i;
    EXPECT_EQ(a.mats[i].damping.factor, b.mats[i].damping.factor) << i;
  }
  ASSERT_EQ(a.taps.size(), b.taps.size());
  for (std::size_t t = 0; t < a.taps.size(); ++t) {
    ASSERT_EQ(a.taps[t].shares.size(), b.taps[t].shares.size()) << t;
    for (std::size_t s = 0; s < a.taps[t].shares.size(); ++s) {
      EXPECT_EQ(a.taps[t].shares[s].weight, b.taps[t].shares[s].weight) << t;
    }
  }
}

TEST_F(YamlPartialsTest, AreThoseOfTheFileWrittenOut) {
  const std::string csv =
      "# of a bell\nFrequency,T60,mass,p,q\n440, 3, 0.2, 1, -0.5\n881.5 2.5 0.2 0.3 1  # the "
      "octave\n";
  const char rows[] = "[[440, 3, 0.2, 1, -0.5], [881.5, 2.5, 0.2, 0.3, 1]]";
  expectAlike(read(csv), readYaml(text(rows), "a.yaml"));
  const char ratios[] = "[[0.5, 3, 0.2, 1, -0.5], [1.183, 2.5, 0.2, 0.3, 1]]";
  expectAlike(read("0.5 3 0.2 1 -0.5\n1.183 2.5 0.2 0.3 1\n", ", pitch: A4"),
              readYaml(text(ratios, ", pitch: A4"), "a.yaml"));
}

/// The text that recordings keep needs no file.
TEST_F(YamlPartialsTest, StayInTheTextThatIsKept) {
  const Scene first = read("440.123456789, 3, 0.2, 1, -0.5\n881.5, 2.5, 0.2, 0.3, 1\n");
  std::filesystem::remove(folder_ + "b.csv");
  const Scene again = readYaml(first.text, folder_ + "scene.yaml");
  expectAlike(first, again);
  EXPECT_EQ(again.text, first.text);
}

TEST_F(YamlPartialsTest, BrokenFilesAreToldWithTheirPlace) {
  expectRefused("", "1:1: error: the list has no partials, allowed: 1...400");
  expectRefused("440, 3\n",
                "1:7: error: mass is missing, allowed: frequency, t60, mass and 2 weights");
  expectRefused("440, 3, 1, 1\n", "1:13: error: a weight is missing");
  expectRefused("440, 3, 1, 1, 1, 1\n", "1:18: error: more than 5 fields in a line");
  expectRefused("440, 3, 1, 1, 1\n0, 3, 1, 1, 1\n", "2:1: error: frequency = 0 Hz is out of range");
  expectRefused("21000, 3, 1, 1, 1\n", "1:1: error: frequency = 21000 Hz is out of range");
  expectRefused("100, 3, 1, 1, 1\n", "1:1: error: frequency = 44000 Hz", ", pitch: A4");
  expectRefused("440, -3, 1, 1, 1\n", "1:6: error: t60 = -3 s is out of range");
  expectRefused("440, 3, nan, 1, 1\n", "1:9: error: mass = 'nan' is not a finite number");
  std::string many;
  for (int i = 0; i < 401; ++i) {
    many += "440, 3, 1, 1, 1\n";
  }
  expectRefused(many, "401:1: error: too many partials, allowed: 1...400");
}

TEST_F(YamlPartialsTest, FilesLieBelowTheScene) {
  const auto refusal = [&](const std::string& file) {
    return complaintOf<TextError>(
        [&] { readYaml(text("{file: " + file + "}"), folder_ + "scene.yaml"); });
  };
  EXPECT_THAT(refusal("/etc/passwd"), HasSubstr("is no path from the scene's folder"));
  EXPECT_THAT(refusal("../b.csv"), HasSubstr("is elsewhere, allowed: below the scene's folder"));
  EXPECT_THAT(refusal("none.csv"), HasSubstr("none.csv: cannot be read"));
  EXPECT_THAT(complaintOf<TextError>([&] {
                readYaml(text("{file: b.csv}") + "---\npartials: {\"c.csv\": [[1, 1, 1, 1, 1]]}\n",
                         folder_ + "scene.yaml");
              }),
              HasSubstr("file 'b.csv' of generator is not among the partials"));
  EXPECT_THAT(complaintOf<TextError>([&] {
                readYaml(text("[[440, 3, 1, 1, 1]]") + "---\npartials: {\"c.csv\": [[1, 1, 1]]}\n",
                         folder_ + "scene.yaml");
              }),
              HasSubstr("list 'c.csv' is used by no resonator"));
}

TEST(YamlRingTest, IsTheOutlineOfItsPartials) {
  const std::string text =
      "ergotic: 1\nsections: {a: {}}\ngenerators: [{type: resonator, name: b, places: [p, q], "
      "partials: [[100, 1, 1, 1, 1], [200, 1, 1, 1, 1]], at: [1, 2], "
      "ring: {radius: 0.1, height: -0.2, waves: [2, -3]}}]\n";
  const Scene scene = readYaml(text, "ring.yaml");
  ASSERT_EQ(scene.outlines.size(), 1U);
  const Outline& outline = scene.outlines[0];
  ASSERT_EQ(outline.modes, 2);
  ASSERT_EQ(outline.rest.size(), 4U * 48U);
  const auto weight = [&](std::size_t place, std::size_t mode) {
    return outline.weights[2 * place + mode];
  };
  EXPECT_DOUBLE_EQ(weight(0, 0), 1.0);
  EXPECT_DOUBLE_EQ(weight(0, 1), 0.0);
  EXPECT_NEAR(weight(12, 0), -1.0, 1e-12);  // a quarter round: half a wave of two
  EXPECT_NEAR(weight(8, 1), 0.0, 1e-12);    // a sixth: half a wave of three, whose sine is 0
  EXPECT_NEAR(weight(4, 1), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(weight(3 * 48 + 4, 1), 0.0);  // where the cone ends nothing moves
  const Eigen::Vector3d middle(0.0, 1.0, 2.0);
  EXPECT_LT((outline.rest[12] - middle - Eigen::Vector3d(0.0, 0.0, 0.1)).norm(), 1e-12);
  EXPECT_LT((outline.rest[3 * 48] - middle - Eigen::Vector3d(-0.2, 0.05, 0.0)).norm(), 1e-12);
  // Its two places are opposite one another.
  const Mat& q = scene.mats[3];
  EXPECT_EQ(q.name, "b.q");
  EXPECT_NEAR(q.rest.y(), 0.9, 1e-12);
}

}  // namespace
}  // namespace ergotic::scene
