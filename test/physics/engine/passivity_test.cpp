// SPDX-License-Identifier: BSD-3-Clause
// What a hand may meet at a slice, as the certificate sees it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr Rates kRates{kRate, 14};
const double kDeviceDamping = DeviceTraits{}.damping;
const double kLimit = 2.0 * kDeviceDamping * (kRate / 14.0) / 3.0;  // 2 b / ((1 + 2 d) T)

SceneBuilder wall(double stiffness, LiaType type = LiaType::kContact) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.link(type, slice, b.ground(0.0, SceneBuilder::kGestural), stiffness);
  return b;
}

bool has(const Certificate& c, const std::string& text) {
  return std::any_of(c.findings.begin(), c.findings.end(), [&](const std::string& finding) {
    return finding.find(text) != std::string::npos;
  });
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
  EXPECT_DOUBLE_EQ(c.ports[0].limit, kLimit);
  EXPECT_DOUBLE_EQ(certify(wall(1000.0).scene, kRates, {5.0, 1.0}).ports[0].limit, 2.5 * kLimit);
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
  EXPECT_TRUE(has(warned, "port 'port0': the hand may meet"));
  EXPECT_TRUE(has(warned, "by link 'l0'"));
  EXPECT_EQ(certify(wall(1.99 * kLimit).scene, kRates).verdict, Verdict::kPassive);
  const Certificate refused = certify(wall(2.01 * kLimit).scene, kRates);
  EXPECT_EQ(refused.verdict, Verdict::kUnproven);
  EXPECT_TRUE(has(refused, "it will buzz or jump"));
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

TEST(PassivityTest, EveryAxisMeetsItsShareOfALinkThatActsAlongOne) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.scene.sections[SceneBuilder::kGestural].geometry = scene::Geometry::kSpace;
  b.scene.sections[SceneBuilder::kGestural].pose.rotate(
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()));
  for (int axis = 1; axis < 3; ++axis) {
    b.scene.ports.push_back(b.scene.ports[0]);
    b.scene.ports.back().axis = axis;
  }
  b.spring(slice, b.ground(), 1000.0);
  const Certificate c = certify(b.scene, kRates);
  const Eigen::Matrix3d turned = b.scene.sections[SceneBuilder::kGestural].pose.linear();
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double stiffness = c.ports[static_cast<std::size_t>(axis)].stiffness;
    EXPECT_NEAR(stiffness, 1000.0 * turned(0, axis) * turned(0, axis), 1e-9);
    sum += stiffness;
  }
  EXPECT_NEAR(sum, 1000.0, 1e-9);
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

}  // namespace
}  // namespace ergotic::physics
