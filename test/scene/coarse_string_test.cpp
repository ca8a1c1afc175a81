// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/coarse_string.hpp"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {
namespace {

/// Stiffness matrix of the moving masses with the given springs.
Eigen::MatrixXd stiffnessOf(int masses, const std::array<double, 3>& k) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(masses + 2, masses + 2);
  for (int i = 0; i < coarseLinks(masses); ++i) {
    const CoarseLink link = coarseLink(masses, i);
    const double stiffness = link.stiffness(k);
    whole(link.a, link.a) += stiffness;
    whole(link.b, link.b) += stiffness;
    whole(link.a, link.b) -= stiffness;
    whole(link.b, link.a) -= stiffness;
  }
  return whole.block(1, 1, masses, masses);
}

TEST(CoarseStringTest, ModesAreSinesWithTheStiffnessOfTheClosedForm) {
  const std::array<double, 3> k{0.9, -0.2, 0.07};
  for (const int masses : {3, 4, 5, 20}) {
    const Eigen::MatrixXd stiffness = stiffnessOf(masses, k);
    for (int mode = 1; mode <= masses; ++mode) {
      const double t = mode * M_PI / (masses + 1);
      Eigen::VectorXd shape(masses);
      double expected = 0.0;
      for (int i = 0; i < masses; ++i) {
        shape[i] = std::sin(t * (i + 1));
      }
      for (int reach = 1; reach <= 3; ++reach) {
        expected +=
            4.0 * k[static_cast<std::size_t>(reach - 1)] * std::pow(std::sin(0.5 * reach * t), 2);
      }
      EXPECT_LT((stiffness * shape - expected * shape).norm(), 1e-13) << masses << " " << mode;
    }
  }
}

TEST(CoarseStringTest, GeneratorMakesTheLinksInTheirOrderStartingAsAnOrdinaryString) {
  const Scene scene = readYaml(
      "ergotic: 1\nsections: {a: {}}\nmats: {m: {type: mass, mass: 1}}\ngenerators:\n"
      "  - {type: string, name: t, masses: 2, mass: 1, stiffness: 1, to: [1, 0]}\n"
      "  - {type: string, name: s, masses: 5, mass: 0.001, frequency: 110, damping: 0.01,\n"
      "     coarse: true, to: [1, 0]}\n",
      "coarse.yaml");
  const StringInfo& string = scene.strings[1];
  EXPECT_EQ(string.corrected_hz, 110.0);
  EXPECT_EQ(string.first_lia, 3);
  ASSERT_EQ(scene.lias.size(), 3U + static_cast<std::size_t>(coarseLinks(5)));
  for (int i = 0; i < coarseLinks(5); ++i) {
    const Lia& lia = scene.lias[static_cast<std::size_t>(string.first_lia + i)];
    const CoarseLink link = coarseLink(5, i);
    EXPECT_EQ(lia.a, string.first + link.a);
    EXPECT_EQ(lia.b, string.first + link.b);
    EXPECT_EQ(lia.stiffness.factor, i < 6 ? string.stiffness.factor : 0.0) << i;
    EXPECT_EQ(lia.damping.factor, i < 6 ? 0.01 : 0.0) << i;
    EXPECT_EQ(link.weights[0], i < 6 ? 1.0 : 0.0) << i;
  }
}

}  // namespace
}  // namespace ergotic::scene
