// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/rig.hpp"

#include "ergotic/tgr/driver.hpp"
#include "support/realtime_scope.hpp"
#include "support/test.hpp"
#include "tgr/rig_scenes.hpp"

namespace ergotic::tgr {
namespace {

using test::endEffector;
using test::endEffectors;

std::vector<double> toModel(Rig& rig,
                            std::vector<double> slices,
                            std::size_t ports,
                            double time_s = 0.0) {
  std::vector<double> model(ports);
  EXPECT_EQ(rig.toModel(slices.data(), time_s, model.data()), 0U);
  return model;
}

std::vector<double> toDevice(const Rig& rig, std::vector<double> ports, std::size_t slices) {
  std::vector<double> device(slices, 99.0);
  rig.toDevice(ports.data(), device.data());
  return device;
}

std::string messageOfRig(const scene::Scene& scene, const EndEffectors& end_effectors, int slices) {
  return complaintOf<TextError>([&] { makeRig(scene, end_effectors, slices); });
}

TEST(RigTest, MovesAPortWithItsSliceByItsOwnScales) {
  test::PortScene ports;
  scene::Port& port = ports.port("key", 2);
  port.offset = 0.25;
  port.position_scale = 0.5;
  port.force_scale = 4.0;
  const auto rig = makeRig(ports.scene, {}, 3);
  EXPECT_THAT(toModel(*rig, {9.0, 9.0, 0.75}, 1), ElementsAre(1.0));
  EXPECT_THAT(toDevice(*rig, {3.0}, 3), ElementsAre(0.0, 0.0, 12.0));
  EXPECT_EQ(rig->slicesInUse(), 4U);
}

TEST(RigTest, AddsTheForcesOfPortsOnOneSlice) {
  test::PortScene ports;
  ports.port("a", 0);
  ports.port("b", 0).force_scale = 2.0;
  const auto rig = makeRig(ports.scene, {}, 1);
  EXPECT_THAT(toModel(*rig, {0.5}, 2), ElementsAre(0.5, 0.5));
  EXPECT_THAT(toDevice(*rig, {1.0, 10.0}, 1), ElementsAre(21.0));
}

TEST(RigTest, LetsPortsThatNothingMovesRestAtTheZeroOfTheHand) {
  test::PortScene ports;
  scene::Port& port = ports.port("free");
  port.offset = 0.5;
  port.position_scale = 2.0;
  const auto rig = makeRig(ports.scene, {}, 2);
  EXPECT_THAT(toModel(*rig, {7.0, 7.0}, 1), ElementsAre(-0.25));
  EXPECT_THAT(toDevice(*rig, {1000.0}, 2), ElementsAre(0.0, 0.0));
  EXPECT_EQ(rig->slicesInUse(), 0U);
}

TEST(RigTest, MovesThePortOfAnAgentOverTimeWithoutAnySlice) {
  test::PortScene ports;
  scene::Agent agent;
  agent.name = "partner";
  agent.knots = {{0.0, 0.0}, {2.0, 1.0}};
  ports.scene.agents.push_back(agent);
  ports.port("hand", 0);
  ports.port("partner").agent = 0;
  const auto rig = makeRig(ports.scene, {}, 1);
  EXPECT_THAT(toModel(*rig, {0.125}, 2, 0.5), ElementsAre(0.125, 0.25));
  EXPECT_THAT(toModel(*rig, {0.125}, 2, 3.0), ElementsAre(0.125, 1.0));
  EXPECT_THAT(toDevice(*rig, {1.0, 50.0}, 1), ElementsAre(1.0));
}

TEST(RigTest, GivesAnEndEffectorItsPortsAndAllOfItsSlices) {
  test::PortScene ports;
  ports.port("along");
  ports.port("pressure", 2);  // its own slice does not move it any more
  ports.port("key", 0);       // the slice is the bow's
  ports.port("other", 2);
  const auto rig =
      makeRig(ports.scene,
              endEffectors({endEffector(EndEffectorType::kBow, {1, 0}, {"along", "pressure"})}), 3);
  EXPECT_THAT(toModel(*rig, {0.25, 0.5, 0.125}, 4), ElementsAre(0.5, 0.25, 0.0, 0.125));
  EXPECT_THAT(toDevice(*rig, {1.0, 2.0, 4.0, 8.0}, 3), ElementsAre(2.0, 1.0, 8.0));
  EXPECT_EQ(rig->slicesInUse(), 7U);
}

TEST(RigTest, AppliesTheScalesOfEndEffectorAndPortOneAfterTheOther) {
  test::PortScene ports;
  scene::Port& port = ports.port("key");
  port.offset = 0.5;
  port.position_scale = 4.0;
  port.force_scale = 3.0;
  EndEffectorConfig key = endEffector(EndEffectorType::kKey, {0}, {"key"});
  key.lever = 2.0;
  key.position_scale = 0.125;
  key.force_scale = 5.0;
  const auto rig = makeRig(ports.scene, endEffectors({key}), 1);
  // x = 2 * 0.125 m at the key, 2 m at the port, (2 - 0.5) / 4 in the model
  EXPECT_THAT(toModel(*rig, {0.125}, 1), ElementsAre(0.375));
  EXPECT_THAT(toDevice(*rig, {1.0}, 1), ElementsAre(2.0 * 5.0 * 3.0));
}

TEST(RigTest, LeavesCoordinatesWithoutPortAlone) {
  test::PortScene ports;
  ports.port("pressure");
  const auto rig = makeRig(
      ports.scene, endEffectors({endEffector(EndEffectorType::kBow, {0, 1}, {"", "pressure"})}), 2);
  EXPECT_THAT(toModel(*rig, {0.25, 0.5}, 1), ElementsAre(0.5));
  EXPECT_THAT(toDevice(*rig, {3.0}, 2), ElementsAre(0.0, 3.0));
}

TEST(RigTest, DoesNotUseTheSlicesOfAnEndEffectorWithoutPorts) {
  const test::PortScene ports;
  const auto rig =
      makeRig(ports.scene, endEffectors({endEffector(EndEffectorType::kKey, {1}, {""})}), 2);
  EXPECT_EQ(rig->slicesInUse(), 0U);
}

TEST(RigTest, HoldsAnEndEffectorBeyondItsWorkspaceAndTakesItsForceAway) {
  test::PortScene ports;
  ports.port("x");
  ports.port("y");
  ports.port("key", 5);
  EndEffectorConfig stick = endEffector(EndEffectorType::kStick, {1, 3}, {"x", "y"});
  stick.arm = 0.05;
  const auto rig = makeRig(ports.scene, endEffectors({stick}), 6);
  const std::vector<double> good = toModel(*rig, {0, 0.01, 0, 0.02, 0, 0}, 3);
  EXPECT_NE(toDevice(*rig, {1.0, 0.0, 0.0}, 6)[1], 0.0);

  const std::vector<double> tilted{0, 0.1, 0, 0.0, 0, 0.25};  // 63 degrees
  std::vector<double> model(3);
  EXPECT_EQ(rig->toModel(tilted.data(), 0.0, model.data()), 0b1010U);
  EXPECT_THAT(model, ElementsAre(good[0], good[1], 0.25));
  EXPECT_THAT(toDevice(*rig, {1.0, 1.0, 2.0}, 6), ElementsAre(0, 0, 0, 0, 0, 2.0));

  const std::vector<double> broken{0, std::nan(""), 0, 0.0, 0, 0.0};
  EXPECT_EQ(rig->toModel(broken.data(), 0.0, model.data()), 0b1010U);
  EXPECT_THAT(model, ElementsAre(good[0], good[1], 0.0));
}

TEST(RigTest, MapsInRealTime) {
  test::PortScene ports;
  scene::Agent agent;
  agent.knots = {{0.0, 0.0}, {1.0, 0.5}, {2.0, 0.25}};
  ports.scene.agents.push_back(agent);
  for (const char* name : {"k", "b0", "b1", "s0", "s1", "s2"}) {
    ports.port(name);
  }
  ports.port("agent").agent = 0;
  ports.port("direct", 6);
  const auto rig =
      makeRig(ports.scene,
              endEffectors({endEffector(EndEffectorType::kKey, {0}, {"k"}),
                            endEffector(EndEffectorType::kBow, {1, 2}, {"b0", "b1"}),
                            endEffector(EndEffectorType::kStick, {3, 4, 5}, {"s0", "s1", "s2"})}),
              7);
  std::array<double, 8> model{};
  std::array<double, 7> device{};
  test::expectRealtime([&] {
    for (int n = 0; n < 1000; ++n) {
      device.fill(1e-5 * n);
      rig->toModel(device.data(), 1e-3 * n, model.data());
      rig->toDevice(model.data(), device.data());
    }
  });
}

TEST(RigTest, RefusesASliceThatTheDeviceDoesNotHave) {
  test::PortScene ports;
  ports.port("key", 3);
  EXPECT_EQ(messageOfRig(ports.scene, {}, 3),
            "ports.yaml:10:3: error: port 'key' needs slice 3, the device has 0...2");
  const auto key = endEffector(EndEffectorType::kKey, {-1}, {""});
  EXPECT_EQ(messageOfRig(ports.scene, endEffectors({key}), 4),
            "hands.yaml:4:2: error: end-effector 'key': slice -1 does not exist, the device has "
            "0...3");
}

TEST(RigTest, RefusesWhatIsTakenTwice) {
  test::PortScene ports;
  ports.port("x");
  EndEffectorConfig a = endEffector(EndEffectorType::kKey, {0}, {"x"});
  EndEffectorConfig b = endEffector(EndEffectorType::kKey, {1}, {"x"});
  b.name = "b";
  EXPECT_EQ(messageOfRig(ports.scene, endEffectors({a, b}), 2),
            "hands.yaml:4:2: error: end-effector 'b': port 'x' is taken by end-effector 'key'");
  b.ports = {""};
  b.slices = {0};
  EXPECT_EQ(messageOfRig(ports.scene, endEffectors({a, b}), 2),
            "hands.yaml:4:2: error: end-effector 'b': slice 0 is taken by end-effector 'key'");
}

TEST(RigTest, RefusesNamesThatOtherFramesHave) {
  const test::PortScene ports;
  EndEffectorConfig a = endEffector(EndEffectorType::kKey, {0}, {""});
  EndEffectorConfig b = endEffector(EndEffectorType::kKey, {1}, {""});
  EXPECT_EQ(messageOfRig(ports.scene, endEffectors({a, b}), 2),
            "hands.yaml:4:2: error: end-effector 'key': the name comes twice");
  for (const char* name : {"", "model", "tgr_base"}) {
    b.name = name;
    EXPECT_THAT(messageOfRig(ports.scene, endEffectors({a, b}), 2),
                HasSubstr("not a name for one, allowed: all but '', 'model' and 'tgr_...'"));
  }
}

TEST(RigTest, RefusesPortsThatTheSceneDoesNotHaveOrAnAgentMoves) {
  test::PortScene ports;
  ports.scene.agents.push_back({"partner", {{0.0, 0.0}}, 0.0, {}});
  ports.port("x").agent = 0;
  EXPECT_THAT(
      messageOfRig(ports.scene, endEffectors({endEffector(EndEffectorType::kKey, {0}, {"y"})}), 1),
      HasSubstr("hands.yaml:4:2: error: end-effector 'key': the scene has no port 'y'"));
  EXPECT_EQ(
      messageOfRig(ports.scene, endEffectors({endEffector(EndEffectorType::kKey, {0}, {"x"})}), 1),
      "hands.yaml:4:2: error: end-effector 'key': port 'x' is moved by agent 'partner'");
}

TEST(RigTest, RefusesNumbersOutOfRange) {
  const test::PortScene ports;
  const auto refused = [&](auto change) {
    EndEffectorConfig key = endEffector(EndEffectorType::kKey, {0}, {""});
    change(key);
    return messageOfRig(ports.scene, endEffectors({key}), 4);
  };
  EXPECT_EQ(refused([](auto& key) { key.position_scale = 0.0; }),
            "hands.yaml:4:2: error: end-effector 'key': position_scale = 0 is out of range, "
            "allowed: 1e-06...1000000");
  EXPECT_THAT(refused([](auto& key) { key.force_scale = std::nan(""); }),
              HasSubstr("force_scale = nan is out of range"));
  EXPECT_THAT(refused([](auto& key) { key.ports.clear(); }),
              HasSubstr("0 ports, allowed: 1, one for each coordinate"));
  EXPECT_THAT(refused([](auto& key) {
                key.slices = {0, 1};
              }),
              HasSubstr("a key on 2 slices, allowed: 1 slice"));
  EXPECT_THAT(refused([](auto& key) { key.lever = 0.0; }), HasSubstr("lever = 0 m/m is out of"));
}

TEST(RigTest, RefusesMorePortsThanATickHasRoomFor) {
  test::PortScene ports;
  for (int p = 0; p <= kMaxPorts; ++p) {
    ports.port("p" + std::to_string(p));
  }
  EXPECT_EQ(messageOfRig(ports.scene, {}, 1),
            "ports.yaml:138:3: error: port 'p128' is one of 129, allowed: at most 128");
  ports.scene.ports.pop_back();
  EXPECT_EQ(messageOfRig(ports.scene, {}, 1), "");
}

}  // namespace
}  // namespace ergotic::tgr
