// SPDX-License-Identifier: BSD-3-Clause
// Contacts that are far are passed over, and nothing that is played changes by that.
#include "physics/engine/near_links.hpp"

#include <cmath>
#include <random>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// What touches, and what it may touch: balls on springs, in a row. Each waits by itself; with
/// others at a distance that nothing comes to, they are passed over in tiles. If they follow an
/// audio parameter, which is always 1, they are looked at in every step.
class BallRow : public SceneBuilder {
 public:
  static constexpr int kBalls = 60;

  enum class Looked { kAlways, kEach, kTiles };

  BallRow(unsigned seed, Geometry geometry, bool is_hand, Looked looked) : random_(seed) {
    scene.sections[0].geometry = geometry;
    if (looked == Looked::kAlways) {
      scene.audio_parameters.push_back({"one", 0, 1.0, {}, 0.0, 1.0});
    }
    const bool is_scalar = geometry == Geometry::kScalar;
    const int toucher = is_hand ? slice(0) : mass(2e-3);
    if (!is_hand) {
      // It swings to and fro through the row.
      const int pivot = placed(ground(), {0.06, 0.0, 0.0});
      placed(toucher, {-0.005, is_scalar ? 0.0 : 0.006, 0.0});
      setVelocity(scene.mats[at(toucher)], {uniform(random_, 1.0, 3.0), 0.0, 0.0});
      spring(toucher, pivot, uniform(random_, 2.0, 20.0));
    }
    for (int i = 0; i < kBalls; ++i) {
      const Eigen::Vector3d place(0.002 * i, 0.0, 0.0);
      const int held = placed(ground(), place);
      const int ball = placed(mass(1e-4), place);
      spring(ball, held, 400.0, is_scalar ? 1e-3 : 0.0);
      touch(toucher, ball, is_scalar ? 0.0 : 0.003);
      if (i % 7 == 0) {
        hear(ball, i / 7);
      }
    }
    for (int i = 0; looked == Looked::kTiles && i < 100; ++i) {
      touch(toucher, placed(ground(), {50.0 + i, 0.0, 0.0}), 0.0);
    }
  }

 private:
  int placed(int mat, const Eigen::Vector3d& place) {
    scene.mats[at(mat)].position = place;
    scene.mats[at(mat)].rest = place;
    return mat;
  }
  void touch(int toucher, int other, double threshold) {
    scene::Lia& lia = scene.lias[at(link(LiaType::kContact, toucher, other, 50.0, 0.002))];
    lia.scheme = scene::Scheme::kEnergyStable;
    lia.law.edit().width = {threshold};
    lia.stiffness.audio = scene.audio_parameters.empty() ? -1 : 0;
  }

  std::mt19937 random_;
};

struct BallsPlayed {
  std::vector<std::vector<double>> heard;
  std::vector<double> forces;
  std::int64_t active = 0;
  int touched = 0;
};

BallsPlayed playBalls(const BallRow& row, unsigned seed, Precision precision, bool metered) {
  std::mt19937 random(seed);
  CompileOptions options(precision);
  options.metered = metered;
  Player player(compile(settle(row.scene, kRates).scene, kRates, options));
  BallsPlayed played;
  for (int n = 0; n < 600; ++n) {
    if (!player.positions.empty()) {
      player.positions[0] = n % 100 < 50 ? 1e-3 * n * uniform(random, 0.9, 1.0) : -0.01;
    }
    player.tick();
    played.forces.insert(played.forces.end(), player.forces.begin(), player.forces.end());
  }
  played.heard = player.heard;
  std::vector<TankReport> reports = player.instrument->makeTankReports();
  player.instrument->readTanks(reports);
  for (const TankReport& report : reports) {
    played.active += report.active;
    played.touched += report.active > 0 ? 1 : 0;
  }
  return played;
}

TEST(NearLinksTest, WhatIsPassedOverChangesNoBit) {
  for (const auto& [geometry, is_hand] :
       {std::pair(Geometry::kScalar, false), std::pair(Geometry::kScalar, true),
        std::pair(Geometry::kPlane, false), std::pair(Geometry::kSpace, false)}) {
    int touched = 0;
    for (unsigned seed = 0; seed < 12; ++seed) {
      const Precision precision = seed % 2 == 0 ? Precision::kDouble : Precision::kFloat;
      const bool metered = seed % 3 == 0;
      const auto play = [&](BallRow::Looked looked) {
        return playBalls(BallRow(seed, geometry, is_hand, looked), seed, precision, metered);
      };
      const BallsPlayed all = play(BallRow::Looked::kAlways);
      for (const auto looked : {BallRow::Looked::kEach, BallRow::Looked::kTiles}) {
        const BallsPlayed near = play(looked);
        EXPECT_EQ(all.heard, near.heard) << seed;
        EXPECT_EQ(all.forces, near.forces) << seed;
        EXPECT_EQ(all.active, near.active) << seed;
      }
      touched += all.touched;
    }
    EXPECT_GT(touched, 12 * 5);
  }
}

