// SPDX-License-Identifier: BSD-3-Clause
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Vector3d;

Eigen::Isometry3d poseOf(double angle, const Vector3d& axis, const Vector3d& place) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(place).rotate(Eigen::AngleAxisd(angle, axis.normalized()));
  return pose;
}

/// A scalar section 0, and a section 2 in space, each in a frame of its own.
struct TwoFrames : SceneBuilder {
  static constexpr int kSpace = 2;
  TwoFrames() {
    scene::Section space;
    space.name = "space";
    space.geometry = Geometry::kSpace;
    space.pose = poseOf(0.7, {1.0, 2.0, -1.0}, {0.3, -0.1, 0.2});
    scene.sections.push_back(space);
    scene.sections[0].pose = poseOf(-1.2, {0.5, -1.0, 2.0}, {-0.2, 0.4, 0.1});
  }
  /// The x axis of section 0, and where it starts, seen from the section in space.
  Vector3d axis() const {
    return scene.sections[2].pose.linear().transpose() * scene.sections[0].pose.linear().col(0);
  }
  Vector3d origin() const {
    return scene.sections[2].pose.inverse() * scene.sections[0].pose.translation();
  }
};

Vector3d heardLast(const Player& player, int first_channel) {
  return {player.heard[at(first_channel)].back(), player.heard[at(first_channel + 1)].back(),
          player.heard[at(first_channel + 2)].back()};
}

TEST(MixedGeometryTest, ScalarLinkSeesSpaceAlongItsAxisAndPushesAlongIt) {
  TwoFrames b;
  const int driven = b.driven(0);
  const int in_space = b.ground(0.0, TwoFrames::kSpace);
  const Vector3d place(0.4, -0.3, 0.9);
  b.scene.mats[at(in_space)].position = place;
  b.scene.mats[at(in_space)].rest = Vector3d(1.0, 1.0, 1.0);
  b.spring(driven, in_space, 1000.0);
  b.hearAxes(in_space, 0, Quantity::kForce);
  b.hear(driven, 3, Quantity::kForce);
  Player player(b.scene, {kRate, 1});
  player.inputs = {0.25};
  player.tick();
  const double force = 1000.0 * (0.25 - b.axis().dot(place - b.origin()));
  EXPECT_NEAR(player.heard[3].back(), -force, 1e-10);
  EXPECT_LT((heardLast(player, 0) - force * b.axis()).norm(), 1e-10);
}

TEST(MixedGeometryTest, PlaneSeesSpaceInItsOwnTwoAxes) {
  TwoFrames b;
  b.scene.sections[0].geometry = Geometry::kPlane;
  const int wall = b.ground();
  b.scene.mats[at(wall)].position = {0.5, 0.25, 0.0};
  const int in_space = b.ground(0.0, TwoFrames::kSpace);
  const Vector3d place(0.4, -0.3, 0.9);
  b.scene.mats[at(in_space)].position = place;
  const int l = b.spring(in_space, wall, 1000.0);
  b.scene.lias[at(l)].rest_length = 0.1;
  b.hearAxes(in_space, 0, Quantity::kForce);
  Player player(b.scene, {kRate, 1});
  player.tick();
  const Eigen::Isometry3d to_plane = b.scene.sections[0].pose.inverse() * b.scene.sections[2].pose;
  Vector3d apart = to_plane * place - Vector3d(0.5, 0.25, 0.0);
  apart.z() = 0.0;
  const Vector3d force = -1000.0 * (apart.norm() - 0.1) * apart.normalized();
  EXPECT_LT((heardLast(player, 0) - to_plane.linear().transpose() * force).norm(), 1e-10);
}

/// A scalar hammer flies at the middle of a free square of nine masses in space.
TwoFrames hammerAndMesh() {
  TwoFrames b;
  const int hammer = b.mass(5e-3, -0.01, 4.0);
  const int first = static_cast<int>(b.scene.mats.size());
  for (int i = 0; i < 9; ++i) {
    const int m = b.mass(1e-3, 0.0, 0.0, TwoFrames::kSpace);
    const Vector3d in_plane(0.1 * (i % 3 - 1), 0.1 * (i / 3 - 1), 0.0);
    b.scene.mats[at(m)].rest = b.origin() + in_plane;
    b.scene.mats[at(m)].position = b.origin() + in_plane;
  }
  for (int i = 0; i < 9; ++i) {
    for (const int step : {1, 3}) {
      if ((step == 1 && i % 3 < 2) || (step == 3 && i < 6)) {
        const int l = b.spring(first + i, first + i + step, 2e3);
        b.scene.lias[at(l)].rest_length = 0.09;
      }
    }
  }
  b.link(LiaType::kContact, hammer, first + 4, 3e3);
  b.hear(hammer, 0, Quantity::kVelocity);
  for (int i = 0; i < 9; ++i) {
    b.hearAxes(first + i, 1 + 3 * i, Quantity::kVelocity);
  }
  return b;
}

TEST(MixedGeometryTest, ScalarHammerOnAMeshInSpaceKeepsMomentumAlongItsAxis) {
  const TwoFrames b = hammerAndMesh();
  Player player(b.scene, {kRate, 14});
  player.ticks(200);
  Vector3d mesh = Vector3d::Zero();
  for (int i = 0; i < 9; ++i) {
    mesh += 1e-3 * heardLast(player, 1 + 3 * i);
  }
  const double hammer = 5e-3 * player.heard[0].back();
  EXPECT_LT(hammer, 0.9 * 5e-3 * 4.0) << "it was slowed down";
  EXPECT_NEAR(hammer + b.axis().dot(mesh), 5e-3 * 4.0, 1e-15);
  EXPECT_LT((mesh - b.axis() * b.axis().dot(mesh)).norm(), 1e-15);
}

