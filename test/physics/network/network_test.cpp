// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network.hpp"

#include "physics/network/load_matrix.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A point on a string of three masses between two grounds.
int addPoint(SceneBuilder& b, int string, const scene::Value& along) {
  const int point = b.point(b.grid(string, 5), 0.0);
  b.scene.connections.back().along.at = along;
  return point;
}

TEST(NetworkTest, GroundsHoldAndTheMediumDampsWhatIsFree) {
  SceneBuilder b;
  const int ground = b.ground();
  const int mass = b.mass(0.5);
  b.scene.parameters.push_back({"air", 3.0, 1.0, 4.0, {}});
  b.scene.sections[0].medium = {2.0, 0};
  const Network network(b.scene);
  const Network::Node& node = network.nodes[at(mass)];
  EXPECT_TRUE(sharesNow(network, ground).empty());
  EXPECT_FALSE(network.nodes[at(ground)].is_free);
  EXPECT_EQ(sharesNow(network, mass).size(), 1U);
  EXPECT_EQ(node.damping.now, 6.0);
  EXPECT_EQ(node.damping.range.lowest, 2.0);
  EXPECT_EQ(node.damping.range.highest, 8.0);
  EXPECT_TRUE(node.is_matched);
}

TEST(NetworkTest, PointLiesBetweenItsModulesAndMayReachAllOfItsRange) {
  SceneBuilder b;
  const int string = b.chain(3, 1e-4, 1000.0);
  b.scene.parameters.push_back({"place", 0.375, 0.3, 0.6, {}});
  const int point = addPoint(b, string, {1.0, 0});
  const Network network(b.scene);
  const Shares now = sharesNow(network, point);
  ASSERT_EQ(now.size(), 2U);
  EXPECT_EQ(now[0].node, string + 1);
  EXPECT_DOUBLE_EQ(now[0].weight, 0.5);
  EXPECT_EQ(now[1].node, string + 2);
  EXPECT_EQ(placesOf(network, point).size(), 3U);  // the lines at 0.25, 0.5, 0.75 of the string
}

TEST(NetworkTest, SlopesAtRestAndAtLeastTellWhatLinksAreSureToDo) {
  SceneBuilder b;
  const int a = b.mass(1.0);
  const int c = b.mass(1.0);
  for (const LiaType type : {LiaType::kSpringDamper, LiaType::kCubic, LiaType::kContact}) {
    b.link(type, a, c, 100.0);
  }
  b.scene.lias[1].law.edit().nonlinearity = {-1.0};
  const Network network(b.scene);
  EXPECT_EQ(network.links[0].at_rest, 100.0);
  EXPECT_EQ(network.links[0].at_least, 100.0);
  EXPECT_EQ(network.links[1].at_rest, 100.0);
  EXPECT_EQ(network.links[1].at_least, 0.0);  // softer the further it is stretched
  EXPECT_EQ(network.links[2].at_rest, 0.0);
  EXPECT_EQ(network.links[2].at_least, 0.0);
  EXPECT_EQ(network.links[2].slopes.stiffness.highest, 100.0);
}

TEST(NetworkTest, LoadsOfAChainAreItsStiffness) {
  SceneBuilder b;
  const int string = b.chain(2, 1.0, 10.0);
  const Network network(b.scene);
  std::vector<int> row_of(network.nodes.size(), -1);
  row_of[static_cast<std::size_t>(string + 1)] = 0;
  row_of[static_cast<std::size_t>(string + 2)] = 1;
  LoadMatrix stiffness(2);
  for (const Network::Link& link : network.links) {
    stiffness.addLoad(endsAmong(network, row_of, link), [&link](const Share& x, const Share& y) {
      return link.at_rest * x.weight * y.weight;
    });
  }
  const Eigen::MatrixXd sum(stiffness.sum());
  EXPECT_EQ(sum, (Eigen::Matrix2d() << 20.0, -10.0, -10.0, 20.0).finished());
}

}  // namespace
}  // namespace ergotic::physics
