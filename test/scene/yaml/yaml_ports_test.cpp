// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cstdio>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

using Knots = std::vector<std::pair<double, double>>;

const std::string kPortsHead =
    "ergotic: 1\n"
    "parameters: {grip: {value: 2, range: [0, 4]}}\n"
    "sections: {sound: {}, hands: {rate: gestural}}\n"
    "mats: {m: {type: mass, section: sound, mass: 1, at: [0.1, 0.2], rest: 0.05}}\n";

TEST(YamlAgentsTest, AnAgentIsAPortATargetAndAHand) {
  const Scene s = readYaml(kPortsHead +
                               "agents:\n"
                               "  a: {mat: m, stiffness: 10*$grip, damping: 0.5,\n"
                               "      points: [[0, 0.01], [0.5, -0.02], [2, 0]], period: 3}\n",
                           "a.yaml");
  ASSERT_EQ(s.mats.size(), 2U);
  EXPECT_EQ(s.mats[1].name, "a.target");
  EXPECT_EQ(s.mats[1].type, MatType::kSlice);
  EXPECT_EQ(s.mats[1].section, 1);
  EXPECT_EQ(s.mats[1].rest, Eigen::Vector3d(0.05, 0.1, 0.2));
  EXPECT_EQ(s.mats[1].position.x(), 0.05);
  ASSERT_EQ(s.lias.size(), 1U);
  EXPECT_EQ(s.lias[0].name, "a.hand");
  EXPECT_EQ(s.lias[0].type, LiaType::kSpringDamper);
  EXPECT_EQ(s.lias[0].a, 1);
  EXPECT_EQ(s.lias[0].b, 0);
  EXPECT_EQ(s.valueOf(s.lias[0].stiffness), 20.0);
  EXPECT_EQ(s.lias[0].damping.factor, 0.5);
  ASSERT_EQ(s.ports.size(), 1U);
  EXPECT_EQ(s.ports[0].mat, 1);
  EXPECT_EQ(s.ports[0].agent, 0);
  EXPECT_EQ(s.ports[0].slice, -1);
  ASSERT_EQ(s.agents.size(), 1U);
  EXPECT_EQ(s.agents[0].name, "a");
  EXPECT_EQ(s.agents[0].knots.size(), 3U);
  EXPECT_EQ(s.agents[0].period_s, 3.0);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(YamlAgentsTest, BetweenPointsItMovesStraightAndOutsideItHolds) {
  const Scene s = readYaml(
      kPortsHead + "agents: {a: {mat: m, stiffness: 1, points: [[1, 2], [3, 6], [4, 0]]}}\n",
      "a.yaml");
  const Agent& agent = s.agents[0];
  EXPECT_EQ(agent.at(0.0), 2.0);
  EXPECT_EQ(agent.at(1.0), 2.0);
  EXPECT_DOUBLE_EQ(agent.at(1.5), 3.0);
  EXPECT_EQ(agent.at(3.0), 6.0);
  EXPECT_DOUBLE_EQ(agent.at(3.25), 4.5);
  EXPECT_EQ(agent.at(100.0), 0.0);
}

TEST(YamlAgentsTest, ALoopBeginsAnewAfterItsLastPoint) {
  const Scene s = readYaml(
      kPortsHead + "agents: {a: {mat: m, stiffness: 1, points: [[0, 0], [2, 4]], loop: true}}\n",
      "a.yaml");
  EXPECT_EQ(s.agents[0].period_s, 2.0);
  for (const double t : {0.25, 1.0, 1.75}) {
    EXPECT_DOUBLE_EQ(s.agents[0].at(t), 2.0 * t);
    EXPECT_NEAR(s.agents[0].at(t + 20.0), 2.0 * t, 1e-12);
  }
}

TEST(YamlAgentsTest, HandsPortsKeepTheirNumbers) {
  const Scene s = readYaml(
      "ergotic: 1\nsections: {h: {rate: gestural}}\n"
      "mats: {m: {type: mass, mass: 1}, k: {type: slice}}\n"
      "agents: {a: {mat: m, stiffness: 1, points: [[0, 0]]}}\n"
      "ports: {key: {mat: k, slice: 0}}\n",
      "a.yaml");
  ASSERT_EQ(s.ports.size(), 2U);
  EXPECT_EQ(s.ports[0].name, "key");
  EXPECT_EQ(s.ports[0].agent, -1);
  EXPECT_EQ(s.ports[1].name, "a.target");
}

TEST(YamlAgentsTest, InSpaceItPullsAlongOneAxisFromWhereTheModuleRests) {
  const Scene s = readYaml(
      "ergotic: 1\n"
      "sections:\n"
      "  net: {geometry: space, pose: {position: [1, 0, 0]}}\n"
      "  hands: {geometry: space, rate: gestural, pose: {position: [0, 2, 0]}}\n"
      "mats: {m: {type: mass, section: net, mass: 1, at: [0.1, 0.2, 0.3]}}\n"
      "agents: {a: {mat: m, axis: z, stiffness: 1, points: [[0, 0]]}}\n",
      "a.yaml");
  EXPECT_EQ(s.ports[0].axis, 2);
  EXPECT_LT((s.mats[1].rest - Eigen::Vector3d(1.1, -1.8, 0.3)).norm(), 1e-15);
  EXPECT_EQ(s.mats[1].position, s.mats[1].rest);
}

TEST(YamlAgentsTest, TheHandMovesInTheSectionThatIsNamed) {
  const std::string text =
      "ergotic: 1\n"
      "sections: {a: {rate: gestural}, b: {rate: gestural}, c: {}}\n"
      "mats: {m: {type: mass, section: c, mass: 1}, n: {type: mass, section: b, mass: 1}}\n"
      "agents: {a: {mat: m, section: a, stiffness: 1, points: [[0, 0]]},\n"
      "         b: {mat: n, stiffness: 1, points: [[0, 0]]}}\n";
  const Scene s = readYaml(text, "a.yaml");
  EXPECT_EQ(s.mats[2].section, 0);
  EXPECT_EQ(s.mats[3].section, 1);
}

/// As YAML 1.1 has them, and most of its readers.
TEST(YamlPortsTest, SwitchesMayBeAnyWordOfYaml) {
  const auto periodOf = [](const std::string& word) {
    return readYaml(kPortsHead +
                        "agents: {a: {mat: m, stiffness: 1, points: [[0, 0], [2, 0]], loop: " +
                        word + "}}\n",
                    "a.yaml")
        .agents[0]
        .period_s;
  };
  for (const char* word : {"true", "yes", "on", "Yes", "TRUE"}) {
    EXPECT_EQ(periodOf(word), 2.0) << word;
  }
  for (const char* word : {"false", "no", "off", "No"}) {
    EXPECT_EQ(periodOf(word), 0.0) << word;
  }
  EXPECT_THAT(complaintOf<TextError>([&] { periodOf("perhaps"); }),
              HasSubstr("unknown loop 'perhaps' of agent 'a'"));
}

/// A folder with gestures, `g.csv` as given.
class GestureFileTest : public testing::Test {
 protected:
  GestureFileTest() {
    folder_ = testing::TempDir() + "ergotic_gestures_" + std::to_string(::getpid()) + "/";
    EXPECT_EQ(std::system(("mkdir -p " + folder_).c_str()), 0);
  }
  ~GestureFileTest() override { std::system(("rm -rf " + folder_).c_str()); }

  Scene read(const std::string& csv, const std::string& spec) const {
    std::ofstream(folder_ + "g.csv") << csv;
    return readYaml(
        kPortsHead + "agents: {a: {mat: m, stiffness: 1, gesture: {file: g.csv, " + spec + "}}}\n",
        folder_ + "scene.yaml");
  }
  void expectRefused(const std::string& csv, const std::string& spec, const std::string& message) {
    EXPECT_THAT(complaintOf<TextError>([&] { read(csv, spec); }), StartsWith(folder_ + message))
        << csv;
  }
  std::string folder_;
};

TEST_F(GestureFileTest, TargetsOfOneSliceAreRead) {
  const Scene s =
      read("# two hands\ntime_s,slice,target_m\n0,1,0.5\n0.25,0,0.1\n1,1,-0.5\n", "slice: 1");
  EXPECT_EQ(s.agents[0].knots, (Knots{{0.0, 0.5}, {1.0, -0.5}}));
}

TEST_F(GestureFileTest, PositionsOfOneSliceCountFromTheFirstTick) {
  const Scene s = read("tick,x0,x1\n100,1,4\n101,2,5\n103,3,6\n", "slice: 1, tick_rate: 1000");
  EXPECT_EQ(s.agents[0].knots, (Knots{{0.0, 4.0}, {0.001, 5.0}, {0.003, 6.0}}));
}

TEST_F(GestureFileTest, AnAgentSetsNoParametersAndSaysSo) {
  const Scene s = read("0,0,0.1\n0.5,$loss,1\n0.6,$loss,2\n1,0,0.2\n", "slice: 0");
  EXPECT_EQ(s.agents[0].knots, (Knots{{0.0, 0.1}, {1.0, 0.2}}));
  EXPECT_THAT(s.warnings, ElementsAre(StartsWith(folder_ + "scene.yaml:5:36: warning: line 2 of "
                                                           "'g.csv' sets a parameter")));
}

TEST_F(GestureFileTest, TextAloneGivesTheSameSceneAgain) {
  const Scene first = read("0,0,0.1\n0.3333333333333333,0,1e-300\n", "slice: 0");
  EXPECT_THAT(first.text, HasSubstr("\n---\ngestures: {\"a\": [[0, 0.1], [0.3333333333333333, "
                                    "1e-300]]}\n"));
  std::remove((folder_ + "g.csv").c_str());
  const Scene again = readYaml(first.text, "/nowhere/else.yaml");
  EXPECT_EQ(again.agents[0].knots, first.agents[0].knots);
  EXPECT_EQ(again.text, first.text);
}

TEST_F(GestureFileTest, TextHoldsTablesAndGesturesSideBySide) {
  std::ofstream(folder_ + "t.csv") << "0 1\n1 2\n";
  std::ofstream(folder_ + "g.csv") << "0,0,0.1\n";
  const Scene first =
      readYaml(kPortsHead +
                   "lias: {l: {type: bow, between: [m, s.1], table: {file: t.csv}}}\n"
                   "generators: [{type: string, name: s, section: sound, masses: 2, mass: 1, "
                   "stiffness: 1, to: [1, 0]}]\n"
                   "agents:\n"
                   "  a: {mat: m, stiffness: 1, gesture: {file: g.csv, slice: 0}}\n"
                   "  b: {mat: s.1, stiffness: 1, gesture: {file: g.csv, slice: 0}}\n",
               folder_ + "scene.yaml");
  EXPECT_THAT(first.text, HasSubstr("\n---\ntables: {\"t.csv\": [[0, 1], [1, 2]]}\n"
                                    "gestures: {\"a\": [[0, 0.1]],\n  \"b\": [[0, 0.1]]}\n"));
  const Scene again = readYaml(first.text, "/nowhere/else.yaml");
  EXPECT_EQ(again.agents[1].knots, first.agents[1].knots);
  EXPECT_EQ(again.lias[3].law->table.points, first.lias[3].law->table.points);
}

TEST_F(GestureFileTest, WhatIsWrongIsToldWithItsLine) {
  expectRefused("0,0,1\n0,0,2\n", "slice: 0",
                "g.csv:2:1: error: time_s = 0 s is not after the slice's row before it");
  expectRefused("0,0\n", "slice: 0", "g.csv:1:4: error: target_m is missing");
  expectRefused("0,0,1,2\n", "slice: 0", "g.csv:1:7: error: more than 3 fields");
  expectRefused("0,0,1\n", "slice: 1", "g.csv:1:1: error: the gesture has nothing of slice 1");
  expectRefused("tick,x0\n0,1\n", "slice: 1, tick_rate: 1000",
                "g.csv:1:1: error: no column of slice 1, there are 1 slices");
  expectRefused("tick,y0\n0,1\n", "slice: 0, tick_rate: 1000",
                "g.csv:1:6: error: column 'y0' of the header, allowed: x0");
  expectRefused("tick,x0\n0,1\n0,2\n", "slice: 0, tick_rate: 1000",
                "g.csv:3:1: error: tick = 0 is out of range, allowed: 1...");
  expectRefused("tick,x0\n0.5,1\n", "slice: 0, tick_rate: 1000",
                "g.csv:2:1: error: tick = 0.5, allowed: whole numbers");
  expectRefused("tick,x0\n0,1\n", "slice: 0",
                "scene.yaml:5:36: error: 'g.csv' counts ticks, allowed: with 'tick_rate'");
  expectRefused("0,0,1\n", "slice: 0, tick_rate: 1000",
                "scene.yaml:5:36: error: 'g.csv' is in seconds, allowed: without 'tick_rate'");
}

constexpr double kOmega = 2.0 * 3.14159265358979323846 * 100.0;

TEST(YamlPortFilterTest, AMassTakesOverTheLinksOfTheSliceAndIsAttachedToIt) {
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

}  // namespace
}  // namespace ergotic::scene
