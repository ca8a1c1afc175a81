// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>

#include "advice/mode_scenes.hpp"

namespace ergotic::physics {
namespace {

TEST(ModesTest, OfAChainAreThoseOfTheClosedForm) {
  for (const int masses : {1, 2, 60, 2000}) {  // the last by shift and invert
    std::vector<double> hz;
    for (int j = 1; j <= masses; ++j) {
      hz.push_back(hertz(0.9 * hinged(j, masses)));
    }
    const SceneModes found = modesOf(chainOf(masses, 0.9), lowest(60));
    EXPECT_EQ(found.modes.size(), at(std::min(masses, 60)));
    EXPECT_EQ(found.counted, masses);
    EXPECT_TRUE(found.rigid.empty());
    expectFrequencies(found, hz, 1e-9);
    EXPECT_TRUE(std::isinf(found.modes.front().t60_s));
  }
}

TEST(ModesTest, OfAWindowAreAllThatAreInIt) {
  constexpr int kMasses = 1500;
  ModeWindow window{3000.0, 3100.0, 500};
  std::vector<double> hz;
  for (int j = 1; j <= kMasses; ++j) {
    const double one = hertz(0.9 * hinged(j, kMasses));
    if (one >= window.from_hz && one <= window.to_hz) {
      hz.push_back(one);
    }
  }
  const SceneModes found = modesOf(chainOf(kMasses, 0.9), window);
  ASSERT_GT(hz.size(), 5U);
  EXPECT_EQ(found.counted, static_cast<int>(hz.size()));
  EXPECT_EQ(found.modes.size(), hz.size());
  expectFrequencies(found, hz, 1e-9);
  window.from_hz = 2.0 * kRate;  // nothing can
  EXPECT_TRUE(modesOf(chainOf(3, 0.9), window).modes.empty());
}

TEST(ModesTest, DecayAsDampersThatFollowTheSpringsSay) {
  constexpr int kMasses = 400;
  const SceneModes found = modesOf(chainOf(kMasses, 0.5, 1e-3), lowest(30));
  for (int j = 1; j <= 30; ++j) {
    const double kappa = 0.5 * hinged(j, kMasses);
    const double zeta = 1e-3 * hinged(j, kMasses);
    const double angle = std::acos((2.0 - kappa - zeta) / (2.0 * std::sqrt(1.0 - zeta)));
    const SceneMode& mode = found.modes[at(j - 1)];
    EXPECT_NEAR(mode.frequency_hz, angle / (2.0 * kPi) * kRate, 1e-8 * mode.frequency_hz);
    const double t60 = -2.0 * std::log(1000.0) / (std::log1p(-zeta) * kRate);
    EXPECT_NEAR(mode.t60_s, t60, 1e-8 * t60);
    EXPECT_EQ(mode.error, 0.0);
  }
}

TEST(ModesTest, OfAHingedBarAreThoseOfTheClosedForm) {
  std::vector<double> hz;
  for (int j = 1; j <= 40; ++j) {
    const double s = hinged(j, 40);
    hz.push_back(hertz(0.2 * s * s));
  }
  expectFrequencies(
      modesOf(read(Bars(0.2).bar(40, Bars::Edge::kHinged, Bars::Edge::kHinged)), lowest(40)), hz,
      1e-9);
}

/// Equal pitches by the dozen: (i, j) and (j, i).
TEST(ModesTest, OfAHingedPlateAreFoundInPairs) {
  for (const int side : {9, 25}) {
    std::vector<double> hz;
    for (int i = 1; i <= side; ++i) {
      for (int j = 1; j <= side; ++j) {
        const double s = hinged(i, side) + hinged(j, side);
        hz.push_back(hertz(0.06 * s * s));
      }
    }
    const SceneModes found = modesOf(read(Bars(0.06).supportedPlate(side)), lowest(75));
    EXPECT_EQ(found.modes.size(), 75U);
    EXPECT_EQ(found.counted, side * side);
    expectFrequencies(found, hz, 1e-9);
  }
}

TEST(ModesTest, OfAFreeBarAreTwoMotionsAsAWholeAndNoFalseFrequency) {
  for (const int masses : {12, 400}) {
    const scene::Scene scene = read(Bars(0.2).bar(masses, Bars::Edge::kFree, Bars::Edge::kFree));
    const SceneModes found = modesOf(scene, lowest(8));
    ASSERT_EQ(found.rigid.size(), 1U);
    EXPECT_EQ(found.rigid[0].count, 2);
    EXPECT_EQ(found.counted, masses - 2);
    // The bending waves of the net: cosh p = 2 - cos t, cos(t s1) cosh(p s2) = cos(t s2) cosh(p
    // s1), of which the quotient is taken.
    const double s1 = 0.5 * (masses - 1);
    const double s2 = 0.5 * (masses + 1);
    const auto even = [&](double t) {
      const double p = std::acosh(2.0 - std::cos(t));
      return std::cos(t * s1) - std::cos(t * s2) * std::cosh(p * s1) / std::cosh(p * s2);
    };
    double low = 4.5 / masses;
    double high = 5.0 / masses;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (even(low) * even(middle) <= 0.0 ? high : low) = middle;
    }
    const double s = 4.0 * std::pow(std::sin(0.5 * low), 2);
    const double hz = hertz(0.2 * s * s);
    EXPECT_NEAR(found.modes[0].frequency_hz, hz, (masses > 100 ? 1e-6 : 1e-9) * hz) << masses;
  }
}

TEST(ModesTest, OfWhatFloatsInSpaceAreSixMotionsAsAWhole) {
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kSpace;
  std::vector<int> corners;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.3, 0.9, 0),
        Eigen::Vector3d(0.4, 0.3, 0.8)}) {
    corners.push_back(b.mass(1e-3));
    b.scene.mats[at(corners.back())].rest = place;
    b.scene.mats[at(corners.back())].position = place;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int l = b.spring(corners[i], corners[j], 1e4);
      b.scene.lias[at(l)].rest_length =
          (b.scene.mats[at(corners[i])].rest - b.scene.mats[at(corners[j])].rest).norm();
    }
  }
  const SceneModes found = modesOf(b.scene);
  ASSERT_EQ(found.rigid.size(), 1U);
  EXPECT_EQ(found.rigid[0].count, 6);
  EXPECT_EQ(found.modes.size(), 6U);
  EXPECT_GT(found.modes[0].frequency_hz, 100.0);
}

