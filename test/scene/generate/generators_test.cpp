// SPDX-License-Identifier: BSD-3-Clause

#include <Eigen/Eigenvalues>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/generate/string.hpp"
#include "support/test.hpp"

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

TEST(StringGeneratorTest, LinksWithARestLengthMayBeEnergyStable) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {a: {geometry: plane}}\ngenerators:\n"
      "  - {type: string, name: s, masses: 2, mass: 1, stiffness: 1, to: [1, 0],\n"
      "     rest_length_ratio: 0.5, scheme: energy_stable}\n"
      "  - {type: mesh, name: m, rows: 3, columns: 3, spacing: 1, mass: 1, stiffness: 1,\n"
      "     rest_length_ratio: 0.5, scheme: energy_stable}\n",
      "s.yaml");
  for (const Lia& lia : s.lias) {
    EXPECT_EQ(lia.scheme, Scheme::kEnergyStable) << lia.name;
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

TEST(ChapletGeneratorTest, AttachesTwoTunedMassesToItsCarrier) {
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

Scene generate(const std::string& geometry, const std::string& fields) {
  return readYaml("ergotic: 1\nsections: {a: {geometry: " + geometry +
                      "}}\nmats: {m: {type: mass, mass: 1}}\ngenerators:\n"
                      "  - {name: n, mass: 0.1, stiffness: 5, damping: 0.2, " +
                      fields + "}\n",
                  "mesh.yaml");
}

int grounds(const Scene& scene) {
  int count = 0;
  for (const Mat& mat : scene.mats) {
    count += mat.type == MatType::kGround ? 1 : 0;
  }
  return count;
}

TEST(MeshGeneratorTest, MakesRowsAndColumnsOfAGrid) {
  const Scene s = generate(
      "scalar", "type: mesh, rows: 3, columns: 4, spacing: 0.5, at: [10, 20], edges: free");
  ASSERT_EQ(s.mats.size(), 1U + 12U);
  for (int i = 0; i < 12; ++i) {
    const Mat& mat = s.mats[static_cast<std::size_t>(1 + i)];
    EXPECT_EQ(mat.name, "n." + std::to_string(i / 4) + "." + std::to_string(i % 4));
    EXPECT_EQ(mat.type, MatType::kMass);
    EXPECT_EQ(mat.mass.factor, 0.1);
    EXPECT_EQ(mat.rest.x(), 0.0);
    EXPECT_EQ(mat.rest.y(), 10.0 + 0.5 * (i % 4));
    EXPECT_EQ(mat.rest.z(), 20.0 + 0.5 * (i / 4));
    EXPECT_EQ(mat.position.norm(), 0.0);
  }
  ASSERT_EQ(s.grids.size(), 1U);
  EXPECT_EQ(s.grids[0].name, "n");
  EXPECT_EQ(s.grids[0].first, 1);
  EXPECT_EQ(s.grids[0].columns, 4);
  EXPECT_EQ(s.grids[0].rows, 3);
  EXPECT_TRUE(s.strings.empty());
}

TEST(MeshGeneratorTest, JoinsNeighboursOnceInOrder) {
  const Scene s = generate("scalar", "type: mesh, rows: 2, columns: 3, spacing: 1, edges: free");
  const int pairs[][2] = {{0, 1}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {4, 5}};
  ASSERT_EQ(s.lias.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(s.lias[i].name, "n.link." + std::to_string(i));
    EXPECT_EQ(s.lias[i].a, 1 + pairs[i][0]);
    EXPECT_EQ(s.lias[i].b, 1 + pairs[i][1]);
    EXPECT_EQ(s.lias[i].stiffness.factor, 5.0);
    EXPECT_EQ(s.lias[i].damping.factor, 0.2);
    EXPECT_EQ(s.lias[i].rest_length, 0.0);
  }
}

TEST(MeshGeneratorTest, EightNeighboursAddBothDiagonalsWithAQuarterOfTheStiffness) {
  const std::string fields =
      "type: mesh, rows: 2, columns: 2, spacing: 1, edges: free, neighbours: 8";
  const Scene s = generate("scalar", fields);
  ASSERT_EQ(s.lias.size(), 6U);
  const int pairs[][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 3}, {1, 2}, {2, 3}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(s.lias[i].a, 1 + pairs[i][0]);
    EXPECT_EQ(s.lias[i].b, 1 + pairs[i][1]);
    EXPECT_EQ(s.lias[i].stiffness.factor, i == 2 || i == 4 ? 1.25 : 5.0);
  }
  const Scene stiff = generate("scalar", fields + ", diagonal_stiffness: 7");
  EXPECT_EQ(stiff.lias[2].stiffness.factor, 7.0);
}

TEST(MeshGeneratorTest, EdgesHoldAllAroundOrTheCornersOrNothing) {
  const std::string fields = "type: mesh, rows: 4, columns: 5, spacing: 1";
  const Scene fixed = generate("scalar", fields);
  EXPECT_EQ(grounds(fixed), 20 - 2 * 3);
  EXPECT_EQ(fixed.lias.size(), 7U + 2U * 5U);  // inside, and from each side to the inside
  EXPECT_EQ(grounds(generate("scalar", fields + ", edges: free")), 0);
  const Scene corners = generate("scalar", fields + ", edges: corners");
  EXPECT_EQ(grounds(corners), 4);
  for (const int i : {0, 4, 15, 19}) {
    EXPECT_EQ(corners.mats[static_cast<std::size_t>(1 + i)].type, MatType::kGround);
  }
}

TEST(MeshGeneratorTest, InEuclideanSectionsLiesInTheCoordinatesAndKeepsItsRestLengths) {
  for (const std::string geometry : {"plane", "space"}) {
    const Scene s =
        generate(geometry, std::string("type: mesh, rows: 2, columns: 2, spacing: 0.5, ") +
                               "neighbours: 8, edges: free, rest_length_ratio: 0.8, " +
                               (geometry == "plane" ? "at: [1, 2]" : "at: [1, 2, 3]"));
    const Mat& last = s.mats.back();
    EXPECT_EQ(last.rest, Eigen::Vector3d(1.5, 2.5, geometry == "plane" ? 0.0 : 3.0));
    EXPECT_EQ(last.position, last.rest);
    EXPECT_NEAR(s.lias[0].rest_length, 0.4, 1e-15);
    EXPECT_NEAR(s.lias[1].rest_length, 0.4, 1e-15);
    EXPECT_NEAR(s.lias[2].rest_length, 0.4 * std::sqrt(2.0), 1e-15);
  }
}

TEST(StringGeneratorTest, InAPlaneLiesOnItsWayAndIsPluckedAlongY) {
  const Scene s = generate("plane",
                           "type: string, masses: 3, from: [1, 1], to: [5, 4], "
                           "rest_length_ratio: 0.6, pluck: {at: 0.5, height: 0.004}");
  ASSERT_EQ(s.mats.size(), 1U + 5U);
  EXPECT_EQ(s.mats[3].rest, Eigen::Vector3d(3.0, 2.5, 0.0));
  EXPECT_EQ(s.mats[3].position, Eigen::Vector3d(3.0, 2.504, 0.0));
  EXPECT_NEAR(s.mats[2].position.y(), 1.75 + 0.002, 1e-15);
  EXPECT_EQ(s.mats[5].position, Eigen::Vector3d(5.0, 4.0, 0.0));
  for (const Lia& lia : s.lias) {
    EXPECT_NEAR(lia.rest_length, 0.6 * 1.25, 1e-15);
  }
  ASSERT_EQ(s.grids.size(), 1U);
  EXPECT_EQ(s.grids[0].columns, 5);
  EXPECT_EQ(s.grids[0].rows, 1);
}

TEST(StringGeneratorTest, InALineTheWorkbenchDoesNotCountAsLength) {
  const Scene s = generate("line",
                           "type: string, masses: 1, from: [0, 0, 0], to: [2, 7, 7], "
                           "rest_length_ratio: 0.5, pluck: {at: 0.5, height: 0.1}");
  EXPECT_EQ(s.mats[2].rest, Eigen::Vector3d(1.0, 3.5, 3.5));
  EXPECT_EQ(s.mats[2].position, Eigen::Vector3d(1.1, 0.0, 0.0));
  EXPECT_NEAR(s.lias[0].rest_length, 0.5, 1e-15);
}

}  // namespace
}  // namespace ergotic::scene
