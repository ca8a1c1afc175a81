// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/measure.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kPi = 3.14159265358979323846;
std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct String {
  Geometry geometry = Geometry::kSpace;
  int masses = 39;
  double kappa = 0.5;
  double damping = 0.0;
  double ratio = 0.0;      ///< rest length over length of a link
  double amplitude = 0.0;  ///< over the length of the string
};

/// A string of 1 m along x in the shape of its first mode across, heard in its middle.
std::vector<double> play(const String& string, int ticks) {
  SceneBuilder b;
  const bool scalar = string.geometry == Geometry::kScalar;
  b.scene.sections[0].geometry = string.geometry;
  const int links = string.masses + 1;
  const int first =
      b.chain(string.masses, 1e-4, string.kappa * 1e-4 * kRate * kRate, string.damping);
  const int across = scalar ? 0 : 2;
  for (int i = 0; i <= links; ++i) {
    scene::Mat& mat = b.scene.mats[at(first + i)];
    mat.rest.x() = scalar ? 0.0 : static_cast<double>(i) / links;
    mat.position = mat.rest;
    mat.position[across] += string.amplitude * std::sin(kPi * i / links);
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = string.ratio / links;
  }
  b.hear(first + links / 2);
  b.scene.outputs[0].axis = across;
  Player player(b.scene, {kRate, 14});
  player.ticks(ticks);
  return player.heard[0];
}

TEST(StretchedStringTest, WithoutRestLengthIsTheScalarOneAtAnyAmplitude) {
  String string;
  string.amplitude = 0.5;
  const auto space = play(string, 300);
  string.geometry = Geometry::kScalar;
  const auto scalar = play(string, 300);
  for (std::size_t n = 0; n < scalar.size(); ++n) {
    ASSERT_NEAR(space[n], scalar[n], 1e-13) << n;
  }
}

TEST(StretchedStringTest, OfRestLengthSwingsAcrossAsAScalarOneOfItsTension) {
  // Small motion across is held by the tension alone: kappa (1 - r).
  String string;
  string.ratio = 0.9;
  string.amplitude = 1e-7;
  const double angle = std::arg(test::poleOf(play(string, 300)));
  const double s = std::sin(kPi / (2.0 * (string.masses + 1)));
  EXPECT_NEAR(angle / (2.0 * std::asin(std::sqrt(0.1 * string.kappa) * s)), 1.0, 1e-7);
}

/// Cents by which a string sounds higher at 1 % of its length.
double pitchPull(double ratio) {
  String string;
  string.ratio = ratio;
  const double s = std::sin(kPi / (2.0 * (string.masses + 1)));
  const double still = std::asin(std::sqrt((1.0 - ratio) * string.kappa) * s) / kPi * kRate;
  string.amplitude = 0.01;
  return test::cents(test::partialNear(play(string, 1600), still, kRate), still);
}

TEST(StretchedStringTest, PitchRisesWithTheAmplitudeAsThePullFormulaSays) {
  for (const double r : {0.9, 0.99}) {
    const double formula = 1602.0 * r / (1.0 - r) * 1e-4;
    EXPECT_NEAR(pitchPull(r) / formula, 1.0, 0.05) << r;
  }
  EXPECT_LT(std::abs(pitchPull(0.0)), 1e-6);
}

}  // namespace
}  // namespace ergotic::physics
