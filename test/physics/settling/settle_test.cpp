// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"

#include <gtest/gtest.h>

#include "physics/settling/pitch_pull.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using test::SceneBuilder;

const Rates kRates{44100.0, 14};

/// A string of ten links in space, 1 m long, plucked to a height.
SceneBuilder spatialString(double rest_length, double height) {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  const int first = b.chain(9, 1e-4, 1000.0);
  for (int i = 0; i <= 10; ++i) {
    scene::Mat& mat = b.scene.mats[static_cast<std::size_t>(first + i)];
    mat.rest.x() = 0.1 * i;
    mat.position = mat.rest;
  }
  b.scene.mats[static_cast<std::size_t>(first + 5)].position.z() = height;
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = rest_length;
  }
  scene::StringInfo info;
  info.name = "string";
  info.first = first;
  info.count = 11;
  b.scene.strings.push_back(info);
  return b;
}

bool has(const Settled& settled, const std::string& text) {
  return settled.notes.size() == 1 && settled.notes[0].find(text) != std::string::npos;
}

TEST(SettleTest, PitchPullHasItsClosedForm) {
  EXPECT_NEAR(pitchPullCents(0.9, 0.01), 1.44, 0.005);
  EXPECT_NEAR(pitchPullCents(0.99, 0.01), 15.9, 0.05);
  EXPECT_EQ(pitchPullCents(0.0, 0.01), 0.0);
}

TEST(SettleTest, StringInSpaceIsToldWhatItGains) {
  const Settled settled = settle(spatialString(0.09, 0.0).scene, kRates);
  EXPECT_TRUE(has(settled,
                  "0.0144 cents higher at an amplitude of 0.1 % of its length, 1.44 at "
                  "1 %: geometry: scalar"))
      << settled.notes.at(0);
  EXPECT_FALSE(has(settle(spatialString(0.099, 0.0).scene, kRates), "geometry: scalar"))
      << "15.9 cents";
}

TEST(SettleTest, PluckAtTheStartDecidesIfThereIsOne) {
  EXPECT_TRUE(has(settle(spatialString(0.09, 0.0144).scene, kRates), "geometry: scalar"));
  const Settled wide = settle(spatialString(0.09, 0.0145).scene, kRates);
  EXPECT_TRUE(has(wide, "3.03 as it is plucked at the start")) << wide.notes.at(0);
  EXPECT_FALSE(has(wide, "geometry: scalar"));
  EXPECT_TRUE(has(settle(spatialString(0.1, 0.0).scene, kRates), "is not stretched"));
}

TEST(SettleTest, ScalarStringsAreNotAdvised) {
  SceneBuilder b = spatialString(0.0, 0.0);
  b.scene.sections[0].geometry = scene::Geometry::kScalar;
  EXPECT_TRUE(settle(b.scene, kRates).notes.empty());
}

TEST(SettleTest, EveryOpenChoiceMakesASceneUnsettled) {
  const auto open = [](auto&& change) {
    SceneBuilder b;
    b.chain(4, 1e-4, 1000.0);
    b.scene.strings.push_back({});
    change(b.scene);
    return !scene::isSettled(b.scene);
  };
  EXPECT_FALSE(open([](scene::Scene&) {}));
  EXPECT_TRUE(open([](scene::Scene& s) { s.sections[1].automatic_rate = true; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.strings[0].corrected_hz = 110.0; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.lias[2].scheme = scene::Scheme::kAuto; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.lias[2].filtered = true; }));
}

TEST(SettleTest, SettledSceneIsLeftAlone) {
  SceneBuilder b;
  b.chain(4, 1e-4, 1000.0);
  b.scene.sections[0].automatic_rate = true;
  for (scene::Lia& lia : b.scene.lias) {
    lia.scheme = scene::Scheme::kAuto;
  }
  const Settled once = settle(b.scene, kRates);
  EXPECT_TRUE(scene::isSettled(once.scene));
  const Settled twice = settle(once.scene, kRates);
  EXPECT_TRUE(twice.notes.empty());
  EXPECT_EQ(twice.scene.sections[0].divisor, once.scene.sections[0].divisor);
}

}  // namespace
}  // namespace ergotic::physics