/// A place that a hand leads along a string at the gestural rate, past a ball at the audio rate: no
/// module moves, and yet they meet.
TEST(NearLinksTest, APlaceThatGlidesAtASlowerRateIsNeverFar) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\n"
      "gestural_rate: 3150\n"
      "sections: {play: {rate: audio, geometry: plane}, rail: {rate: gestural, geometry: plane},\n"
      "           keys: {rate: gestural}}\n"
      "generators: [{type: string, name: s, section: rail, masses: 5, mass: 1.0e-2,\n"
      "              stiffness: 100, from: [0, 0], to: [0.1, 0]}]\n"
      "mats:\n"
      "  hand: {type: slice, section: keys}\n"
      "  place: {type: point, along: s, at: 0, guide: {mat: hand, scale: 100}, speed: 20}\n"
      "  ball: {type: mass, section: play, mass: 1.0e-3, at: [0.05, 0.002]}\n"
      "lias: {touch: {type: contact, between: [place, ball], stiffness: 1000, threshold: 0.005,\n"
      "               scheme: energy_stable}}\n"
      "ports: {hand: {mat: hand, slice: 0}}\n",
      "glides.yaml");
  Player player(scene, kRates);
  for (int n = 0; n < 1000; ++n) {
    player.positions[0] = 0.01 * std::min(1.0, n / 600.0);
    player.tick();
  }
  std::vector<TankReport> reports = player.instrument->makeTankReports();
  player.instrument->readTanks(reports);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_GT(reports[0].active, 500) << "steps";
}

/// Links along one coordinate, from module 0 to all others.
std::vector<EnergyStableLink> starOf(int others) {
  std::vector<EnergyStableLink> links;
  for (int i = 1; i <= others; ++i) {
    EnergyStableLink link;
    link.terms = {{0, 0, 0, {1, 0, 0}}, {i, i, 0, {-1, 0, 0}}};
    link.may_wait = true;
    links.push_back(link);
  }
  return links;
}

/// What is not found could not have closed by the next step.
class NearLinksSearchTest : public ::testing::TestWithParam<int> {};

TEST_P(NearLinksSearchTest, FindsAllThatCouldCloseAndLittleElse) {
  const int kOthers = GetParam();  // as tiles of twenty, or each by itself
  std::mt19937 random(1);
  NearLinks<float> near(starOf(kOthers));
  ASSERT_EQ(near.waiting(), 32U);
  std::vector<float> clearances(near.waiting(), 0.0F);
  std::vector<float> x(at(kOthers) + 1);
  std::vector<float> d(at(kOthers) + 1);
  for (int i = 1; i <= kOthers; ++i) {
    x[at(i)] = static_cast<float>(1e-3 * i);
  }
  const auto gapOf = [&](std::size_t l) { return x[l + 1] - x[0]; };
  std::size_t found = 0;
  constexpr int kSteps = 20000;
  double speed = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    speed = 0.99 * speed + uniform(random, -2e-6, 2e-6);
    for (std::size_t i = 0; i < x.size(); ++i) {
      d[i] = static_cast<float>(i == 0 ? speed : uniform(random, -1e-7, 1e-7));
      x[i] += d[i];
    }
    near.find(x.data(), d.data(), clearances.data());
    std::vector<bool> is_found(at(kOthers), false);
    for (const std::size_t l : near) {
      is_found[l] = true;
    }
    for (std::size_t l = 0; l < at(kOthers); ++l) {
      const float closing = d[0] - d[l + 1];
      ASSERT_TRUE(is_found[l] || gapOf(l) > closing) << n << ", " << l;
    }
    found += static_cast<std::size_t>(near.end() - near.begin());
    near.remember([&](std::size_t l) { return std::max(0.0F, gapOf(l)); }, clearances.data());
  }
  EXPECT_LT(found, (kOthers == 640 ? 0.15 : 0.3) * kSteps * kOthers);
  x[3] = std::nanf("");
  d[3] = x[3];
  near.find(x.data(), d.data(), clearances.data());
  EXPECT_GE(near.end() - near.begin(), kOthers == 640 ? kOthers : 1);
}

INSTANTIATE_TEST_SUITE_P(Tiles, NearLinksSearchTest, ::testing::Values(640, 32));

TEST(NearLinksTest, AFewWaitEachByItself) {
  std::vector<EnergyStableLink> links = starOf(200);
  for (std::size_t l = 0; l < links.size(); ++l) {
    links[l].may_wait = l < 63;
  }
  EXPECT_EQ(NearLinks<double>(links).waiting(), 63U);
  links[100].may_wait = true;
  EXPECT_EQ(NearLinks<double>(links).waiting(), 33U) << "two a tile";
}

/// A module that moves far away makes nobody look at contacts that it has no part in.
TEST(NearLinksTest, AFewGoByTheirOwnModules) {
  NearLinks<float> near(starOf(8));
  std::vector<float> clearances(near.waiting(), 0.0F);
  std::vector<float> x{0.0F, 1e-3F, 2e-3F, 3e-3F, 4e-3F, 5e-3F, 6e-3F, 7e-3F, 8e-3F};
  std::vector<float> d(x.size(), 0.0F);
  const auto foundOf = [&] {
    near.find(x.data(), d.data(), clearances.data());
    return std::vector<std::size_t>(near.begin(), near.end());
  };
  EXPECT_EQ(foundOf().size(), 8U) << "nothing is known yet";
  near.remember([&](std::size_t l) { return x[l + 1] - x[0]; }, clearances.data());
  EXPECT_TRUE(foundOf().empty());
  d[3] = -1e-3F;
  EXPECT_EQ(foundOf(), std::vector<std::size_t>{2});
  d[3] = std::nanf("");
  EXPECT_EQ(foundOf(), std::vector<std::size_t>{2}) << "not a number";
}

}  // namespace
}  // namespace ergotic::physics
