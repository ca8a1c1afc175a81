// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {
namespace {

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

TEST(MeshGeneratorTest, EightNeighboursAddBothDiagonalsWithHalfTheStiffness) {
  const std::string fields =
      "type: mesh, rows: 2, columns: 2, spacing: 1, edges: free, neighbours: 8";
  const Scene s = generate("scalar", fields);
  ASSERT_EQ(s.lias.size(), 6U);
  const int pairs[][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 3}, {1, 2}, {2, 3}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(s.lias[i].a, 1 + pairs[i][0]);
    EXPECT_EQ(s.lias[i].b, 1 + pairs[i][1]);
    EXPECT_EQ(s.lias[i].stiffness.factor, i == 2 || i == 4 ? 2.5 : 5.0);
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
