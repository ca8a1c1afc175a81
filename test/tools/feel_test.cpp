// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/feel.hpp"

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

using test::kRates;

/// One slice and a ground, with a link between them and a port.
std::string sceneOf(const std::string& link, const std::string& port = "") {
  return "ergotic: 1\nsections: {k: {rate: gestural}}\n"
         "mats: {key: {type: slice, section: k}, wall: {type: ground, section: k, x: 0.005}}\n"
         "lias: {l: {" +
         link + "}}\nports: {p: {mat: key, slice: 3" + port + "}}\n";
}

std::unique_ptr<station::Performer> performerOf(const std::string& text) {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  return station::makePerformer(scene::readYaml(text, "feel.yaml"), kRates,
                                physics::Precision::kDouble, policy);
}

StrokeFigures felt(const std::string& text, double travel, double speed) {
  const auto performer = performerOf(text);
  return figuresOf(feel(*performer, 3, travel, speed));
}

TEST(FeelTest, OfAWallIsItsSlopeAndTheWorkOfASpring) {
  const std::string wall = sceneOf("type: contact, between: [key, wall], stiffness: 1000");
  for (const double speed : {0.01, 0.5}) {
    const StrokeFigures figures = felt(wall, 0.02, speed);
    EXPECT_NEAR(figures.stiffest, 1000.0, 1e-6);
    EXPECT_NEAR(figures.peak_n, 15.0, 1e-9);
    // The tick in which it is met is no straight line: at most K (v T)^2/8.
    const double step = speed / kRates.gesturalHz();
    EXPECT_NEAR(figures.press_j, 0.5 * 1000.0 * 0.015 * 0.015, 1000.0 * step * step);
    EXPECT_NEAR(figures.release_j, figures.press_j, 1e-9);
    EXPECT_EQ(figures.release_n, 0.0);
  }
}

/// x_model = x/s, F = g F_model: K at the device is K g/s.
TEST(FeelTest, IsInNewtonsAtTheDevice) {
  const StrokeFigures figures = felt(sceneOf("type: contact, between: [key, wall], stiffness: 1000",
                                             ", position_scale: 0.5, force_scale: 0.2"),
                                     0.01, 0.01);
  EXPECT_NEAR(figures.stiffest, 1000.0 * 0.2 / 0.5, 1e-6);
  EXPECT_NEAR(figures.peak_n, 0.2 * 1000.0 * 0.015, 1e-9);
  EXPECT_NEAR(figures.press_j, 0.5 * 400.0 * 0.0075 * 0.0075, 1e-6);
}

TEST(FeelTest, OfADamperIsALoopThatGrowsWithTheSpeed) {
  const std::string damper =
      sceneOf("type: spring_damper, between: [key, wall], stiffness: 0, damping: 4");
  for (const double speed : {0.01, 0.5}) {
    const StrokeFigures figures = felt(damper, -0.02, speed);
    EXPECT_NEAR(figures.peak_n, 4.0 * speed, 1e-9);
    // Its first tick is still without force, and the first of the way back goes on as before.
    const double step = speed / kRates.gesturalHz();
    EXPECT_NEAR(figures.press_j, 4.0 * speed * 0.02, 4.0 * speed * step);
    EXPECT_NEAR(figures.press_j - figures.release_j, 2.0 * 4.0 * speed * 0.02,
                4.0 * 4.0 * speed * step);
  }
}

TEST(FeelTest, OfAPluckIsWhatItLetsGoAt) {
  const StrokeFigures figures = felt(
      "ergotic: 1\nsections: {k: {rate: gestural}}\n"
      "mats: {key: {type: slice, section: k, rest: -0.01}, string: {type: ground, section: k}}\n"
      "lias: {l: {type: pluck, between: [key, string], stiffness: 8000, width: 0.004}}\n"
      "ports: {p: {mat: key, slice: 3}}\n",
      0.02, 0.01);
  EXPECT_NEAR(figures.release_n, 0.09 * 8000.0 * 0.004, 8000.0 * 0.01 / kRates.gesturalHz());
  EXPECT_NEAR(figures.stiffest, 0.1 * 8000.0, 1e-6);
}

TEST(FeelTest, OfAPluckByItsReleaseForceIsThatForce) {
  for (const char* numbers :
       {"release_force: 2", "release_force: 2 N, stiffness: 8000", "release_force: $force",
        "release_force: 0.5*$force, stiffness: 700"}) {
    const StrokeFigures figures = felt(
        std::string("ergotic: 1\nsections: {k: {rate: gestural}}\n"
                    "parameters: {force: {value: 2, range: [1, 4]}}\n"
                    "mats: {key: {type: slice, section: k, rest: -0.04}, string: {type: ground, "
                    "section: k}}\nlias: {l: {type: pluck, between: [key, string], ") +
            numbers + "}}\nports: {p: {mat: key, slice: 3}}\n",
        0.06, 0.01);
    const double expected = numbers[15] == '0' ? 1.0 : 2.0;
    EXPECT_NEAR(figures.release_n, expected, 0.02 * expected) << numbers;
  }
}

