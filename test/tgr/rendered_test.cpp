// SPDX-License-Identifier: BSD-3-Clause

#include <random>

#include "ergotic/tgr/rig.hpp"
#include "support/test.hpp"
#include "tgr/kinematics_cases.hpp"
#include "tgr/rig_scenes.hpp"

namespace ergotic::tgr {
namespace {

using test::endEffector;
using test::endEffectors;

TEST(RenderedTest, IsThatOfThePortsWhereASliceMovesThemByItself) {
  test::PortScene ports;
  ports.port("a", 3).position_scale = 0.1;  // in the stiffness already
  ports.port("b", 3);
  ports.port("free");
  const auto rendered = renderedAtSlices(ports.scene, {}, {100.0, 20.0, 7.0});
  ASSERT_EQ(rendered.size(), 1U);
  EXPECT_EQ(rendered[0].slice, 3);
  EXPECT_DOUBLE_EQ(rendered[0].alone, 120.0);
  EXPECT_DOUBLE_EQ(rendered[0].together, 120.0);
}

TEST(TakenPortsTest, AreThoseWhosePortOrSliceAnEndEffectorHas) {
  test::PortScene ports;
  ports.port("own", 0);
  ports.port("claimed", 1);
  ports.port("robbed", 2);
  ports.port("free");
  const EndEffectorConfig key = endEffector(EndEffectorType::kKey, {2}, {"claimed"});
  EXPECT_THAT(takenPorts(ports.scene, {}), IsEmpty());
  EXPECT_THAT(takenPorts(ports.scene, endEffectors({key})), ElementsAre(1, 2));
}

TEST(RenderedTest, GrowsWithTheSquareOfALever) {
  test::PortScene ports;
  ports.port("key");
  EndEffectorConfig key = endEffector(EndEffectorType::kKey, {2}, {"key"});
  key.lever = 3.0;
  key.position_scale = 0.5;
  key.force_scale = 4.0;
  const auto rendered = renderedAtSlices(ports.scene, endEffectors({key}), {10.0});
  ASSERT_EQ(rendered.size(), 1U);
  EXPECT_DOUBLE_EQ(rendered[0].alone, 9.0 * 10.0 * 4.0 / 0.5);
}

TEST(RenderedTest, CountsSlicesThatPushTogether) {
  test::PortScene ports;
  ports.port("along");
  ports.port("pressure");
  EndEffectorConfig bow = endEffector(EndEffectorType::kBow, {0, 1}, {"along", "pressure"});
  bow.angle = 0.78539816339744830962;  // each slice feels half of both, together they feel one
  const auto rendered = renderedAtSlices(ports.scene, endEffectors({bow}), {1000.0, 200.0});
  ASSERT_EQ(rendered.size(), 2U);
  for (const Rendered& slice : rendered) {
    EXPECT_NEAR(slice.alone, 600.0, 1e-9);
    EXPECT_NEAR(slice.together, 1000.0, 1e-9);
  }
}

TEST(RenderedTest, IsAThirdOfAPushOnABallForEachOfItsSlices) {
  test::PortScene ports;
  ports.port("z");
  const auto rendered = renderedAtSlices(
      ports.scene, endEffectors({endEffector(EndEffectorType::kBall, {5, 6, 7}, {"", "", "z"})}),
      {900.0});
  ASSERT_EQ(rendered.size(), 3U);
  for (const Rendered& slice : rendered) {
    EXPECT_NEAR(slice.alone, 100.0, 1e-10);
    EXPECT_NEAR(slice.together, 300.0, 1e-10);
  }
}

/// A device under one end-effector of each kind and a few ports by themselves; all scales differ.
class WholeDevice {
 public:
  WholeDevice() {
    int slice = 0;
    for (test::KinematicsCase& c : test::kinematicsCases()) {
      EndEffectorConfig& config = c.config;
      config.name = c.name;
      for (int& s : config.slices) {
        s = slice++;
      }
      config.position_scale = 0.3 + 0.1 * slice;
      config.force_scale = 2.0 - 0.07 * slice;
      kinematics_.push_back(makeKinematics(config, ""));
      for (int k = 0; k < kinematics_.back()->coordinates(); ++k) {
        config.ports.push_back(config.name + std::to_string(k));
        scalesOf(ports_.port(config.ports.back()));
      }
      end_effectors_.list.push_back(config);
    }
    for (int i = 0; i < 3; ++i) {
      scalesOf(ports_.port("direct" + std::to_string(i), slice++));
    }
    slices_ = slice;
    rig_ = makeRig(ports_.scene, end_effectors_, slices_);
  }

