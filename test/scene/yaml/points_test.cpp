// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/points.hpp"

#include "ergotic/scene/grid.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "scene/generate/mesh.hpp"
#include "scene/generate/string.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kPointsHead =
    "ergotic: 1\nparameters: {finger: {value: 0.3, range: [0.1, 0.9]}}\n"
    "sections: {a: {}, p: {geometry: plane}, h: {rate: gestural}}\n"
    "generators:\n"
    "  - {type: string, name: s, section: a, masses: 9, mass: 1, stiffness: 1, to: [1, 0],\n"
    "     pluck: {at: 0.5, height: 0.01}}\n"
    "  - {type: mesh, name: net, section: p, rows: 3, columns: 5, spacing: 0.1, mass: 1,\n"
    "     stiffness: 1, at: [1, 2]}\n";

Scene pointScene(const std::string& fields) {
  return readYaml(kPointsHead + "mats:\n  k: {type: slice, section: h}\n  q: {type: point, " +
                      fields + "}\nports: {k: {mat: k, slice: 0}}\n",
                  "point.yaml");
}

TEST(GridPlaceTest, WeightsAddUpToOneAndTheirMeanIsThePlace) {
  const Grid net{"net", 10, 5, 3};
  for (const double along : {0.0, 0.1, 0.25, 0.6, 1.0}) {
    for (const double across : {0.0, 0.3, 0.5, 1.0}) {
      const GridPlace place = placeOn(net, along, across);
      ASSERT_EQ(place.count, 4);
      double sum = 0.0;
      double column = 0.0;
      double row = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        const int index = place.mats[i] - net.first;
        EXPECT_GE(place.weights[i], 0.0);
        EXPECT_LT(index, 15);
        sum += place.weights[i];
        column += place.weights[i] * (index % 5);
        row += place.weights[i] * (index / 5);
      }
      EXPECT_NEAR(sum, 1.0, 1e-15);
      EXPECT_NEAR(column, 4.0 * along, 1e-14);
      EXPECT_NEAR(row, 2.0 * across, 1e-14);
    }
  }
}

TEST(GridPlaceTest, OfNoNumberIsOnTheGridWithWeightsThatAreNone) {
  const double nowhere = std::nan("");
  const GridPlace string = placeOn({"s", 3, 4, 1}, nowhere, 0.5);
  EXPECT_THAT(string.mats, ElementsAre(3, 4, 3, 3));
  EXPECT_TRUE(std::isnan(string.weights[0]) && std::isnan(string.weights[1]));
  for (const auto& [along, across] : {std::pair(nowhere, 0.5), std::pair(0.5, nowhere)}) {
    const GridPlace net = placeOn({"net", 10, 5, 3}, along, across);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_TRUE(net.mats[i] >= 10 && net.mats[i] < 25);
      EXPECT_TRUE(std::isnan(net.weights[i]));
    }
  }
}

TEST(GridPlaceTest, OfAStringIsBetweenTwoModulesWhateverIsAskedFor) {
  const Grid string{"s", 3, 4, 1};
  for (const double along : {-1.0, 0.0, 0.4, 1.0, 2.0}) {
    const GridPlace place = placeOn(string, along, 0.7);
    ASSERT_EQ(place.count, 2);
    EXPECT_GE(place.mats[0], 3);
    EXPECT_EQ(place.mats[1], place.mats[0] + 1);
    EXPECT_LE(place.mats[1], 6);
    EXPECT_NEAR(place.weights[0] + place.weights[1], 1.0, 1e-15);
  }
  EXPECT_EQ(placeOn(string, 2.0, 0.0).weights[1], 1.0);
  EXPECT_NEAR(placeOn(string, 0.4, 0.0).weights[1], 0.2, 1e-15);
}

TEST(PlaceOutputTest, TheForceAtAPlaceOfAMeshIsInterpolatedAsItsMotionIs) {
  const std::string out =
      "outputs: {o: {at: 'net@0.3:0.4', axis: y, channel: 2, gain: 10, quantity: ";
  const Scene scene = readYaml(kPointsHead + out + "force}}\n", "force.yaml");
  const GridPlace place = placeOn(scene.grids.back(), 0.3, 0.4);
  ASSERT_EQ(scene.outputs.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Output& output = scene.outputs[i];
    EXPECT_EQ(output.name, "o." + std::to_string(i));
    EXPECT_EQ(output.quantity, Quantity::kForce);
    EXPECT_EQ(output.point.mat, place.mats[i]);
    EXPECT_EQ(output.channel, 1);
    EXPECT_EQ(output.axis, 1);
    EXPECT_NEAR(scene.valueOf(output.gain), 10.0 * place.weights[i], 1e-12);
  }
  EXPECT_EQ(readYaml(kPointsHead + out + "velocity}}\n", "v.yaml").outputs.size(), 1U);
  const std::string many = "outputs: {o: {at: 'net@0.3:0.4', quantity: force, channels: [1, 2]}}\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(kPointsHead + many, "m.yaml"); }),
              HasSubstr("goes to one channel"));
}