TEST(ModesTest, OfAStretchedStringInSpaceAreEqualAcrossItAndHighAlongIt) {
  constexpr int kMasses = 120;
  constexpr double kPart = 0.95;  // rest length of its length
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kSpace;
  int last = -1;
  for (int i = 0; i <= kMasses + 1; ++i) {
    const int next = i == 0 || i > kMasses ? b.ground() : b.mass(1e-3);
    b.scene.mats[at(next)].rest = {0.0, 0.01 * i, 0.0};
    b.scene.mats[at(next)].position = b.scene.mats[at(next)].rest;
    if (last >= 0) {
      const int l = b.spring(last, next, 0.9e-3 * kRate * kRate);
      b.scene.lias[at(l)].rest_length = 0.01 * kPart;
    }
    last = next;
  }
  std::vector<double> hz;
  for (int j = 1; j <= kMasses; ++j) {
    hz.push_back(hertz(0.9 * hinged(j, kMasses)));
    for (const int axis : {0, 1}) {
      (void)axis;
      hz.push_back(hertz(0.9 * (1.0 - kPart) * hinged(j, kMasses)));
    }
  }
  expectFrequencies(modesOf(b.scene, lowest(40)), hz, 1e-8);
}

/// Two strings of one pitch that nothing joins, and that one bridge joins.
TEST(ModesTest, OfTwoStringsInUnisonAreAllTold) {
  SceneBuilder b;
  const double k = 0.9e-3 * kRate * kRate;
  b.chain(350, 1e-3, k);
  b.chain(350, 1e-3, k);
  const SceneModes apart = modesOf(b.scene, lowest(20));
  for (std::size_t i = 0; i < 20; i += 2) {
    const double hz = hertz(0.9 * hinged(static_cast<int>(i / 2) + 1, 350));
    EXPECT_NEAR(apart.modes[i].frequency_hz, hz, 1e-9 * hz);
    EXPECT_NEAR(apart.modes[i + 1].frequency_hz, hz, 1e-9 * hz);
  }
  // On a mass between them: those that leave it still are those of a string, the others are lower.
  SceneBuilder joined;
  const int first = joined.chain(200, 1e-3, k);
  const int second = joined.chain(200, 1e-3, k);
  const int bridge = joined.mass(0.5);
  for (scene::Lia& lia : joined.scene.lias) {
    for (int* end : {&lia.a, &lia.b}) {
      *end = *end == first || *end == second ? bridge : *end;
    }
  }
  joined.spring(bridge, joined.ground(), 1e5);
  const SceneModes found = modesOf(joined.scene, lowest(30));
  int still = 0;
  for (const SceneMode& mode : found.modes) {
    for (int j = 1; j <= 20; ++j) {
      const double hz = hertz(0.9 * hinged(j, 200));
      still += std::abs(mode.frequency_hz - hz) < 1e-9 * hz ? 1 : 0;
    }
  }
  EXPECT_GE(still, 14);
  EXPECT_EQ(found.counted, 401);
}

