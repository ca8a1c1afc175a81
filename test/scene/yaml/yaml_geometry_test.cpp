// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kSections =
    "ergotic: 1\n"
    "parameters: {air: {value: 2, range: [0, 4]}}\n"
    "sections:\n"
    "  scalar: {gravity: [-9.81], medium: 0.5*$air, rate: auto}\n"
    "  line: {geometry: line, gravity: 3, sleep: 1e-9}\n"
    "  plane: {geometry: plane, gravity: [1, -2]}\n"
    "  space: {geometry: space, gravity: [1, 2, 3], rate: gestural}\n";

Scene withMats(const std::string& mats) {
  return readYaml(kSections + "mats:\n" + mats, "geometry.yaml");
}

void expectVector(const Eigen::Vector3d& seen, double x, double y, double z) {
  EXPECT_EQ(seen.x(), x);
  EXPECT_EQ(seen.y(), y);
  EXPECT_EQ(seen.z(), z);
}

TEST(YamlGeometryTest, SectionsAreReadFieldByField) {
  const Scene s = readYaml(kSections, "geometry.yaml");
  ASSERT_EQ(s.sections.size(), 4U);
  const Geometry geometries[] = {Geometry::kScalar, Geometry::kLine, Geometry::kPlane,
                                 Geometry::kSpace};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(s.sections[i].geometry, geometries[i]);
    EXPECT_EQ(s.sections[i].automatic_rate, i == 0);
    EXPECT_EQ(s.sections[i].gestural, i == 3);
  }
  expectVector(s.sections[0].gravity, -9.81, 0.0, 0.0);
  expectVector(s.sections[1].gravity, 3.0, 0.0, 0.0);
  expectVector(s.sections[2].gravity, 1.0, -2.0, 0.0);
  expectVector(s.sections[3].gravity, 1.0, 2.0, 3.0);
  EXPECT_EQ(s.sections[0].medium.factor, 0.5);
  EXPECT_EQ(s.sections[0].medium.parameter, 0);
  EXPECT_EQ(s.sections[1].medium.factor, 0.0);
  EXPECT_EQ(s.sections[0].sleep_energy, 0.0);
  EXPECT_EQ(s.sections[1].sleep_energy, 1e-9);
}

TEST(YamlGeometryTest, SectionsMayBePlayedByTheirModes) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {a: {modes: all}, b: {modes: auto}, c: {modes: 200}, d: {}}\n", "m");
  EXPECT_EQ(s.sections[0].modes, kAllModes);
  EXPECT_EQ(s.sections[1].modes, kAutomaticModes);
  EXPECT_EQ(s.sections[2].modes, 200);
  EXPECT_EQ(s.sections[3].modes, kNoModes);
}

struct Placed {
  Eigen::Vector3d rest;
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
};