TEST(PointTest, OnAStringIsReadFieldByField) {
  const Scene s = pointScene(
      "along: s, at: $finger, guide: {mat: k, scale: 5}, range: [0.1, 0.9], speed: 2, power: 0.5");
  ASSERT_EQ(s.connections.size(), 1U);
  const Connection& c = s.connections[0];
  const Mat& q = s.mats[static_cast<std::size_t>(c.mat)];
  EXPECT_EQ(q.name, "q");
  EXPECT_EQ(q.type, MatType::kPoint);
  EXPECT_EQ(q.section, 0);
  EXPECT_EQ(s.grids[static_cast<std::size_t>(c.grid)].name, "s");
  EXPECT_EQ(c.along.at.parameter, 0);
  EXPECT_EQ(c.across.at.factor, 0.0);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(c.along.guide)].name, "k");
  EXPECT_EQ(c.along.scale, 5.0);
  EXPECT_EQ(c.along.minimum, 0.1);
  EXPECT_EQ(c.along.maximum, 0.9);
  EXPECT_EQ(c.speed, 2.0);
  EXPECT_EQ(c.power, 0.5);
  EXPECT_EQ(c.place.line, 11);
  // 0.3 of the way is on mass 3 of a triangle whose top is 0.01 at mass 5.
  EXPECT_NEAR(q.rest.y(), 0.3, 1e-15);
  EXPECT_NEAR(q.position.x(), 0.006, 1e-15);
}

TEST(PointTest, RangeMayBeOnePlace) {
  const Scene s = pointScene("along: s, at: 0.3, guide: {mat: k, scale: 5}, range: [0.3, 0.3]");
  EXPECT_EQ(s.connections.at(0).along.minimum, 0.3);
  EXPECT_EQ(s.connections[0].along.maximum, 0.3);
}

TEST(PointTest, OnAMeshStartsBetweenItsFourModules) {
  const Scene s = pointScene("along: net, at: [0.3, 0.75]");
  const Connection& c = s.connections.at(0);
  const Mat& q = s.mats[static_cast<std::size_t>(c.mat)];
  EXPECT_EQ(c.along.at.factor, 0.3);
  EXPECT_EQ(c.across.at.factor, 0.75);
  EXPECT_EQ(c.along.guide, -1);
  EXPECT_EQ(c.speed, 0.0);
  EXPECT_EQ(c.power, 1.0);
  EXPECT_EQ(q.section, 1);
  EXPECT_NEAR(q.rest.x(), 1.0 + 0.3 * 0.4, 1e-15);
  EXPECT_NEAR(q.rest.y(), 2.0 + 0.75 * 0.2, 1e-15);
  EXPECT_TRUE(q.position.isApprox(q.rest, 1e-15));
}

TEST(PointTest, OnAMeshMayBeLedBothWays) {
  const Scene s = pointScene(
      "along: net, at: [0.3, 0.75], guide: [{mat: net.0.0, axis: y, scale: 5}, {mat: k, scale: "
      "-2}],"
      " range: [[0.1, 0.9], [0.6, 0.8]]");
  const Connection& c = s.connections.at(0);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(c.along.guide)].name, "net.0.0");
  EXPECT_EQ(c.along.axis, 1);
  EXPECT_EQ(c.along.scale, 5.0);
  EXPECT_EQ(c.along.minimum, 0.1);
  EXPECT_EQ(c.along.maximum, 0.9);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(c.across.guide)].name, "k");
  EXPECT_EQ(c.across.axis, 0);
  EXPECT_EQ(c.across.scale, -2.0);
  EXPECT_EQ(c.across.minimum, 0.6);
  EXPECT_EQ(c.across.maximum, 0.8);
}

TEST(PointTest, OnAMeshMayBeLedAcrossAlone) {
  const Scene s = pointScene(
      "along: net, at: [0.3, 0.75], guide: [~, {mat: k, scale: 1}], range: [~, [0.7, 0.8]]");
  const Connection& c = s.connections.at(0);
  EXPECT_EQ(c.along.guide, -1);
  EXPECT_EQ(c.along.minimum, 0.0);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(c.across.guide)].name, "k");
  EXPECT_EQ(c.across.minimum, 0.7);
}

