// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "physics/settling/steps.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A hammer of the gestural section, on a soft spring, that hits a string.
SceneBuilder hammered(Scheme scheme = Scheme::kAuto) {
  SceneBuilder b;
  const int first = b.chain(8, 1e-3, 0.3 * 1e-3 * kRate * kRate);
  const int hammer = b.mass(0.01, -0.002, 2.0, SceneBuilder::kGestural);
  b.spring(hammer, b.ground(0.0, SceneBuilder::kGestural), 100.0);
  b.link(LiaType::kContact, hammer, first + 4, 1e4);
  b.scene.lias.back().scheme = scheme;
  return b;
}

TEST(RaiseRatesTest, HammerOfASlowerSectionMovesAtTheRateOfItsString) {
  const Settled settled = settle(hammered().scene, kRates);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 1);
  EXPECT_EQ(settled.scene.sections.size(), 2U);
  EXPECT_THAT(settled.notes, Contains(HasSubstr("is stepped at 44100 Hz, not at 3150, because "
                                                "link 'l10' is not linear")));
  EXPECT_EQ(certify(settled.scene, kRates).verdict, Verdict::kPassive);
}

TEST(RaiseRatesTest, WhoChoosesTheSchemeKeepsTheRate) {
  const Settled settled = settle(hammered(Scheme::kExplicit).scene, kRates);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 14);
  EXPECT_EQ(certify(settled.scene, kRates).verdict, Verdict::kUnproven);
}

TEST(RaiseRatesTest, SlicesAndDrivenModulesStayWhereTheyAre) {
  SceneBuilder b = hammered();
  const int slice = b.slice(0);
  const int driven = b.driven(0);
  b.scene.mats[at(driven)].section = SceneBuilder::kGestural;
  const int hammer = b.scene.lias.back().a;
  b.spring(slice, hammer, 500.0, 1.0);
  const Settled settled = settle(b.scene, kRates);
  ASSERT_EQ(settled.scene.sections.size(), 3U);
  EXPECT_EQ(settled.scene.sections[2].name, b.scene.sections[1].name + ".raised");
  EXPECT_EQ(settled.scene.mats[at(hammer)].section, 2);
  EXPECT_EQ(settled.scene.mats[at(slice)].section, SceneBuilder::kGestural);
  EXPECT_EQ(settled.scene.mats[at(driven)].section, SceneBuilder::kGestural);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 14);
  EXPECT_EQ(certify(settled.scene, kRates).verdict, Verdict::kPassive);
}

/// A bridge on a string, which a rattle touches: not the link between the rates is not linear.
TEST(RaiseRatesTest, RattleBesideASlowBridge) {
  SceneBuilder b;
  const int first = b.chain(8, 1e-3, 0.3 * 1e-3 * kRate * kRate);
  const int bridge = b.mass(0.1, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(bridge, b.ground(0.0, SceneBuilder::kGestural), 1e4, 1.0);
  b.spring(bridge, first + 8, 1e4);
  b.link(LiaType::kContact, bridge, b.ground(0.0, SceneBuilder::kGestural), 1e4);
  b.scene.lias.back().scheme = Scheme::kAuto;
  const Settled settled = settle(b.scene, kRates);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 1);
  EXPECT_EQ(certify(settled.scene, kRates).verdict, Verdict::kPassive);
}

TEST(RaiseRatesTest, BehindAChapletItKeepsItsRate) {
  SceneBuilder b = hammered();
  b.scene.lias.back().filtered = true;
  b.scene.mats[at(b.scene.lias.back().a)].mass = {50.0};  // chaplets are a tenth at most
  const Settled settled = settle(b.scene, kRates);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 14);
}

TEST(RaiseRatesTest, TheFastestOfItsNeighboursCounts) {
  SceneBuilder b = hammered();
  b.scene.sections.push_back(b.scene.sections[0]);
  b.scene.sections.back().name = "middle";
  b.scene.sections.back().divisor = 7;
  const int hammer = b.scene.lias.back().a;
  b.spring(hammer, b.mass(0.1, 0.0, 0.0, 2), 10.0);
  std::swap(b.scene.lias.front(), b.scene.lias.back());  // it comes first
  EXPECT_THAT(settle(b.scene, kRates).notes,
              Contains(HasSubstr("is stepped at 44100 Hz, not at 3150")));
}

TEST(RaiseRatesTest, WhatIsLargeKeepsItsRate) {
  SceneBuilder b = hammered();
  const int anchor = b.scene.lias.back().a;
  for (int i = 0; i < 120; ++i) {
    b.spring(anchor, b.mass(0.1, 0.0, 0.0, SceneBuilder::kGestural), 10.0);
  }
  const Settled settled = settle(b.scene, kRates);
  EXPECT_EQ(divisorOf(settled.scene.sections[SceneBuilder::kGestural], kRates), 14);
}

}  // namespace
}  // namespace ergotic::physics
