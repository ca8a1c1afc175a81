// SPDX-License-Identifier: BSD-3-Clause
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Vector3d;

struct InSpace : SceneBuilder {
  InSpace() { scene.sections[0].geometry = Geometry::kSpace; }
};

/// Where a constant acceleration brings a mass in n frames: it acts in the first one already.
double fallen(double acceleration, int n) {
  return acceleration * kStep * kStep * n * (n + 1.0) / 2.0;
}

TEST(ForcesTest, GravityAcceleratesEveryFreeModuleAlongEveryAxis) {
  InSpace b;
  const Vector3d g(1.5, -2.5, -9.81);
  b.scene.sections[0].gravity = g;
  b.hearAxes(b.mass(0.01));
  b.hear(b.mass(5.0), 3);
  b.hear(b.ground(), 4);
  Player player(b.scene, {kRate, 10});
  player.ticks(100);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(player.heard[at(axis)].back(), fallen(g[axis], 1000), 1e-15);
  }
  EXPECT_EQ(player.heard[3].back(), player.heard[0].back()) << "whatever its mass";
  EXPECT_EQ(player.heard[4].back(), 0.0);
}

TEST(ForcesTest, ConstantForceAcceleratesByTheMassAlongEveryAxis) {
  InSpace b;
  const Vector3d force(0.2, -0.1, 0.05);
  const int mass = b.mass(0.02);
  b.scene.mats[at(mass)].push.edit().force = force;
  b.hearAxes(mass);
  Player player(b.scene, {kRate, 10});
  player.ticks(100);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(player.heard[at(axis)].back(), fallen(force[axis] / 0.02, 1000), 1e-15);
  }
}

TEST(ForcesTest, GravityOfAnUnusedAxisMovesNothing) {
  SceneBuilder b;
  b.scene.sections[0].gravity = {0.0, -9.81, -9.81};
  b.hear(b.mass(1.0));
  Player player(b.scene, {kRate, 10});
  player.ticks(10);
  EXPECT_EQ(player.heard[0].back(), 0.0);
}

TEST(ForcesTest, MassFallsThroughAMediumAtItsFinalSpeed) {
  // d = keep d + h^2 g, keep = e^(-Z h/M).
  InSpace b;
  const double z = 0.5;
  const double m = 1e-3;
  b.scene.sections[0].medium = {z};
  b.scene.sections[0].gravity = {0.0, 0.0, -9.81};
  b.hearAxes(b.mass(m), 0, Quantity::kVelocity);
  Player player(b.scene, {kRate, 10});
  player.ticks(1000);
  EXPECT_NEAR(player.heard[2].back(), -9.81 * kStep / -std::expm1(-z * kStep / m), 1e-12);
  EXPECT_NEAR(player.heard[2].back() / (-9.81 * m / z), 1.0, z * kStep / m);
}

TEST(ForcesTest, InputPushesAlongItsAxis) {
  InSpace b;
  const int mass = b.mass(2.0);
  b.hearAxes(mass);
  for (const int axis : {2, 1}) {
    scene::Input& input = b.scene.inputs[at(b.push(mass, 2 - axis))];
    input.axis = axis;
    input.gain = {axis == 2 ? 3.0 : -1.0};
  }
  Player player(b.scene, {kRate, 1});
  player.inputs = {0.5, 0.25};
  player.ticks(2);
  EXPECT_EQ(player.heard[0].back(), 0.0);
  EXPECT_NEAR(player.heard[1].back(), -0.25 / 2.0 * kStep * kStep, 1e-24);
  EXPECT_NEAR(player.heard[2].back(), 1.5 / 2.0 * kStep * kStep, 1e-24);
}

TEST(ForcesTest, InputOnAPointPushesTheModulesAroundIt) {
  InSpace b;
  const int first = b.mass(1.0);
  const int second = b.mass(1.0);
  b.push(b.point(b.grid(first, 2), 0.25));
  b.scene.inputs[0].axis = 1;
  for (const int m : {first, second}) {
    b.hear(m, m);
    b.scene.outputs.back().axis = 1;
  }
  Player player(b.scene, {kRate, 1});
  player.inputs = {4.0};
  player.ticks(2);
  EXPECT_NEAR(player.heard[0].back(), 3.0 * kStep * kStep, 1e-24);
  EXPECT_NEAR(player.heard[1].back(), 1.0 * kStep * kStep, 1e-24);
}

TEST(ForcesTest, OutputBetweenTwoModulesIsHeardAlongItsAxis) {
  InSpace b;
  const int low = b.ground();
  const int high = b.ground();
  b.scene.mats[at(low)].position = {1.0, 2.0, 3.0};
  b.scene.mats[at(low)].rest = {0.5, 0.25, 0.125};
  b.scene.mats[at(high)].position = {5.0, 7.0, 11.0};
  b.hearAxes(low);
  for (scene::Output& output : b.scene.outputs) {
    output.point = {low, high, 0.25};
  }
  Player player(b.scene, {kRate, 1});
  player.tick();
  EXPECT_DOUBLE_EQ(player.heard[0][0], 2.0);
  EXPECT_DOUBLE_EQ(player.heard[1][0], 3.25);
  EXPECT_DOUBLE_EQ(player.heard[2][0], 5.0);
}