TEST(PointTest, CanBeNamedByLinksAndOutputs) {
  const Scene s = readYaml(kPointsHead +
                               "mats: {q: {type: point, along: s, at: 0.35},\n"
                               "  g: {type: ground, section: a}}\n"
                               "lias: {l: {type: spring, between: [g, q], stiffness: 1}}\n"
                               "outputs: {o: {at: q, quantity: velocity, channel: 1}}\n",
                           "point.yaml");
  EXPECT_EQ(s.lias.back().b, s.connections[0].mat);
  EXPECT_EQ(s.outputs[0].point.mat, s.connections[0].mat);
}

TEST(PointTest, OfALinkEndIsMadeOnceForAllLinks) {
  const Scene s = readYaml(kPointsHead +
                               "mats: {g: {type: ground, section: p}}\n"
                               "lias:\n"
                               "  l: {type: spring, between: [g, net@0.3:0.7], stiffness: 1}\n"
                               "  m: {type: damper, between: [g, net@0.3:0.7], damping: 1}\n",
                           "point.yaml");
  ASSERT_EQ(s.connections.size(), 1U);
  EXPECT_EQ(s.connections[0].along.at.factor, 0.3);
  EXPECT_EQ(s.connections[0].across.at.factor, 0.7);
  const std::size_t links = s.lias.size();
  EXPECT_EQ(s.lias[links - 1].b, s.connections[0].mat);
  EXPECT_EQ(s.lias[links - 2].b, s.connections[0].mat);
}

class PointAtTest : public testing::Test {
 protected:
  PointAtTest() {
    builder_.add(Section{});
    StringSpec string;
    string.name = "s";
    string.masses = 9;
    string.mass = {1.0};
    addString(builder_, string);
    MeshSpec mesh;
    mesh.name = "net";
    mesh.rows = 3;
    mesh.columns = 5;
    mesh.mass = {1.0};
    addMesh(builder_, mesh);
  }
  std::string nameAt(const std::string& text) {
    return builder_.scene().mats[static_cast<std::size_t>(pointAt(builder_, text, {1, 1}))].name;
  }
  SceneBuilder builder_{"test.yaml", ""};
};

TEST_F(PointAtTest, IsTheModuleItselfWhereOneIs) {
  EXPECT_EQ(nameAt("s.4"), "s.4");
  EXPECT_EQ(nameAt("s@0"), "s.0");
  EXPECT_EQ(nameAt("s@1"), "s.10");
  EXPECT_EQ(nameAt("s@0.7"), "s.7");
  EXPECT_EQ(nameAt("net@0.75:0.5"), "net.1.3");
  EXPECT_TRUE(builder_.scene().connections.empty());
}

TEST_F(PointAtTest, IsMadeOnceAndFoundAgain) {
  const int first = pointAt(builder_, "s@0.35", {3, 4});
  EXPECT_EQ(pointAt(builder_, "s@0.350", {5, 6}), first);
  EXPECT_EQ(nameAt("s@0.35"), "s@0.35");
  EXPECT_EQ(nameAt("net@0.3:0.70"), "net@0.3:0.7");
  ASSERT_EQ(builder_.scene().connections.size(), 2U);
  const Connection& c = builder_.scene().connections[0];
  EXPECT_EQ(c.mat, first);
  EXPECT_EQ(c.along.at.factor, 0.35);
  EXPECT_EQ(c.along.minimum, 0.0);
  EXPECT_EQ(c.along.maximum, 1.0);
  EXPECT_EQ(c.place.line, 3);
  EXPECT_EQ(builder_.scene().connections[1].across.at.factor, 0.7);
}

TEST_F(PointAtTest, RefusesWhatIsNoPlace) {
  const std::pair<const char*, const char*> texts[] = {
      {"t@0.3", "unknown string or mesh 't'"},
      {"s@1.5", "= 1.5 is out of range, allowed: 0...1"},
      {"s@", "'' is not a finite number"},
      {"s@0.3:0.5", "'s@0.3:0.5' is no point of 's', allowed: s@0.3 and the like"},
      {"net@0.3", "'net@0.3' is no point of 'net', allowed: net@0.3:0.7 and the like"},
      {"net@0.3:-1", "= -1 is out of range, allowed: 0...1"},
      {"s.99", "unknown module 's.99'"},
  };
  for (const auto& [text, message] : texts) {
    const std::string place = text;
    EXPECT_THAT(complaintOf<TextError>([&] {
                  pointAt(builder_, place, {7, 8});
                }),
                AllOf(StartsWith("test.yaml:7:8: error: "), HasSubstr(message)));
  }
}

}  // namespace
}  // namespace ergotic::scene
