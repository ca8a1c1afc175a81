// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/attached.hpp"

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using testing::UnorderedElementsAre;

/// A string on a slice, and what is joined to a place on it.
TEST(AttachedTest, WhatIsJoinedToPointsIsAttachedThereToo) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int first = b.mass(1.0);
  const int second = b.mass(1.0);
  const int point = b.point(b.grid(first, 2), 0.5);
  const int behind = b.mass(1.0);
  const int ground = b.ground();
  const int apart = b.mass(1.0);
  b.spring(slice, first, 1.0);
  b.spring(first, second, 1.0);
  b.spring(point, behind, 1.0);
  b.spring(behind, ground, 1.0);
  b.spring(apart, ground, 1.0);
  const Network network(b.scene);
  const Hands hands = handsOn(b.scene, {slice});
  const Attached attached = attachedTo(slice, network, hands, 100);
  EXPECT_THAT(attached.nodes, UnorderedElementsAre(slice, first, second, point, behind));
  EXPECT_EQ(attached.masses, 3);
  const scene::Scene alone = onlyOf(attached, b.scene);
  EXPECT_EQ(alone.lias.size(), 4U) << "all but that of the mass apart";
  EXPECT_EQ(alone.mats.at(at(apart)).type, scene::MatType::kGround);
}

}  // namespace
}  // namespace ergotic::physics
