// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "scene/bad_text.hpp"

namespace ergotic::scene {
namespace {

constexpr double kOmega = 2.0 * 3.14159265358979323846 * 100.0;

TEST(YamlPortFilterTest, AMassTakesOverTheLinksOfTheSliceAndHangsOnIt) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {h: {rate: gestural}}\n"
      "mats: {k: {type: slice, at: [1, 2], rest: -0.5}, g: {type: ground}, m: {type: mass, mass: "
      "1}}\n"
      "lias: {a: {type: contact, between: [k, g], stiffness: 5},\n"
      "       b: {type: spring, between: [g, k], stiffness: 6},\n"
      "       c: {type: spring, between: [g, m], stiffness: 7}}\n"
      "agents: {a: {mat: k, stiffness: 8, points: [[0, 0]]}}\n"
      "ports: {p: {mat: k, slice: 0, filter: {mass: 0.01, frequency: 100, damping_ratio: 0.5}}}\n"
      "outputs: {o: {at: k, quantity: force, channel: 1}}\n",
      "a.yaml");
  ASSERT_EQ(s.mats.size(), 5U);
  EXPECT_EQ(s.mats[4].name, "p.filter");
  EXPECT_EQ(s.mats[4].type, MatType::kMass);
  EXPECT_EQ(s.mats[4].mass.factor, 0.01);
  EXPECT_EQ(s.mats[4].rest, Eigen::Vector3d(-0.5, 1.0, 2.0));
  EXPECT_EQ(s.mats[4].position.x(), -0.5);
  EXPECT_EQ(s.ports[0].mat, 0);
  EXPECT_EQ(s.ports[0].filter, 4);
  const std::pair<int, int> ends[] = {{4, 1}, {1, 4}, {1, 2}, {3, 4}, {4, 0}};
  ASSERT_EQ(s.lias.size(), 5U);
  for (std::size_t l = 0; l < 5; ++l) {
    EXPECT_EQ(std::make_pair(s.lias[l].a, s.lias[l].b), ends[l]) << l;
  }
  EXPECT_EQ(s.lias[4].name, "p.filter");
  EXPECT_DOUBLE_EQ(s.lias[4].stiffness.factor, 0.01 * kOmega * kOmega);
  EXPECT_DOUBLE_EQ(s.lias[4].damping.factor, 0.01 * kOmega);
  EXPECT_EQ(s.outputs[0].point.mat, 0);
}

TEST(YamlPortFilterTest, InSpaceAllPortsOfASliceShareItAndItIsDampedAlongAllAxes) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {h: {rate: gestural, geometry: space}}\n"
      "mats: {k: {type: slice, at: [1, 2, 3]}}\n"
      "ports: {x: {mat: k, axis: x}, y: {mat: k, axis: y, filter: {mass: 0.01, frequency: 100}}}\n",
      "a.yaml");
  EXPECT_EQ(s.ports[0].filter, 1);
  EXPECT_EQ(s.ports[1].filter, 1);
  EXPECT_EQ(s.mats[1].position, Eigen::Vector3d(1.0, 2.0, 3.0));
  ASSERT_EQ(s.lias.size(), 2U);
  EXPECT_EQ(s.lias[0].type, LiaType::kBowTable);
  const auto [v, f] = s.lias[0].law->table.points.at(1);
  EXPECT_DOUBLE_EQ(f / v, 2.0 * 0.7 * 0.01 * kOmega);
  EXPECT_EQ(s.lias[1].damping.factor, 0.0);
}

TEST(YamlPortFilterTest, ItsMassMayMoveInAFasterSection) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {h: {rate: gestural}, a: {}}\nmats: {k: {type: slice, section: h}}\n"
      "ports: {p: {mat: k, slice: 0, filter: {mass: 0.01, frequency: 100, section: a}}}\n",
      "a.yaml");
  EXPECT_EQ(s.mats[1].section, 1);
  EXPECT_EQ(s.mats.at(static_cast<std::size_t>(s.lias[0].b)).section, 0);
}

#define FILTER(fields)                                                 \
  "ergotic: 1\ngestural_rate: 3000\nsections: {h: {rate: gestural}}\n" \
  "mats: {k: {type: slice}}\nports: {p: {mat: k, filter: {" fields "}}}\n"
const BadText kBad[] = {
    {FILTER("mass: <!>0, frequency: 100"), "= 0 kg is out of range, allowed: > 0 kg"},
    {FILTER("mass: 1, frequency: <!>0"), "allowed: above 0...497.189"},
    {FILTER("mass: 1, frequency: <!>498"), "= 498 Hz is out of range, allowed: above 0...497.189"},
    {FILTER("mass: 1, frequency: <!>955, damping_ratio: 0"), "allowed: above 0...954.929"},
    {FILTER("mass: 1, frequency: 100, damping_ratio: <!>3"), "allowed: 0...2"},
    {FILTER("mass: 1, frequency: 100, <!>stiffness: 3"), "unknown key 'stiffness'"},
    {"ergotic: 1\nsections: {h: {rate: gestural}, l: {geometry: line}}\n"
     "mats: {k: {type: slice, section: h}}\n"
     "ports: {p: {mat: k, filter: {mass: 1, frequency: 9, section: <!>l}}}\n",
     "in a section of another geometry or pose than that of 'k', allowed: the same"},
    {"ergotic: 1\nsections: {h: {rate: gestural, geometry: plane}}\n"
     "mats: {k: {type: slice}}\n"
     "ports: {x: {mat: k, filter: {mass: 1, frequency: 9}},\n"
     "        y: {mat: k, axis: y, <!>filter: {mass: 1, frequency: 9}}}\n",
     "port 'y' has a filter and so has another port of its module"},
};
TEST(YamlPortFilterTest, WhatIsWrongIsRefusedAtItsPlace) {
  for (const BadText& bad : kBad) {
    expectRefused(bad, "bad.yaml");
  }
}

}  // namespace
}  // namespace ergotic::scene
