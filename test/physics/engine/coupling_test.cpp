// SPDX-License-Identifier: BSD-3-Clause
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

class CouplingTest : public testing::TestWithParam<int> {};

/// What is heard first, at the start of every tick.
std::vector<double> startsOfTicks(const SceneBuilder& b, int ratio, int ticks) {
  Player player(b.scene, {kRate, ratio});
  player.ticks(ticks);
  std::vector<double> starts;
  for (int n = 0; n < ticks; ++n) {
    starts.push_back(player.heard[0][at(n * ratio)]);
  }
  return starts;
}

/// Positions of a gestural mass at the start of every tick.
std::vector<double> playMass(
    int ratio, int spring_section, double z, int ticks, bool mass_is_a = true) {
  SceneBuilder b;
  const double tick_s = ratio / kRate;
  const double m = 0.1;
  const double k = 0.5 * m / (tick_s * tick_s);
  const int mass = b.mass(m, 1e-3, 0.0, SceneBuilder::kGestural);
  const int ground = b.ground(0.0, spring_section);
  b.spring(mass_is_a ? mass : ground, mass_is_a ? ground : mass, k, z * m / tick_s);
  b.hear(mass);
  return startsOfTicks(b, ratio, ticks);
}

TEST_P(CouplingTest, GesturalMassOnAnAudioRateSpringMovesAsIfAllWereGestural) {
  const int ticks = 200 * 9;  // a period is 8.7 ticks
  for (const double z : {0.0, 0.01}) {
    const auto slow = playMass(GetParam(), SceneBuilder::kGestural, z, ticks);
    for (const bool mass_is_a : {true, false}) {
      const auto mixed = playMass(GetParam(), SceneBuilder::kAudio, z, ticks, mass_is_a);
      for (int n = 0; n < ticks; ++n) {
        ASSERT_NEAR(mixed[at(n)], slow[at(n)], 1e-12 * 1e-3) << n;
      }
    }
  }
}

/// Positions of a gestural mass that a spring pulls onto a hard energy-stable contact.
std::vector<double> playBouncingMass(int ratio, int spring_section, int ticks) {
  SceneBuilder b;
  const double m = 0.1;
  const double unit = m * std::pow(kRate / ratio, 2);
  const int mass = b.mass(m, 1e-3, 0.0, SceneBuilder::kGestural);
  b.spring(mass, b.ground(-1e-3, spring_section), 0.05 * unit);
  const int wall = b.ground(0.0, SceneBuilder::kGestural);
  const int contact = b.link(scene::LiaType::kContact, wall, mass, 3.0 * unit);
  b.scene.lias[at(contact)].scheme = scene::Scheme::kEnergyStable;
  b.hear(mass);
  return startsOfTicks(b, ratio, ticks);
}

TEST_P(CouplingTest, EnergyStableContactOfAGesturalMassKnowsTheForcesOfFasterSections) {
  const int ticks = 500;
  const auto slow = playBouncingMass(GetParam(), SceneBuilder::kGestural, ticks);
  const auto mixed = playBouncingMass(GetParam(), SceneBuilder::kAudio, ticks);
  EXPECT_LT(*std::min_element(slow.begin(), slow.end()), -1e-5) << "it never touched";
  for (int n = 0; n < ticks; ++n) {
    ASSERT_NEAR(mixed[at(n)], slow[at(n)], 1e-9 * 1e-3) << n;
  }
}

TEST_P(CouplingTest, UndampedMassesAcrossTheRatesKeepTheirEnergyOnAverage) {
  const int ratio = GetParam();
  const double tick_s = ratio / kRate;
  const double m = 0.01;
  const double k = 0.4 * m / (tick_s * tick_s) / 2.0;
  SceneBuilder b;
  const int slow = b.mass(m, 0.0, 1.0, SceneBuilder::kGestural);
  const int fast = b.mass(m, 0.0, -1.0);
  b.spring(slow, fast, k);
  b.hear(slow, 0);
  b.hear(fast, 1);
  b.hear(slow, 2, scene::Quantity::kVelocity);
  b.hear(fast, 3, scene::Quantity::kVelocity);
  Player player(b.scene, {kRate, ratio});
  const int window = 1000;
  std::vector<double> means;
  for (int w = 0; w < 21; ++w) {
    for (auto& channel : player.heard) {
      channel.clear();
    }
    player.ticks(window);
    double sum = 0.0;
    for (int n = 0; n < window; ++n) {
      const std::size_t i = at(n * ratio);
      const double e = player.heard[0][i] - player.heard[1][i];
      const double vs = player.heard[2][i];
      const double vf = player.heard[3][i];
      // Smooth ends: a window holds no whole number of periods.
      const double weight = 1.0 - std::cos(2.0 * kPi * n / window);
      sum += weight * (0.5 * k * e * e + 0.5 * m * (vs * vs + vf * vf));
    }
    means.push_back(sum / window);
  }
  EXPECT_GT(means.front(), 1e-3);
  EXPECT_LT(std::abs(means.back() / means.front() - 1.0), 1e-4);
}

/// So is the force that a hand feels.
TEST_P(CouplingTest, ForceOutputOfASlowModuleIsTheMeanOfItsLastWholeStep) {
  const int ratio = GetParam();
  SceneBuilder b;
  const int slice = b.slice(0);
  b.spring(slice, b.driven(0), 1000.0);
  b.hear(slice, 0, scene::Quantity::kForce);
  Player player(b.scene, {kRate, ratio});
  for (std::size_t r = 0; r < player.inputs.size(); ++r) {
    player.inputs[r] = 1e-3 * static_cast<double>(r);
  }
  player.ticks(2);
  const double mean = 1000.0 * 1e-3 * 0.5 * (ratio - 1);
  EXPECT_NEAR(player.forces[0], mean, 1e-12 * ratio);
  EXPECT_EQ(player.heard[0][at(ratio - 2)], 0.0) << "nothing is whole yet";
  for (int r = 0; r < ratio; ++r) {
    EXPECT_NEAR(player.heard[0][at(ratio - 1 + r)], mean, 1e-12 * ratio) << r;
  }
}

TEST_P(CouplingTest, ForceInputOnASlowMassIsAveraged) {
  const int ratio = GetParam();
  SceneBuilder b;
  const int mass = b.mass(0.5, 0.0, 0.0, SceneBuilder::kGestural);
  b.push(mass);
  b.hear(mass);
  Player player(b.scene, {kRate, ratio});
  player.inputs.assign(player.inputs.size(), 4.0);
  player.ticks(2);
  EXPECT_NEAR(player.heard[0].back(), 8.0 * std::pow(ratio / kRate, 2), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Ratios, CouplingTest, testing::Values(4, 8, 14, 16, 44));

TEST(SlowSectionTest, SectionSlowerThanTheTickIsSteppedEveryKthTick) {
  SceneBuilder b;
  b.scene.sections[0].divisor = 28;
  const int mass = b.mass(1.0, 0.0, 44100.0 / 28.0);
  b.hear(mass);
  Player player(b.scene, {kRate, 14});
  player.ticks(4);
  EXPECT_NEAR(player.heard[0][27], 1.0, 1e-12);
  EXPECT_NEAR(player.heard[0][28], 2.0, 1e-12);
  EXPECT_NEAR(player.heard[0][55], 2.0, 1e-12);
}

}  // namespace
}  // namespace ergotic::physics
