// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "scene/generate/string.hpp"

namespace ergotic::scene {
namespace {

Scene generate(const std::string& list) {
  return readYaml(
      "ergotic: 1\ngestural_rate: 3000\nparameters: {p: {value: 2, range: [1, 3]}}\n"
      "sections: {a: {gravity: -9.81}, h: {rate: gestural}}\n"
      "mats: {key: {type: slice, section: h, at: [0.3, 0.4], rest: 0.02}}\n"
      "ports: {k: {mat: key, slice: 0}}\ngenerators:\n" +
          list,
      "generated.yaml");
}

TEST(StringGeneratorTest, FundamentalIsTheSmallestEigenvalueOfTheString) {
  constexpr int kMasses = 7;
  const double stiffness = stringStiffness(kMasses, Value{0.002}, 220.0).factor;
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(kMasses, kMasses);
  for (int i = 0; i < kMasses; ++i) {
    chain(i, i) = 2.0 * stiffness / 0.002;
    if (i > 0) {
      chain(i, i - 1) = chain(i - 1, i) = -stiffness / 0.002;
    }
  }
  const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(chain).eigenvalues()(0);
  EXPECT_NEAR(std::sqrt(lowest) / (2.0 * M_PI), 220.0, 1e-9);
}

TEST(StringGeneratorTest, MakesMassesBetweenTwoGroundsJoinedInOrder) {
  const Scene s = generate(
      "  - {type: string, name: s, section: a, masses: 3, mass: 0.1, stiffness: 5, damping: 0.2,\n"
      "     from: [1, 2], to: [5, 10]}\n");
  ASSERT_EQ(s.mats.size(), 1U + 5U);
  ASSERT_EQ(s.lias.size(), 4U);
  for (int i = 0; i < 5; ++i) {
    const Mat& mat = s.mats[static_cast<std::size_t>(1 + i)];
    EXPECT_EQ(mat.name, "s." + std::to_string(i));
    EXPECT_EQ(mat.type, i == 0 || i == 4 ? MatType::kGround : MatType::kMass);
    EXPECT_EQ(mat.section, 0);
    EXPECT_DOUBLE_EQ(mat.rest.y(), 1.0 + i);
    EXPECT_DOUBLE_EQ(mat.rest.z(), 2.0 + 2.0 * i);
    EXPECT_EQ(mat.position.x(), 0.0);
    EXPECT_EQ(mat.place.line, 8);
  }
  EXPECT_EQ(s.mats[2].mass.factor, 0.1);
  for (int i = 0; i < 4; ++i) {
    const Lia& lia = s.lias[static_cast<std::size_t>(i)];
    EXPECT_EQ(lia.name, "s.link." + std::to_string(i));
    EXPECT_EQ(lia.type, LiaType::kSpringDamper);
    EXPECT_EQ(lia.a, 1 + i);
    EXPECT_EQ(lia.b, 2 + i);
    EXPECT_EQ(lia.stiffness.factor, 5.0);
    EXPECT_EQ(lia.damping.factor, 0.2);
  }
  ASSERT_EQ(s.strings.size(), 1U);
  EXPECT_EQ(s.strings[0].first, 1);
  EXPECT_EQ(s.strings[0].count, 5);
  EXPECT_EQ(s.strings[0].loss.factor, 0.0);
}

TEST(StringGeneratorTest, LinksWithARestLengthMayBeGuarded) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {a: {geometry: plane}}\ngenerators:\n"
      "  - {type: string, name: s, masses: 2, mass: 1, stiffness: 1, to: [1, 0],\n"
      "     rest_length_ratio: 0.5, scheme: guarded}\n"
      "  - {type: mesh, name: m, rows: 3, columns: 3, spacing: 1, mass: 1, stiffness: 1,\n"
      "     rest_length_ratio: 0.5, scheme: guarded}\n",
      "s.yaml");
  for (const Lia& lia : s.lias) {
    EXPECT_EQ(lia.scheme, Scheme::kGuarded) << lia.name;
  }
}

TEST(StringGeneratorTest, LossMakesCellsWithoutStiffness) {
  const Scene s = generate(
      "  - {type: string, name: s, section: a, masses: 1, mass: 3*$p, frequency: 10, loss: $p,\n"
      "     to: [1, 0]}\n");
  EXPECT_EQ(s.mats[2].type, MatType::kCell);
  EXPECT_EQ(s.mats[2].stiffness.factor, 0.0);
  EXPECT_EQ(s.mats[2].damping.parameter, 0);
  EXPECT_EQ(s.mats[2].damping.factor, 1.0);
  EXPECT_EQ(s.mats[2].mass.factor, 3.0);
  // The stiffness follows the mass, so that the frequency stays.
  EXPECT_EQ(s.lias[0].stiffness.parameter, 0);
  EXPECT_NEAR(s.lias[0].stiffness.factor, 3.0 * 2.0 * std::pow(M_PI * 10.0, 2), 1e-9);
  EXPECT_EQ(s.strings[0].loss.parameter, 0);
}

