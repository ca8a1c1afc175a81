// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using test::Player;
using test::SceneBuilder;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// A plucked string with losses, a hammer that comes back to it after half a second.
scene::Scene struckTwice(double sleep_energy) {
  SceneBuilder b;
  const int first = b.chain(40, 1e-4, 900.0, 1e-3);
  for (int m = first + 1; m <= first + 40; ++m) {
    b.scene.mats[at(m)].type = scene::MatType::kCell;
    b.scene.mats[at(m)].damping = {4e-3};
  }
  b.scene.mats[at(first + 9)].push.edit().velocity.x() = 1.0;
  scene::Section other = b.scene.sections[0];
  other.name = "hammer";
  b.scene.sections.push_back(other);
  const int hammer = b.mass(5e-3, 0.5, -1.0, 2);
  const int l = b.link(scene::LiaType::kContact, first + 12, hammer, 2000.0);
  b.scene.lias[at(l)].law.edit().width = {0.0};
  b.scene.sections[0].sleep_energy = sleep_energy;
  b.hear(first + 25);
  return b.scene;
}

TEST(SleeperTest, RestsBelowItsLimitAndWakesWhenStruck) {
  constexpr double kLimit = 1e-12;
  Player awake(struckTwice(0.0), {44100.0, 14});
  Player sleepy(struckTwice(kLimit), {44100.0, 14});
  awake.ticks(2500);
  sleepy.ticks(2500);
  const std::vector<double>& a = awake.heard[0];
  const std::vector<double>& s = sleepy.heard[0];
  // |x| <= sqrt(E L / (2 k)) for a chain of L links: the error when it falls asleep; it decays.
  const double bound = std::sqrt(kLimit * 41.0 / (2.0 * 900.0));
  double error = 0.0;
  double zeros = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    error = std::max(error, std::abs(a[n] - s[n]));
    zeros += s[n] == 0.0 ? 1.0 : 0.0;
  }
  EXPECT_LE(error, bound);
  EXPECT_GT(error, bound * 1e-4) << "nothing was lost: it never slept";
  EXPECT_GT(zeros, 3000.0) << "it slept before the second stroke";
  EXPECT_GT(*std::max_element(s.begin() + 22050, s.end()), 1e-4) << "and woke by it";
}

TEST(SleeperTest, BooksWhatItForgetsAsDissipated) {
  Player player(struckTwice(1e-8), {44100.0, 14});
  Energies e = player.instrument->makeEnergies();
  player.ticks(1000);
  player.instrument->readEnergies(e);
  EXPECT_EQ(e.sections[0].kinetic + e.sections[0].potential, 0.0);
  EXPECT_NEAR(e.residual, 0.0, 1e-14);
}

TEST(SleeperTest, RefusesASectionThatDoesNotRestAtZero) {
  scene::Scene scene = struckTwice(1e-9);
  scene.sections[0].gravity.x() = -9.81;
  EXPECT_THROW(compile(scene, {44100.0, 14}, Precision::kDouble), Exception);
}

}  // namespace
}  // namespace ergotic::physics
