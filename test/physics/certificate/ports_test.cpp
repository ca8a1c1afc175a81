// SPDX-License-Identifier: BSD-3-Clause
// Slices that ports move along some of their coordinates, and what a hand may meet there as the
// certificate sees it.

#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Vector3d;

/// A hand in a gestural section of this geometry, moved along these axes.
struct HandInSection : SceneBuilder {
  explicit HandInSection(Geometry geometry, const std::vector<int>& axes) : hand(slice(0)) {
    scene.sections[kGestural].geometry = geometry;
    scene.ports.front().axis = axes.front();
    for (std::size_t i = 1; i < axes.size(); ++i) {
      scene.ports.push_back(scene.ports.front());
      scene.ports.back().name += std::to_string(i);
      scene.ports.back().axis = axes[i];
      scene.ports.back().slice = -1;
    }
    validate(scene);
  }
  int massAt(const Vector3d& place, double kg) {
    return placed(mass(kg, 0.0, 0.0, kGestural), place);
  }
  int groundAt(const Vector3d& place) { return placed(ground(0.0, kGestural), place); }
  int placed(int mat, const Vector3d& place) {
    scene.mats[at(mat)].rest = scene.mats[at(mat)].position = place;
    return mat;
  }

  int hand;
};

Vector3d displacementOf(const Player& player, int mat) {
  std::vector<float> all(at(player.instrument->scene().coordinates()));
  player.instrument->readDisplacements(all.data());
  return {all[at(3 * mat)], all[at(3 * mat + 1)], all[at(3 * mat + 2)]};
}

class PortsTest : public testing::TestWithParam<Precision> {
 protected:
  double tolerance() const { return GetParam() == Precision::kFloat ? 2e-4 : 1e-11; }
};

TEST_P(PortsTest, SpringDragsAMassInSpaceAlongEveryAxisByItself) {
  constexpr double kStiffness = 300.0;
  constexpr double kMass = 0.05;
  HandInSection b(Geometry::kSpace, {2, 0, 1});
  const int mass = b.massAt(Vector3d::Zero(), kMass);
  b.spring(mass, b.hand, kStiffness);
  Player player(b.scene, kRates, GetParam());
  const Vector3d target(0.01, -0.02, 0.005);
  player.positions = {target.z(), target.x(), target.y()};
  const double omega = std::acos(1.0 - 0.5 * kTick * kTick * kStiffness / kMass);
  for (int n = 0; n < 200; ++n) {
    player.tick();
    const double gone = 1.0 - std::cos(omega * (n + 0.5)) / std::cos(0.5 * omega);
    const Vector3d seen(player.forces[1], player.forces[2], player.forces[0]);
    EXPECT_LT((seen - kStiffness * (gone - 1.0) * target).norm(), tolerance() * 6.0) << n;
    EXPECT_LT((displacementOf(player, mass) - gone * target).norm(), 1e-6) << n;
  }
}

TEST_P(PortsTest, SliceStaysAtRestAlongAxesWithoutAPort) {
  HandInSection b(Geometry::kSpace, {1});
  const Vector3d anchor(0.03, 0.04, 0.12);
  b.spring(b.groundAt(anchor), b.hand, 200.0);
  Player player(b.scene, kRates, GetParam());
  for (int n = 0; n < 50; ++n) {
    player.positions[0] = 1e-3 * n;
    player.tick();
    EXPECT_LT((displacementOf(player, b.hand) - Vector3d(0.0, 1e-3 * n, 0.0)).norm(), 1e-8);
    EXPECT_NEAR(player.forces[0], 200.0 * (anchor.y() - 1e-3 * n), tolerance() * 8.0);
  }
}