/// A scene with one parameter, at 1, and how it is set.
struct Live : SceneBuilder {
  Live() { scene.parameters.push_back({"p", 1.0, 0.0, 10.0, {}}); }
  static void set(Player& player, double value) {
    player.instrument->exchange(player.instrument->prepare({value}));
  }
};

/// Force at e = 0.1 m and v = 2 m/s before and after the parameter goes from 1 to 3.
std::pair<double, double> forceAtOneAndThree(scene::Lia lia) {
  Live b;
  const int driven = b.driven(0);
  const int ground = b.ground();
  lia.a = driven;
  lia.b = ground;
  lia.name = "l";
  b.scene.lias.push_back(lia);
  b.hear(ground, 0, Quantity::kForce);
  Player player(b.scene, {kRate, 2});
  player.inputs = {0.1 - 2.0 * kStep, 0.1};
  player.tick();
  const double before = player.heard[0].back();
  Live::set(player, 3.0);
  player.tick();
  return {before, player.heard[0].back()};
}

TEST(LiveParameterTest, EveryCoefficientOfALawFollows) {
  const auto expect = [](const scene::Lia& lia, double at_one, double at_three) {
    const auto [one, three] = forceAtOneAndThree(lia);
    EXPECT_NEAR(one, at_one, 1e-9);
    EXPECT_NEAR(three, at_three, 1e-9);
  };
  scene::Lia power;
  power.type = LiaType::kPowerContact;
  power.stiffness = {100.0};
  power.law.edit().exponent = {1.0, 0};
  expect(power, 10.0, 0.1);
  power.law.edit().exponent = {2.0};
  power.damping = {0.5, 0};
  expect(power, 1.0 + 1.0, 1.0 + 3.0);
  power.damping = {0.0};
  power.law.edit().width = {0.1, 0};
  expect(power, 4.0, 16.0);
  scene::Lia cubic;
  cubic.type = LiaType::kCubic;
  cubic.stiffness = {10.0, 0};
  cubic.law.edit().nonlinearity = {1000.0};
  expect(cubic, 1.0 + 1.0, 3.0 + 1.0);
  cubic.stiffness = {10.0};
  cubic.law.edit().nonlinearity = {1000.0, 0};
  expect(cubic, 1.0 + 1.0, 1.0 + 3.0);
  scene::Lia conditional;
  conditional.type = LiaType::kConditional;
  conditional.stiffness = {10.0};
  conditional.law.edit().width = {0.05, 0};
  conditional.law.edit().release = 1.0;
  expect(conditional, 0.0, 1.0);
}

TEST(LiveParameterTest, MassMediumAndGainsFollow) {
  Live b;
  const int mass = b.mass(1.0, 0.0, 1.0);
  b.scene.mats[at(mass)].mass = {0.5, 0};
  b.scene.sections[0].medium = {100.0, 0};
  b.hear(mass, 0, Quantity::kVelocity);
  b.hear(mass, 1, Quantity::kVelocity);
  b.scene.outputs[1].gain = {2.0, 0};
  Player player(b.scene, {kRate, 1});
  player.tick();
  const double once = std::exp(-100.0 / 0.5 * kStep);
  EXPECT_NEAR(player.heard[0].back(), once, 1e-15);
  EXPECT_NEAR(player.heard[1].back(), 2.0 * once, 1e-15);
  Live::set(player, 4.0);
  player.tick();
  EXPECT_NEAR(player.heard[0].back(), once * once, 1e-15) << "medium over mass is the same";
  EXPECT_NEAR(player.heard[1].back(), 8.0 * once * once, 1e-15);
}

TEST(LiveParameterTest, WorkOfAChangeIsCountedInJoules) {
  for (const double unit : {1.0, 1.0 / kRate}) {
    Live b;
    b.scene.time_unit_s = unit;
    const int mass = b.mass(1e9, 0.01);
    b.scene.lias[at(b.spring(mass, b.ground(), 0.0))].stiffness = {2.0 * unit * unit, 0};
    Player player(b.scene, {kRate, 1});
    player.tick();
    Live::set(player, 5.0);
    player.ticks(2);
    const Energies energies = energiesOf(player);
    EXPECT_NEAR(energies.from_parameters, 0.5 * (10.0 - 2.0) * 1e-4, 1e-12);
    EXPECT_LT(std::abs(energies.residual), 1e-12 * energies.stored);
  }
}

}  // namespace
}  // namespace ergotic::physics