/// On its way back it is not felt at all.
TEST(FeelTest, OfAOneWayPluckIsItsReleaseForceOnTheWayOut) {
  const StrokeFigures figures =
      felt(sceneOf("type: one_way_pluck, between: [key, wall], release_force: 2, stiffness: 1000"),
           0.02, 0.01);
  EXPECT_NEAR(figures.release_n, 2.0, 1000.0 * 0.01 / kRates.gesturalHz());
  EXPECT_NEAR(figures.stiffest, 1000.0, 1e-6);
  EXPECT_NEAR(figures.press_j, 0.5 * 2.0 * 2e-3, 2.0 * 0.01 / kRates.gesturalHz());
  EXPECT_NEAR(figures.release_j, 0.0, 1e-12);
}

/// A spring that lets go does so within a tick.
TEST(FeelTest, TellsTheForceAtWhichSomethingLetsGo) {
  const StrokeFigures figures =
      felt(sceneOf("type: conditional, between: [key, wall], stiffness: 500, rest_length: -0.005, "
                   "engage: 0.001, release: 0.012"),
           0.02, 0.01);
  EXPECT_NEAR(figures.release_n, 500.0 * 0.012, 500.0 * 0.01 / kRates.gesturalHz());
  EXPECT_GT(figures.press_j, 0.5 * 500.0 * 0.0119 * 0.0119);
  EXPECT_LT(figures.release_j, figures.press_j);
}

TEST(FeelTest, StartsEveryStrokeAnew) {
  const auto performer = performerOf(
      "ergotic: 1\nsections: {k: {rate: gestural}}\n"
      "mats: {key: {type: slice, section: k}, m: {type: mass, section: k, mass: 0.01}}\n"
      "lias: {l: {type: spring_damper, between: [key, m], stiffness: 300, damping: 0.1}}\n"
      "ports: {p: {mat: key, slice: 3}}\n");
  const Stroke first = feel(*performer, 3, 0.01, 0.1);
  const Stroke second = feel(*performer, 3, 0.01, 0.1);
  ASSERT_EQ(first.ticks.size(), second.ticks.size());
  for (std::size_t i = 0; i < first.ticks.size(); ++i) {
    EXPECT_EQ(first.ticks[i].force, second.ticks[i].force);
  }
}

TEST(FeelTest, RefusesWhatNobodyCanFeel) {
  const auto performer = performerOf(sceneOf("type: contact, between: [key, wall], stiffness: 1"));
  EXPECT_THROW(feel(*performer, 2, 0.01, 0.1), Exception);
  EXPECT_THROW(feel(*performer, 3, 0.0, 0.1), Exception);
  EXPECT_THROW(feel(*performer, 3, 1.0, 1e-7), Exception);
  for (const char* word : {"slice", "slice:", "slice:x", "slice:64", "slice:-1", "port:1"}) {
    FeelChoice choice;
    choice.slice = word;
    EXPECT_THROW(sliceOf(choice), Exception) << word;
  }
}

TEST(FeelToolTest, WritesATableAndSaysWhatItMeans) {
  const test::ScratchFile scene(sceneOf("type: contact, between: [key, wall], stiffness: 1000"));
  const test::ScratchFile csv;
  const test::ScratchFile picture;
  const test::Outcome outcome = test::run(
      "render",
      scene.path() +
          " --precision double --gestural-rate 3150 --feel slice:3 --feel-speed 0.01 --feel-csv " +
          csv.path() + " --plot " + picture.path());
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("stiffest_n_per_m: 1000"));
  EXPECT_THAT(outcome.text, HasSubstr("passive_up_to_n_per_m: 4200"));
  EXPECT_THAT(csv.text(), HasSubstr("speed_m_per_s,way,position_m,velocity_m_per_s,force_n\n"));
  EXPECT_THAT(picture.text(), HasSubstr("PNG"));
  EXPECT_EQ(test::run("render", scene.path() + " --feel slice:3 --gesture x.csv").code, 2);
  EXPECT_EQ(test::run("render", scene.path() + " --feel slice:1").code, 1);
  EXPECT_EQ(test::run("render", scene.path() + " --feel-travel 0.1").code, 2);
}

}  // namespace
}  // namespace ergotic::tools