TEST_P(PortsTest, PositionIsCountedFromRestAlongEveryAxis) {
  HandInSection b(Geometry::kPlane, {0, 1});
  b.placed(b.hand, {0.5, -0.25, 0.0});
  b.spring(b.groundAt({0.5, -0.25, 0.0}), b.hand, 100.0);
  Player player(b.scene, kRates, GetParam());
  player.positions = {0.0, 0.0};
  player.tick();
  EXPECT_NEAR(player.forces[0], 0.0, tolerance());
  EXPECT_NEAR(player.forces[1], 0.0, tolerance());
  player.positions = {0.03, -0.01};
  player.tick();
  EXPECT_NEAR(player.forces[0], -3.0, tolerance());
  EXPECT_NEAR(player.forces[1], 1.0, tolerance());
}

TEST_P(PortsTest, HandThatIsElsewhereAtTheStartDidNotJumpAlongAnyAxis) {
  HandInSection b(Geometry::kSpace, {0, 1, 2});
  b.spring(b.groundAt({0.0, 0.0, 0.4}), b.hand, 0.0, 10.0);
  Player player(b.scene, kRates, GetParam());
  player.positions = {0.01, 0.02, 0.03};
  player.tick();
  EXPECT_EQ(player.forces, std::vector<double>(3, 0.0));
  player.positions = {0.01, 0.02, 0.0301};
  player.tick();
  const Vector3d line = Vector3d(0.01, 0.02, 0.0301 - 0.4).normalized();
  const Vector3d force = -10.0 * line.z() * 1e-4 / kTick * line;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(player.forces[at(k)], force[k], tolerance() * 4.0);
  }
}

TEST_P(PortsTest, WorkOfTheHandIsThatOfAllItsAxes) {
  HandInSection b(Geometry::kSpace, {0, 1, 2});
  const int mass = b.massAt({0.0, 0.0, 0.1}, 0.05);
  b.spring(mass, b.hand, 300.0, 0.5);
  b.spring(mass, b.groundAt({0.1, 0.2, 0.2}), 200.0, 0.1);
  Player player(b.scene, kRates, GetParam());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> step(-1e-3, 1e-3);
  double work = 0.0;
  for (int n = 0; n < 500; ++n) {
    const std::vector<double> last_positions = player.positions;
    const std::vector<double> last_forces = player.forces;
    for (double& x : player.positions) {
      x += n == 0 ? 0.0 : step(random);
    }
    player.tick();
    for (std::size_t k = 0; k < 3; ++k) {
      work -= 0.5 * (player.positions[k] - last_positions[k]) * (player.forces[k] + last_forces[k]);
    }
  }
  const Energies energies = energiesOf(player);
  EXPECT_GT(std::abs(work), 1e-2);
  EXPECT_NEAR(energies.sections[SceneBuilder::kGestural].from_device, work,
              tolerance() * std::abs(work) * 100.0);
}

TEST_P(PortsTest, SpaceMovedAlongXAloneIsALine) {
  const auto play = [](Geometry geometry, const std::vector<int>& axes) {
    HandInSection b(geometry, axes);
    const int near = b.massAt({0.1, 0.0, 0.0}, 0.05);
    const int far = b.massAt({0.25, 0.0, 0.0}, 0.02);
    b.spring(near, b.hand, 400.0, 0.3);
    b.spring(far, near, 500.0, 0.1);
    b.scene.lias.back().rest_length = 0.15;
    b.spring(far, b.groundAt({0.3, 0.0, 0.0}), 100.0);
    Player player(b.scene, kRates, GetParam());
    std::vector<double> felt;
    for (int n = 0; n < 400; ++n) {
      player.positions[0] = 0.01 * std::sin(0.05 * n);
      player.tick();
      felt.push_back(player.forces[0]);
    }
    return felt;
  };
  const std::vector<double> alone = play(Geometry::kSpace, {0});
  EXPECT_EQ(play(Geometry::kSpace, {0, 1, 2}), alone);
  const std::vector<double> line = play(Geometry::kLine, {0});
  for (std::size_t n = 0; n < line.size(); ++n) {
    EXPECT_NEAR(alone[n], line[n], tolerance() * 40.0) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Precisions,
                         PortsTest,
                         testing::Values(Precision::kFloat, Precision::kDouble));

const double kDeviceDamping = DeviceTraits{}.damping;
const double kLimit = 2.0 * kDeviceDamping * (kRate / 14.0) / 3.0;  // 2 b / ((1 + 2 d) T)

SceneBuilder wall(double stiffness, LiaType type = LiaType::kContact) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.link(type, slice, b.ground(0.0, SceneBuilder::kGestural), stiffness);
  return b;
}

