// SPDX-License-Identifier: BSD-3-Clause
// Points with any weights on any modules.
#include <random>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using Shares = std::vector<scene::Tap::Share>;

TEST(TapTest, HearsAndPushesWithItsWeights) {
  const double weights[] = {2.5, -0.75, 0.2};
  SceneBuilder b;
  Shares shares;
  for (const double weight : weights) {
    shares.push_back({b.ground(0.1 * weight), weight});
    b.hear(shares.back().mat, static_cast<int>(shares.size()), Quantity::kForce);
  }
  const int tap = b.tap(shares);
  b.spring(tap, b.ground(-1.0), 100.0);
  b.hear(tap);
  b.push(tap);
  Player player(b.scene, {kRate, 1});
  player.inputs = {7.0};
  player.tick();
  double place = 0.0;
  for (const double weight : weights) {
    place += 0.1 * weight * weight;
  }
  EXPECT_NEAR(player.heard[0].back(), place, 1e-14);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(player.heard[i + 1].back(), weights[i] * (7.0 - 100.0 * (place + 1.0)), 1e-12);
  }
}

void expectSame(const Player& one, const Player& other, double scale, double tolerance) {
  double peak = 0.0;
  double off = 0.0;
  for (std::size_t n = 0; n < one.heard[0].size(); ++n) {
    peak = std::max(peak, std::abs(one.heard[0][n]));
    off = std::max(off, std::abs(one.heard[0][n] - scale * other.heard[0][n]));
  }
  EXPECT_GT(peak, 1e-7);
  EXPECT_LT(off, tolerance * peak);
}

/// What a lever of the weight w does to a mass M is done to M/w^2 that moves w times as far.
TEST(TapTest, LeverMakesAMassAsHeavyAsItsWeightSays) {
  for (const LiaType type : {LiaType::kSpringDamper, LiaType::kContact, LiaType::kSmoothBow}) {
    for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
      if (type == LiaType::kSpringDamper && scheme == Scheme::kEnergyStable) {
        continue;
      }
      const auto play = [&](double lever, double mass, double far) {
        SceneBuilder b;
        const int m = b.cell(mass, 2e4 * mass, 0.5 * mass, -1e-3 * far, 0.3 * far);
        const int end = lever == 1.0 ? m : b.tap({{m, lever}});
        const int hit = b.cell(2e-3, 100.0, 0.0, 1e-4);
        const int link = b.link(type, end, hit, type == LiaType::kSmoothBow ? 0.0 : 3e4, 0.2);
        b.scene.lias[at(link)].scheme = scheme;
        b.scene.lias[at(link)].law.edit().width = {type == LiaType::kSmoothBow ? 0.2 : 0.0};
        b.hear(hit);
        Player player(b.scene, {kRate, 1});
        player.ticks(3000);
        return player;
      };
      for (const double lever : {3.0, -0.4}) {
        const double mass = 1.5e-3;
        expectSame(play(lever, mass, 1.0 / lever), play(1.0, mass / (lever * lever), 1.0), 1.0,
                   1e-10);
      }
    }
  }
}

TEST(TapTest, WithTheWeightsOfAPlaceIsThatPlace) {
  const auto play = [](bool by_tap, Precision precision) {
    SceneBuilder b;
    const int first = b.chain(15, 1e-3, 2e3, 0.01);
    const int there =
        by_tap ? b.tap({{first + 5, 0.2}, {first + 4, 0.8}}) : b.point(b.grid(first, 17), 0.2625);
    const int hammer = b.mass(2e-3, -1e-3, 2.0);
    b.link(LiaType::kContact, hammer, there, 5e3, 0.1);
    b.spring(there, b.cell(1e-3, 500.0, 0.1), 200.0, 0.05);
    b.hear(first + 9);
    Player player(b.scene, {kRate, 14}, precision);
    player.ticks(300);
    return player;
  };
  expectSame(play(true, Precision::kDouble), play(false, Precision::kDouble), 1.0, 1e-12);
  expectSame(play(true, Precision::kFloat), play(false, Precision::kFloat), 1.0, 1e-3);
}

/// Masses that fly about, held by springs, dampers, contacts and friction at taps that overlap.
scene::Scene tangle(Geometry geometry, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  SceneBuilder b;
  b.scene.sections[0].geometry = geometry;
  const auto anywhere = [&](double reach) {
    return Eigen::Vector3d(reach * number(random), reach * number(random), reach * number(random));
  };
  for (int i = 0; i < 12; ++i) {
    const int m = i == 0 ? b.ground() : b.cell(1e-3, 1.0, i % 2 == 0 ? 0.0 : 1e-4);
    scene::Mat& mat = b.scene.mats[at(m)];
    mat.rest = geometry == Geometry::kScalar ? Eigen::Vector3d::Zero() : anywhere(0.1);
    mat.position = mat.rest + (i == 0 ? Eigen::Vector3d::Zero() : anywhere(1e-3));
    if (i > 0) {
      mat.push.edit().velocity = anywhere(1.0);
    }
  }
  const auto anyTap = [&] {
    Shares shares;
    for (int m = 0; m < 12; ++m) {
      if (number(random) > 0.4) {
        shares.push_back({m, 0.7 * number(random)});
      }
    }
    shares.push_back({12 - 1 - static_cast<int>(shares.size()) % 2, 0.5});
    if (shares.size() > 1 && shares[shares.size() - 2].mat >= shares.back().mat) {
      shares.pop_back();
    }
    return b.tap(shares);
  };
  const LiaType types[] = {LiaType::kSpringDamper, LiaType::kContact, LiaType::kSmoothBow,
                           LiaType::kCubic};
  for (int i = 0; i < 16; ++i) {
    const LiaType type = types[i % 4];
    const double k = 0.05 * 1e-3 * kRate * kRate;
    const int other = i % 3 == 0 ? anyTap() : 1 + i % 11;
    const int link = b.link(type, anyTap(), other, type == LiaType::kSmoothBow ? 0.0 : k,
                            type == LiaType::kCubic ? 0.0 : 1e-6 * k);
    Lia& lia = b.scene.lias[at(link)];
    lia.scheme = type == LiaType::kSpringDamper ? Scheme::kExplicit : Scheme::kEnergyStable;
    lia.law.edit().width = {type == LiaType::kSmoothBow ? 0.3 : 1e-3};
    lia.law.edit().nonlinearity = {type == LiaType::kCubic ? 100.0 * k : 0.0};
  }
  b.hear(1);
  return b.scene;
}