  Rig& rig() { return *rig_; }
  int slices() const { return slices_; }
  const std::vector<scene::Port>& ports() const { return ports_.scene.ports; }

  /// Speeds of the ports in the model and their energy scales, from the kinematics alone.
  void speeds(const double* q,
              const double* q_dot,
              std::vector<double>& speed,
              std::vector<double>& energy_scale) const {
    std::size_t p = 0;
    for (std::size_t e = 0; e < kinematics_.size(); ++e) {
      const EndEffectorConfig& config = end_effectors_.list[e];
      const int first = config.slices.front();
      test::Coordinates x{};
      test::JacobianRows rows{};
      ASSERT_TRUE(kinematics_[e]->forward(q + first, x.data(), rows.data()));
      for (int k = 0; k < kinematics_[e]->coordinates(); ++k, ++p) {
        double v = 0.0;
        for (int i = 0; i < kinematics_[e]->slices(); ++i) {
          v += rows[static_cast<std::size_t>(k * kinematics_[e]->slices() + i)] * q_dot[first + i];
        }
        speed[p] = v / config.position_scale / ports()[p].position_scale;
        energy_scale[p] = config.position_scale * config.force_scale * ports()[p].position_scale *
                          ports()[p].force_scale;
      }
    }
    for (; p < ports().size(); ++p) {
      speed[p] = q_dot[ports()[p].slice] / ports()[p].position_scale;
      energy_scale[p] = ports()[p].position_scale * ports()[p].force_scale;
    }
  }

 private:
  void scalesOf(scene::Port& port) {
    const auto n = static_cast<double>(ports_.scene.ports.size());
    port.offset = 0.001 * n;
    port.position_scale = 0.5 + 0.2 * n;
    port.force_scale = 3.0 / n;
  }

  test::PortScene ports_;
  EndEffectors end_effectors_;
  std::vector<std::unique_ptr<Kinematics>> kinematics_;
  std::unique_ptr<Rig> rig_;
  int slices_ = 0;
};

TEST(RigPowerTest, PassesPowerTimesTheEnergyScalesAtRandomPoses) {
  WholeDevice device;
  const std::size_t ports = device.ports().size();
  const auto slices = static_cast<std::size_t>(device.slices());
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<double> q(slices), q_dot(slices), device_force(slices);
  std::vector<double> x(ports), force(ports), speed(ports), energy_scale(ports);
  int checked = 0;
  while (checked < 100000) {
    for (std::size_t s = 0; s < slices; ++s) {
      q[s] = 0.03 * number(random);
      q_dot[s] = number(random);
    }
    if (device.rig().toModel(q.data(), 0.0, x.data()) != 0) {
      continue;
    }
    double model_power = 0.0;
    double gross = 0.0;
    device.speeds(q.data(), q_dot.data(), speed, energy_scale);
    for (std::size_t p = 0; p < ports; ++p) {
      force[p] = number(random);
      model_power += energy_scale[p] * force[p] * speed[p];
      gross += std::abs(energy_scale[p] * force[p] * speed[p]);
    }
    device.rig().toDevice(force.data(), device_force.data());
    double device_power = 0.0;
    for (std::size_t s = 0; s < slices; ++s) {
      device_power += device_force[s] * q_dot[s];
    }
    ASSERT_NEAR(device_power, model_power, 1e-12 * gross) << "pose " << checked;
    ++checked;
  }
}

}  // namespace
}  // namespace ergotic::tgr
