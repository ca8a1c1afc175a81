// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/parameter_cases.hpp"

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

scene::Scene massOn(double mass, double stiffness, double loss) {
  SceneBuilder b;
  const int hung = b.mass(mass, 0.0);
  b.spring(hung, b.slice(0), stiffness);
  b.spring(hung, b.ground(), 0.0, loss);
  return b.scene;
}

TEST(ParameterCasesTest, AreThePresentBothEndsAndAsManyCombinationsAsAsked) {
  scene::Scene scene = massOn(1.0, 1.0, 1.0);
  EXPECT_EQ(parameterCases(scene, {0}, 27).size(), 1U);
  scene.parameters.push_back({"unused", 1.0, 1.0, 100.0, {}});
  EXPECT_EQ(parameterCases(scene, {0}, 27).size(), 3U);
  scene.parameters.push_back({"k", 1.0, 1.0, 100.0, {}});
  scene.lias.at(0).stiffness = {1.0, 1};
  EXPECT_EQ(parameterCases(scene, {0}, 3).size(), 3U + 3U);
  const std::vector<scene::Scene> cases = parameterCases(scene, {0}, 27);
  ASSERT_EQ(cases.size(), 3U + 9U);
  EXPECT_EQ(cases[1].parameters[1].value, 1.0);
  EXPECT_EQ(cases[2].parameters[1].value, 100.0);
  EXPECT_NEAR(cases[7].parameters[1].value, 10.0, 1e-12);
  scene.parameters.push_back({"z", 0.0, 0.0, 1.0, {}});
  scene.lias[1].damping = {1.0, 2};
  EXPECT_EQ(parameterCases(scene, {0}, 27).size(), 3U + 18U + 25U);
  EXPECT_EQ(parameterCases(scene, {0}, 27)[3 + 9 + 4].parameters[2].value, 0.5);
  EXPECT_EQ(parameterCases(scene, {0}, 27)[3 + 18 + 10].parameters[2].value, 0.5);
  EXPECT_EQ(parameterCases(scene, {0}, 4).size(), 3U + 4U);
  EXPECT_EQ(parameterCases(scene, {1}, 27).size(), 3U + 9U) << "the slice and its spring";
}

/// The worst is at one end of the one and the other of the other, or at neither.
TEST(ParameterCasesTest, WhatIsAttachedToASliceIsSeenBetweenTheEndsOfRanges) {
  const auto isWarned = [](const scene::Scene& scene) {
    return certify(scene, kRates).ports.at(0).level != HandLevel::kSilent;
  };
  ASSERT_TRUE(isWarned(massOn(0.1, 2000.0, 0.0)));
  scene::Scene two = massOn(0.1, 1.0, 1.0);
  two.parameters = {{"k", 1.0, 1.0, 2000.0, {}}, {"z", 5.0, 0.0, 5.0, {}}};
  two.lias.at(0).stiffness = {1.0, 0};
  two.lias.at(1).damping = {1.0, 1};
  EXPECT_TRUE(isWarned(two));
  scene::Scene weight = massOn(1.0, 2000.0, 0.0);
  EXPECT_FALSE(isWarned(massOn(1e-5, 2000.0, 0.0)) || isWarned(massOn(100.0, 2000.0, 0.0)));
  weight.parameters.push_back({"m", 1e-5, 1e-5, 100.0, {}});
  weight.mats.at(0).mass = {1.0, 0};
  EXPECT_TRUE(isWarned(weight));
}

/// What hangs elsewhere takes none of the values, with parameters of its own or many masses.
TEST(ParameterCasesTest, WhatIsAttachedElsewhereHidesNothing) {
  SceneBuilder b;
  const int hung = b.mass(1e-5, 0.0);
  b.spring(hung, b.slice(0), 2000.0);
  const int ground = b.ground();
  const int other = b.mass(0.01, 0.0);
  for (int i = 0; i < 3; ++i) {
    b.scene.parameters.push_back({std::string(1, static_cast<char>('a' + i)), 1.0, 1.0, 2.0, {}});
    b.spring(other, ground, 1.0);
    b.scene.lias.back().stiffness = {1.0, i};
  }
  int last = ground;
  for (int i = 0; i < 80; ++i) {
    const int next = b.mass(1e-3, 0.0);
    b.spring(next, last, 1e5);
    last = next;
  }
  b.spring(last, b.slice(1), 100.0);  // of another slice, too
  b.scene.parameters.push_back({"m", 1e-5, 1e-5, 100.0, {}});
  b.scene.mats.at(0).mass = {1.0, 3};
  EXPECT_NE(certify(b.scene, kRates).ports.at(0).level, HandLevel::kSilent);
}

/// Where it is at the start a ground holds what it could swing with.
TEST(ParameterCasesTest, LedPointsAreSeenWhereTheyMayBe) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int ground = b.ground();
  const int first = b.mass(1e-3, 0.0);
  for (int i = 1; i < 9; ++i) {
    b.spring(b.mass(1e-3, 0.0), first + i - 1, 2e4);
  }
  b.spring(first, ground, 2e4);
  b.spring(first + 8, ground, 2e4);
  b.spring(b.point(b.grid(ground, 10), 0.0), slice, 2000.0);
  EXPECT_EQ(certify(b.scene, kRates).ports.at(0).level, HandLevel::kSilent);
  b.scene.connections.at(0).along.guide = b.slice(1);
  b.scene.connections[0].along.scale = 1.0;
  EXPECT_EQ(certify(b.scene, kRates).ports.at(0).level, HandLevel::kWarned);
}

}  // namespace
}  // namespace ergotic::physics