TEST(YamlGeometryTest, ModulesRestWhereTheyAreAndMayStartElsewhere) {
  const Scene s = withMats(
      "  a: {type: mass, section: plane, mass: 1, at: [1, 2]}\n"
      "  b: {type: mass, section: plane, mass: 1, at: [1, 2, 3], x: [4, 5], v: [6, 7]}\n"
      "  c: {type: cell, section: space, mass: 1, at: [1, 2, 3], x: [4, 5, 6], v: [7, 8, 9]}\n"
      "  d: {type: mass, section: line, mass: 1, at: 1, x: 2, v: 3}\n"
      "  e: {type: mass, section: line, mass: 1, at: [1, 2, 3], x: [4]}\n"
      "  f: {type: mass, section: space, mass: 1}\n"
      "  g: {type: ground, section: space, at: [1, 2, 3]}\n"
      "  h: {type: driven, section: plane, at: [1, 2], x: [3, 2]}\n");
  const Placed placed[] = {{{1, 2, 0}, {1, 2, 0}, {0, 0, 0}}, {{1, 2, 3}, {4, 5, 0}, {6, 7, 0}},
                           {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                           {{1, 2, 3}, {4, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                           {{1, 2, 3}, {1, 2, 3}, {0, 0, 0}}, {{1, 2, 0}, {3, 2, 0}, {0, 0, 0}}};
  for (std::size_t i = 0; i < std::size(placed); ++i) {
    EXPECT_EQ(s.mats[i].rest, placed[i].rest) << s.mats[i].name;
    EXPECT_EQ(s.mats[i].position, placed[i].position) << s.mats[i].name;
    EXPECT_EQ(s.mats[i].push->velocity, placed[i].velocity) << s.mats[i].name;
  }
  EXPECT_EQ(s.coordinates(), 2 + 2 + 3 + 1 + 1 + 3 + 3 + 2);
}

TEST(YamlGeometryTest, CellsAreMatchedUnlessTheySayOtherwise) {
  const Scene s = withMats(
      "  a: {type: cell, section: scalar, mass: 1}\n"
      "  b: {type: cell, section: scalar, mass: 1, matched: false}\n"
      "  c: {type: cell, section: scalar, mass: 1, matched: true}\n"
      "  d: {type: mass, section: scalar, mass: 1}\n");
  EXPECT_TRUE(s.mats[0].matched);
  EXPECT_FALSE(s.mats[1].matched);
  EXPECT_TRUE(s.mats[2].matched);
  EXPECT_FALSE(s.mats[3].matched);
}

TEST(YamlGeometryTest, InputsAndOutputsHaveAnAxisAndMayBeOnPoints) {
  const Scene s = readYaml(kSections +
                               "mats: {d: {type: driven, section: space}}\n"
                               "generators:\n"
                               "  - {type: mesh, name: n, section: plane, rows: 3, columns: 3, "
                               "spacing: 1, mass: 1, stiffness: 1}\n"
                               "  - {type: string, name: s, section: plane, masses: 9, mass: 1, "
                               "stiffness: 1, to: [1, 0]}\n"
                               "inputs:\n"
                               "  a: {mat: d, quantity: position, channel: 1, axis: z}\n"
                               "  b: {mat: s@0.35, quantity: force, channel: 2}\n"
                               "outputs:\n"
                               "  c: {at: s@0.35, quantity: velocity, channel: 1, axis: y}\n"
                               "  d: {at: n@0.1:0.2, quantity: position, channel: 1}\n",
                           "axis.yaml");
  EXPECT_EQ(s.inputs[0].axis, 2);
  EXPECT_EQ(s.inputs[1].axis, 0);
  EXPECT_EQ(s.inputs[1].mat, s.connections.at(0).mat);
  EXPECT_EQ(s.outputs[0].axis, 1);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(s.outputs[0].point.mat)].name, "s.3");
  EXPECT_EQ(s.outputs[0].point.next, s.outputs[0].point.mat + 1);
  EXPECT_NEAR(s.outputs[0].point.fraction, 0.5, 1e-14);
  EXPECT_EQ(s.outputs[1].axis, 0);
  EXPECT_EQ(s.outputs[1].point.mat, s.connections.at(1).mat);
  EXPECT_EQ(s.outputs[1].point.next, -1);
}

TEST(YamlGeometryTest, PortsMoveAnyCoordinateThatMoves) {
  const std::string mats =
      "  tip: {type: slice, section: space2, at: [1, 2, 3]}\n"
      "  key: {type: slice, section: scalar}\n"
      "ports:\n"
      "  up: {mat: tip, axis: z}\n"
      "  along: {mat: tip, slice: 3}\n"
      "  across: {mat: tip, axis: y, offset: 0.5}\n"
      "  key: {mat: key, axis: x, slice: 0}\n";
  std::string sections = kSections;
  sections += "  space2: {geometry: space, rate: gestural}\n";
  const Scene s = readYaml(sections + "mats:\n" + mats, "geometry.yaml");
  const std::pair<int, int> expected[] = {{2, -1}, {0, 3}, {1, -1}, {0, 0}};
  ASSERT_EQ(s.ports.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(std::make_pair(s.ports[i].axis, s.ports[i].slice), expected[i]) << i;
  }
  EXPECT_EQ(s.ports[2].offset, 0.5);
  EXPECT_TRUE(s.warnings.empty());
}

}  // namespace
}  // namespace ergotic::scene
