// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/measure.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using test::cents;
using test::partialNear;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kPi = 3.14159265358979323846;
constexpr double kPitch = 110.0;

/// The springs of an ideal string of 110 Hz, cut into N masses.
double kappaOf(int masses) {
  return std::pow(2.0 * kPitch * (masses + 1) / kRate, 2.0);
}

double closedFormHz(int masses, int partial) {
  const double s = std::sin(kPi * partial / (2.0 * (masses + 1)));
  return std::asin(std::sqrt(kappaOf(masses)) * s) / kPi * kRate;
}

/// What is heard near one end of a string that was pulled near the other.
std::vector<double> pluckedString(int masses) {
  SceneBuilder b;
  const double m = 1e-4;
  const int first = b.chain(masses, m, kappaOf(masses) * m * kRate * kRate);
  const double pulled = 0.13 * (masses + 1);
  for (int i = 1; i <= masses; ++i) {
    b.scene.mats[static_cast<std::size_t>(first + i)].position.x() =
        1e-3 * (i < pulled ? i / pulled : (masses + 1 - i) / (masses + 1 - pulled));
  }
  b.hear(first + masses - masses / 20);
  Player player(b.scene, {kRate, 14});
  player.ticks(1600);
  return player.heard[0];
}

TEST(StringPartialsTest, SoundAtTheFrequenciesOfTheClosedForm) {
  for (const int masses : {20, 50, 80, 160, 199}) {
    const std::vector<double> sound = pluckedString(masses);
    for (int partial = 1; partial <= 10; ++partial) {
      const double expected = closedFormHz(masses, partial);
      EXPECT_LT(std::abs(cents(partialNear(sound, expected, kRate), expected)), 0.01)
          << masses << " masses, partial " << partial;
    }
  }
}

TEST(StringPartialsTest, AreTunedBetterWithMoreMasses) {
  struct Row {
    int masses;
    double cents[3];  // of partials 1, 5, 10 from the ideal string
    double tolerance;
  };
  for (const Row& row : {Row{20, {-1.6, -40.0, -163.0}, 0.5}, Row{80, {-0.1, -2.3, -9.1}, 0.05},
                         Row{160, {0.0, -0.24, -1.0}, 0.05}, Row{199, {0.0, 0.0, -0.01}, 0.01}}) {
    const std::vector<double> sound = pluckedString(row.masses);
    const int partials[3] = {1, 5, 10};
    for (int i = 0; i < 3; ++i) {
      const double ideal = kPitch * partials[i];
      const double is = partialNear(sound, closedFormHz(row.masses, partials[i]), kRate);
      EXPECT_NEAR(cents(is, ideal), row.cents[i], row.tolerance) << row.masses << " masses";
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