TEST(StringGeneratorTest, PluckIsATriangleWithItsTopWhereItIsHeld) {
  const Scene s = generate(
      "  - {type: string, name: s, section: a, masses: 3, mass: 1, stiffness: 1, to: [1, 0],\n"
      "     pluck: {at: 0.25, height: 0.004}}\n");
  const double expected[] = {0.0, 0.004, 0.004 * 2 / 3, 0.004 / 3, 0.0};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(s.mats[1 + i].position.x(), expected[i], 1e-15);
    EXPECT_EQ(s.mats[1 + i].rest.x(), 0.0);
  }
}

TEST(StringGeneratorTest, TwoHundredThousandMassesComeOutWholeAndInOrder) {
  const Scene s = generate(
      "  - {type: string, name: s, section: a, masses: 200000, mass: 1, stiffness: 1, to: [1, 0]}\n"
      "lias: {l: {type: spring, between: [s.123456, s.200001], stiffness: 1}}\n");
  ASSERT_EQ(s.mats.size(), 200003U);
  ASSERT_EQ(s.lias.size(), 200002U);
  EXPECT_EQ(s.lias.back().a, 1 + 123456);
  EXPECT_EQ(s.mats.back().name, "s.200001");
}

TEST(ChapletGeneratorTest, HangsTwoTunedMassesOntoItsCarrier) {
  const Scene s = generate("  - {type: chaplet, name: c, section: a, from: key, mass: 0.002}\n");
  ASSERT_EQ(s.mats.size(), 3U);
  ASSERT_EQ(s.lias.size(), 2U);
  const double wn = M_PI * 3000.0;
  EXPECT_EQ(s.mats[1].name, "c.0");
  EXPECT_EQ(s.mats[2].name, "c.1");
  EXPECT_NEAR(s.mats[1].mass.factor, 0.4475 * 0.002, 1e-15);
  EXPECT_NEAR(s.mats[2].mass.factor, 0.5525 * 0.002, 1e-15);
  EXPECT_EQ(s.lias[0].name, "c.link.0");
  EXPECT_EQ(s.lias[0].a, 0);
  EXPECT_EQ(s.lias[0].b, 1);
  EXPECT_EQ(s.lias[1].a, 1);
  EXPECT_EQ(s.lias[1].b, 2);
  EXPECT_NEAR(s.lias[0].stiffness.factor, 0.0083 * 0.002 * wn * wn, 1e-9);
  EXPECT_NEAR(s.lias[1].stiffness.factor, 0.0705 * 0.002 * wn * wn, 1e-9);
  EXPECT_NEAR(s.lias[0].damping.factor, 0.2237 * 0.002 * wn, 1e-12);
  EXPECT_EQ(s.lias[1].damping.factor, 0.0);
}

TEST(ChapletGeneratorTest, StartsUnstretchedWhereItsCarrierIs) {
  const Scene s = generate("  - {type: chaplet, name: c, section: a, from: key, mass: 0.002}\n");
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ(s.mats[i].position.x(), 0.02);
    EXPECT_EQ(s.mats[i].rest.x(), 0.02);
    EXPECT_EQ(s.mats[i].rest.y(), 0.3);
    EXPECT_EQ(s.mats[i].rest.z(), 0.4);
  }
}

TEST(ChapletGeneratorTest, IsTunedToTheGesturalRateThatIsAskedForFromOutside) {
  const std::string text =
      "ergotic: 1\ngestural_rate: 3000\nsections: {a: {}}\nmats: {m: {type: mass, mass: 1}}\n"
      "generators: [{type: chaplet, name: c, from: m, mass: 0.002}]\n";
  const Scene slow = readYaml(text, "c.yaml");
  const Scene fast = readYaml(text, "c.yaml", {{"gestural_rate", 6000.0}});
  EXPECT_NEAR(fast.lias[0].stiffness.factor, 4.0 * slow.lias[0].stiffness.factor, 1e-9);
  EXPECT_NEAR(fast.lias[0].damping.factor, 2.0 * slow.lias[0].damping.factor, 1e-12);
}

}  // namespace
}  // namespace ergotic::scene