TEST(MixedGeometryTest, EnergyBalancesBetweenTheGeometries) {
  Player player(hammerAndMesh().scene, {kRate, 14});
  player.ticks(1000);
  const Energies energies = energiesOf(player);
  EXPECT_LT(std::abs(energies.residual), 1e-12 * energies.stored);
  EXPECT_GT(energies.sections[2].kinetic, 1e-3);
}

/// A slow scalar mass on a spring to a place between four masses of a square in space.
TwoFrames slowMassAndMesh() {
  TwoFrames b;
  b.scene.sections[0].gestural = true;
  const int slow = b.mass(0.05, 0.0, 0.5);
  const int first = static_cast<int>(b.scene.mats.size());
  for (int i = 0; i < 4; ++i) {
    const int m = b.mass(1e-3, 0.0, 0.0, TwoFrames::kSpace);
    b.scene.mats[at(m)].rest = b.origin() + Vector3d(0.1 * (i % 2), 0.1 * (i / 2), 0.0);
    b.scene.mats[at(m)].position = b.scene.mats[at(m)].rest;
    b.hearAxes(m, 1 + 3 * i, Quantity::kVelocity);
  }
  for (const auto& [i, j] : {std::pair(0, 1), {1, 3}, {3, 2}, {2, 0}, {0, 3}}) {
    b.spring(first + i, first + j, 50.0, 1e-3);
  }
  b.spring(slow, b.point(b.grid(first, 2, 2), 0.3, 0.6), 40.0, 1e-3);
  b.hear(slow, 0, Quantity::kVelocity);
  return b;
}

TEST(MixedGeometryTest, PointsFramesAndRatesTogetherKeepMomentumAndEnergyBalances) {
  const TwoFrames b = slowMassAndMesh();
  Player player(b.scene, {kRate, 14});
  for (int n = 0; n < 1000; ++n) {
    player.tick();
    const Energies energies = energiesOf(player);
    ASSERT_LT(std::abs(energies.residual), 1e-12 * energies.stored) << n;
    // At the start of a slow step the mean force of the last one has arrived.
    double momentum = 0.05 * player.heard[0][at(14 * n)];
    for (int axis = 0; axis < 12; ++axis) {
      momentum += 1e-3 * b.axis()[axis % 3] * player.heard[at(1 + axis)][at(14 * n)];
    }
    ASSERT_NEAR(momentum, 0.05 * 0.5, 1e-14) << n;
  }
  EXPECT_GT(energiesOf(player).couplings[0].dissipated, 1e-9);
  EXPECT_LT(player.heard[0].back(), 0.495) << "the square was set going";
}

/// Two driven points of a plane: the first link joins them. Force on the second.
Vector3d planeForce(LiaType type, const Vector3d& from, const Vector3d& to, double width) {
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kPlane;
  const int moved = b.driven(0);
  b.scene.inputs.push_back(b.scene.inputs[0]);
  b.scene.inputs[1].channel = 1;
  b.scene.inputs[1].axis = 1;
  const int ground = b.ground();
  b.link(type, moved, ground, 100.0, 2.0);
  b.scene.lias[0].law.edit().width = {width};
  b.hearAxes(ground, 0, Quantity::kForce);
  Player player(b.scene, {kRate, 2});
  player.inputs = {from.x(), from.y(), to.x(), to.y()};
  player.tick();
  return {player.heard[0].back(), player.heard[1].back(), 0.0};
}

TEST(MixedGeometryTest, FrictionInAPlaneActsAlongTheVelocity) {
  const Vector3d direction(0.6, -0.8, 0.0);
  const Vector3d from(0.3, 0.1, 0.0);
  const double v = 0.05;
  const Vector3d force = planeForce(LiaType::kBow, from, from + direction * v / kRate, 0.3);
  EXPECT_LT((force - 2.0 / 3.0 * 2.0 * v * direction).norm(), 1e-9);
}

TEST(MixedGeometryTest, FrictionWithoutVelocityIsNone) {
  const Vector3d here(0.3, 0.1, 0.0);
  EXPECT_EQ(planeForce(LiaType::kSmoothBow, here, here, 0.3).norm(), 0.0);
}

TEST(MixedGeometryTest, ContactInAPlanePushesApart) {
  const Vector3d here(0.3, 0.4, 0.0);
  // 0.5 m away where 0.6 m is asked for: the ground is pushed away from the point.
  const Vector3d force = planeForce(LiaType::kContact, here, here, 0.6);
  EXPECT_LT((force + 100.0 * 0.1 * here / 0.5).norm(), 1e-9);
  EXPECT_EQ(planeForce(LiaType::kContact, here, here, 0.49).norm(), 0.0);
}

TEST(MixedGeometryTest, ModulesInOnePlaceHaveNoDirectionAndNoForce) {
  EXPECT_EQ(planeForce(LiaType::kContact, Vector3d::Zero(), Vector3d::Zero(), 0.6).norm(), 0.0);
}

}  // namespace
}  // namespace ergotic::physics