TEST(ModesTest, OfSevenThousandModulesTakeSeconds) {
  constexpr int kSide = 39;
  const scene::Scene scene = read(Bars(0.05).freePlate(kSide, 0.3));
  EXPECT_GT(scene.mats.size() + scene.bends.size(), 7000U);
  const SceneModes found = modesOf(scene, lowest(20));
  EXPECT_EQ(found.rigid.at(0).count, 3);
  EXPECT_EQ(found.counted, kSide * kSide - 3);
  // lambda = 13.468, 19.596, 24.270, 34.801, 34.801 of the continuous plate of nu = 0.3.
  const double ratios[] = {1.0, 19.596 / 13.468, 24.270 / 13.468, 34.801 / 13.468, 34.801 / 13.468};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(test::cents(found.modes[i].frequency_hz / found.modes[0].frequency_hz, ratios[i]),
                0.0, 8.0);
  }
  EXPECT_NEAR(found.modes[3].frequency_hz, found.modes[4].frequency_hz,
              1e-9 * found.modes[4].frequency_hz);
}

/// Nets without any order, by shift and invert, beside the eigenvalues of the whole matrix.
TEST(ModesTest, OfRandomNetsAreThoseOfTheWholeMatrix) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    SceneBuilder b;
    Nets nets(b);
    nets.random.seed(seed);
    nets.zeta = 0.0;
    nets.kappa = 0.01;  // stable, whatever comes together
    nets.scatter = seed % 2 == 0 ? 0.9 : 0.0;
    nets.triangles(23);
    const scene::Scene settled = settle(b.scene, kRates).scene;
    const std::vector<double> all = test::BodyPoles(settled, kRate).eigenvalues();
    std::vector<double> hz;
    for (const double lambda : all) {
      if (lambda > 1e-12) {
        hz.push_back(hertz(lambda));
      }
    }
    ASSERT_GT(hz.size(), 300U);
    const SceneModes low = modesOf(b.scene, lowest(40));
    EXPECT_EQ(low.counted, static_cast<int>(hz.size()));
    ASSERT_EQ(low.modes.size(), 40U);
    expectFrequencies(low, hz, 1e-8);
    const double from = 0.5 * (hz[200] + hz[201]);
    const double to = 0.5 * (hz[260] + hz[261]);
    const SceneModes middle = modesOf(b.scene, {from, to, 100});
    EXPECT_EQ(middle.counted, 60);
    ASSERT_EQ(middle.modes.size(), 60U);
    expectFrequencies(middle, {hz.begin() + 201, hz.begin() + 261}, 1e-8);
  }
}

TEST(ModesTest, OfASquareMembraneOfThousandsOfMassesAreFoundAsOftenAsTheyAre) {
  constexpr int kSide = 60;
  SceneBuilder b;
  Nets nets(b);
  nets.kappa = 0.2;
  nets.zeta = 0.0;
  nets.plate(kSide + 2, kSide + 2, false, true);
  std::vector<double> hz;
  for (int i = 1; i <= kSide; ++i) {
    for (int j = 1; j <= kSide; ++j) {
      hz.push_back(hertz(0.2 * (hinged(i, kSide) + hinged(j, kSide))));
    }
  }
  const SceneModes found = modesOf(b.scene, lowest(100));
  EXPECT_EQ(found.counted, kSide * kSide);
  EXPECT_EQ(found.modes.size(), 100U);
  expectFrequencies(found, hz, 1e-8);
}

/// A net in space that nothing stretches gives way across itself everywhere.
TEST(ModesTest, OfASlackNetAreCountedApartFromWhatRings) {
  constexpr int kSide = 20;
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kSpace;
  Nets nets(b);
  nets.kappa = 0.2;
  nets.zeta = 0.0;
  const int first = nets.plate(kSide + 2, kSide + 2, true, true);
  for (int i = 0; i < (kSide + 2) * (kSide + 2); ++i) {
    scene::Mat& mat = b.scene.mats[at(first + i)];
    mat.rest = {0.01 * (i / (kSide + 2)), 0.01 * (i % (kSide + 2)), 0.0};
    mat.position = mat.rest;
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = (b.scene.mats[at(lia.a)].rest - b.scene.mats[at(lia.b)].rest).norm();
  }
  const SceneModes found = modesOf(b.scene, lowest(10));
  ASSERT_EQ(found.rigid.size(), 1U);
  EXPECT_EQ(found.rigid[0].count, kSide * kSide);
  EXPECT_EQ(found.counted, 2 * kSide * kSide);
  ASSERT_EQ(found.modes.size(), 10U);
  EXPECT_GT(found.modes[0].frequency_hz, 100.0);
}

}  // namespace
}  // namespace ergotic::physics