/// A device of `mass` and `damping`, moved exactly between ticks by a force that is given one tick
/// late, pushing into a wall: largest eigenvalue of one tick of (x, v, force on its way).
double radiusOfHandOnWall(double stiffness, double mass, double damping) {
  const double t = 14.0 / kRate;
  const double decay = std::exp(-damping / mass * t);
  const double glide = mass / damping * (1.0 - decay);  // of a unit of v over a tick
  Eigen::Matrix3d step;
  step << 1.0, glide, (t - glide) / damping,  //
      0.0, decay, (1.0 - decay) / damping,    //
      -stiffness, 0.0, 0.0;                   // this tick's position, felt in the next
  return spectralRadius(step);
}

TEST(PassivityTest, LimitIsTwiceTheDampingOverThreeTicks) {
  const Certificate c = certify(wall(1000.0).scene, kRates);
  ASSERT_EQ(c.ports.size(), 1u);
  EXPECT_EQ(c.ports[0].port, 0);
  EXPECT_DOUBLE_EQ(c.ports[0].stiffness, 1000.0);
  EXPECT_DOUBLE_EQ(c.ports[0].stiffness_limit, kLimit);
  EXPECT_DOUBLE_EQ(certify(wall(1000.0).scene, kRates, {5.0, 1.0}).ports[0].stiffness_limit,
                   2.5 * kLimit);
}

TEST(PassivityTest, APortThatAnEndEffectorTookIsJudgedThere) {
  const scene::Scene scene = wall(2.5 * kLimit).scene;
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kUnproven);
  DeviceTraits device;
  device.taken_ports = {0};
  const Certificate certificate = certify(scene, kRates, device);
  EXPECT_EQ(certificate.verdict, Verdict::kPassive);
  EXPECT_GT(certificate.ports.at(0).stiffness, 2.0 * kLimit) << "it is told all the same";
}

TEST(PassivityTest, ADeviceOnAWallIsStableBelowTheLimitAndNotMuchAbove) {
  EXPECT_LT(radiusOfHandOnWall(0.98 * kLimit, 0.3, kDeviceDamping), 1.0);
  EXPECT_GT(radiusOfHandOnWall(1.02 * kLimit, 0.3, kDeviceDamping), 1.0);
}

TEST(PassivityTest, IsSilentBelowHalfWarnsAboveAndIsUnprovenAboveTwice) {
  EXPECT_TRUE(certify(wall(0.49 * kLimit).scene, kRates).findings.empty());
  const Certificate warned = certify(wall(0.51 * kLimit).scene, kRates);
  EXPECT_EQ(warned.verdict, Verdict::kPassive);
  EXPECT_THAT(warned.findings, Contains(HasSubstr("port 'port0': the hand may meet")));
  EXPECT_THAT(warned.findings, Contains(HasSubstr("by link 'l0'")));
  EXPECT_EQ(certify(wall(1.99 * kLimit).scene, kRates).verdict, Verdict::kPassive);
  const Certificate refused = certify(wall(2.01 * kLimit).scene, kRates);
  EXPECT_EQ(refused.verdict, Verdict::kUnproven);
  EXPECT_THAT(refused.findings, Contains(HasSubstr("it will buzz or jump")));
}