/// What a tap gives and takes is given and taken by its modules.
TEST(TapTest, EnergyBalancesAndEnergyStableLinksThatShareModulesMakeNothing) {
  for (const Geometry geometry :
       {Geometry::kScalar, Geometry::kLine, Geometry::kPlane, Geometry::kSpace}) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      Player player(tangle(geometry, seed), {kRate, 4});
      player.tick();
      Energies energies = energiesOf(player);
      const double start = energies.stored;
      double most = start;
      for (int n = 0; n < 3000; ++n) {
        player.tick();
        player.instrument->readEnergies(energies);
        most = std::max(most, energies.stored);
        ASSERT_LT(std::abs(energies.residual), 1e-11 * start) << n << " of seed " << seed;
      }
      EXPECT_LT(most, 1.001 * start) << "seed " << seed;
      EXPECT_LT(energies.stored, 0.99 * start) << "seed " << seed;
    }
  }
}

TEST(TapTest, ComesBackToWhereItsStateWasSaved) {
  const scene::Scene scene = tangle(Geometry::kPlane, 3);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    Player one(scene, {kRate, 4}, precision);
    one.ticks(100);
    std::vector<unsigned char> state(one.instrument->stateSize());
    one.instrument->saveState(state.data());
    Player other(scene, {kRate, 4}, precision);
    other.instrument->loadState(state.data());
    one.heard[0].clear();
    one.ticks(200);
    other.ticks(200);
    EXPECT_EQ(one.heard, other.heard);
  }
}

/// Forces on taps cross rates, geometries and frames as those on modules do.
TEST(TapTest, EnergyBalancesAcrossRatesAndGeometries) {
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kPlane;
  b.scene.sections[0].pose.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  Shares fast;
  for (int i = 0; i < 3; ++i) {
    const int m = b.cell(1e-3, 50.0, 1e-3, 1e-4 * i, 0.2);
    b.scene.mats[at(m)].push.edit().velocity.y() = 0.1 * i - 0.1;
    fast.push_back({m, 0.9 - 0.6 * i});
  }
  Shares slow;
  for (int i = 0; i < 3; ++i) {
    slow.push_back({b.cell(0.1, 50.0, 1e-2, 0.0, 0.05 * i, SceneBuilder::kGestural), i - 0.7});
  }
  b.spring(b.tap(fast), b.tap(slow), 200.0, 0.01);
  b.hear(fast[0].mat);
  b.hearAxes(b.scene.lias.back().a, 0);
  Player player(b.scene, {kRate, 14});
  player.tick();
  const double start = energiesOf(player).stored;
  player.ticks(2000);
  const Energies energies = energiesOf(player);
  EXPECT_LT(std::abs(energies.residual), 1e-11 * start);
  EXPECT_GT(energies.couplings[0].dissipated, 0.0);
  EXPECT_LT(energies.stored, start);
}

TEST(TapTest, SleepsWithItsSectionAndWakesIt) {
  SceneBuilder b;
  b.scene.sections[0].sleep_energy = 1e-9;
  Shares shares;
  for (int i = 0; i < 3; ++i) {
    shares.push_back({b.cell(1e-3, 50.0, 0.05, 1e-3 * i), 1.0 - i});
  }
  const int tap = b.tap(shares);
  b.push(tap);
  b.hear(tap);
  Player player(b.scene, {kRate, 10});
  player.ticks(3000);
  EXPECT_EQ(player.heard[0].back(), 0.0) << "asleep";
  player.inputs.assign(player.inputs.size(), 1.0);
  player.ticks(10);
  EXPECT_NE(player.heard[0].back(), 0.0);
}

TEST(TapTest, OfAllOfAStringIsItsMean) {
  SceneBuilder b;
  const int first = b.chain(40, 1e-3, 2e3, 0.01);
  Shares shares;
  for (int m = first; m < first + 42; ++m) {
    b.scene.mats[at(m)].position.x() =
        m == first || m == first + 41 ? 0.0 : 1e-3 * std::sin(0.3 * m);
    shares.push_back({m, 1.0 / 42.0});
    b.hear(m);
    b.scene.outputs.back().gain = {1.0 / 42.0};
  }
  b.hear(b.tap(shares), 1);
  Player player(b.scene, {kRate, 10});
  player.ticks(200);
  for (std::size_t n = 0; n < player.heard[0].size(); ++n) {
    ASSERT_NEAR(player.heard[1][n], player.heard[0][n], 1e-17) << n;
  }
}

}  // namespace
}  // namespace ergotic::physics