TEST(PassivityTest, ScalesOfThePortCount) {
  SceneBuilder b = wall(1000.0);
  b.scene.ports[0].force_scale = 3.0;
  b.scene.ports[0].position_scale = 0.5;
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports[0].stiffness, 6000.0);
}

TEST(PassivityTest, UnitsOfTheSceneCount) {
  SceneBuilder b = wall(2e-6);
  b.scene.time_unit_s = 1.0 / kRate;
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness, 2e-6 * kRate * kRate, 1e-9);
}

TEST(PassivityTest, LinksOfASliceAddUp) {
  SceneBuilder b = wall(1000.0);
  b.spring(0, b.ground(0.0, SceneBuilder::kGestural), 500.0);
  b.spring(0, b.mass(1.0), 250.0);
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports[0].stiffness, 1750.0);
}

TEST(PassivityTest, ThroughAFilterTheSeriesCounts) {
  SceneBuilder b = wall(3000.0);
  b.scene.mats[1].type = scene::MatType::kMass;
  b.scene.mats[1].mass = {0.01};
  b.scene.ports[0].filter = 1;
  b.spring(1, b.ground(0.0, SceneBuilder::kGestural), 4000.0);
  b.spring(1, b.ground(0.0, SceneBuilder::kGestural), 2000.0);
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness, 2000.0, 1e-9);
}

TEST(PassivityTest, ThroughAChapletTheSeriesCounts) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int first = b.mass(0.5e-3);
  const int second = b.mass(0.6e-3);
  b.spring(slice, first, 800.0, 2.0);
  b.spring(first, second, 6000.0);
  b.spring(second, b.ground(), 20000.0);
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness,
              1.0 / (1.0 / 800.0 + 1.0 / 6000.0 + 1.0 / 20000.0), 1e-9);
}

/// A spring and a damper to one mass are two links of it, as are the parts of a spring that is
/// split.
TEST(PassivityTest, LinksSideBySideAreNoSeries) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int mass = b.mass(0.1);
  b.spring(slice, mass, 800.0);
  b.spring(slice, mass, 0.0, 2.0);
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports[0].stiffness, 800.0);
}

/// By itself; with the others, as much as bounds what hands feel that move all of them.
TEST(PassivityTest, EveryAxisMeetsItsShareOfALinkThatActsAlongOne) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.scene.sections[SceneBuilder::kGestural].geometry = scene::Geometry::kSpace;
  b.scene.sections[SceneBuilder::kGestural].pose.rotate(
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()));
  b.spring(slice, b.ground(), 1000.0);
  const Vector3d along = b.scene.sections[SceneBuilder::kGestural].pose.linear().row(0);
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness, 1000.0 * along.x() * along.x(), 1e-9);
  for (int axis = 1; axis < 3; ++axis) {
    b.scene.ports.push_back(b.scene.ports[0]);
    b.scene.ports.back().axis = axis;
  }
  const Certificate c = certify(b.scene, kRates);
  double taken = 0.0;  // of the bound by K u u^T, u the axis of the link
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(c.ports[at(axis)].stiffness, 1000.0 * along[axis] * along[axis]);
    taken += 1000.0 * along[axis] * along[axis] / c.ports[at(axis)].stiffness;
  }
  EXPECT_NEAR(taken, 1.0, 1e-9);
}

TEST(PassivityTest, AnyAxisMayMeetAllOfALinkInSpace) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.scene.sections[SceneBuilder::kGestural].geometry = scene::Geometry::kSpace;
  b.scene.ports[0].axis = 2;
  b.spring(slice, b.ground(0.0, SceneBuilder::kGestural), 1000.0);
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports[0].stiffness, 1000.0);
}

TEST(PassivityTest, SteepestSlopeOfALawCounts) {
  SceneBuilder b = wall(1000.0, LiaType::kCubic);
  b.scene.lias[0].law.edit().nonlinearity = {1e9};
  // At a millimetre, as it has no steepest slope: K + 3 Q e^2.
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness, 1000.0 + 3e9 * 1e-6, 1e-9);
  b.scene.lias[0].type = LiaType::kPowerContact;
  b.scene.lias[0].stiffness = {1e6};
  b.scene.lias[0].law.edit().exponent = {2.0};
  EXPECT_NEAR(certify(b.scene, kRates).ports[0].stiffness, 2.0 * 1e6 * 1e-3, 1e-9);
}

TEST(PassivityTest, ASliceWithoutStiffLinksIsFree) {
  SceneBuilder b;
  b.spring(b.slice(0), b.ground(0.0, SceneBuilder::kGestural), 0.0, 1.0);
  b.slice(1);
  const Certificate c = certify(b.scene, kRates);
  EXPECT_EQ(c.ports[0].stiffness, 0.0);
  EXPECT_EQ(c.ports[1].stiffness, 0.0);
  EXPECT_TRUE(c.findings.empty());
}

/// Two slices against one another, each moved exactly by a force that is held and one tick late:
/// their difference moves as one slice does on a spring of twice the stiffness.
TEST(PassivityTest, ASliceThatIsJoinedToAnotherMayMeetTwiceTheLink) {
  const auto joined = [](double stiffness, double damping) {
    SceneBuilder b;
    const int first = b.slice(0);
    b.spring(first, b.slice(1), stiffness, damping);
    return certify(b.scene, kRates);
  };
  EXPECT_LT(radiusOfHandOnWall(2.0 * 0.49 * kLimit, 0.3, kDeviceDamping), 1.0);
  EXPECT_GT(radiusOfHandOnWall(2.0 * 0.51 * kLimit, 0.3, kDeviceDamping), 1.0);
  const Certificate soft = certify(wall(600.0).scene, kRates);
  const Certificate both = joined(300.0, 20.0);
  EXPECT_DOUBLE_EQ(both.ports.at(1).stiffness, soft.ports.at(0).stiffness);
  EXPECT_DOUBLE_EQ(both.ports.at(1).damping, 40.0);
  EXPECT_EQ(joined(0.99 * kLimit, 0.0).verdict, Verdict::kPassive);
  EXPECT_EQ(joined(1.01 * kLimit, 0.0).verdict, Verdict::kUnproven);
}

TEST(PassivityTest, ALightMassBetweenTwoSlicesIsNoWall) {
  SceneBuilder b;
  const int first = b.slice(0);
  const int between = b.mass(1e-3);
  b.spring(first, between, 1000.0);
  b.spring(between, b.slice(1), 1000.0);
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports.at(0).stiffness, 1000.0);
}

/// A slice that is only joined to what no force moves is in no network.
TEST(PassivityTest, WhatDrivesAHandIsNotProven) {
  const auto judged = [](LiaType type, double k, double z, double q, Scheme scheme) {
    SceneBuilder b = wall(k, type);
    b.scene.lias[0].damping = {z};
    b.scene.lias[0].scheme = scheme;
    b.scene.lias[0].law.edit().nonlinearity = {q};
    return certify(b.scene, kRates);
  };
  const auto explicitly = Scheme::kExplicit;
  for (const Certificate& c : {judged(LiaType::kSpringDamper, -100.0, 0.0, 0.0, explicitly),
                               judged(LiaType::kSpringDamper, 0.0, -10.0, 0.0, explicitly),
                               judged(LiaType::kQuadratic, 100.0, 0.0, -1e4, explicitly),
                               judged(LiaType::kCubic, 100.0, 0.0, -1e6, explicitly)}) {
    EXPECT_EQ(c.verdict, Verdict::kUnproven);
    EXPECT_THAT(c.findings, Contains(HasSubstr("link 'l0' has a negative stiffness, damping or")));
  }
  EXPECT_EQ(judged(LiaType::kCubic, 100.0, 1.0, 1e6, explicitly).verdict, Verdict::kPassive);
}

}  // namespace
}  // namespace ergotic::physics
