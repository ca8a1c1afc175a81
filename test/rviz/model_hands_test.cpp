// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_hands.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

const std::vector<std::string> kLaws = {"spring-damper", "contact", "felt", "pluck", "friction"};

/// A string of 30 modules along y, from 0 to 0.29 m.
struct Stage : StructureMaker {
  Stage() {
    structure.law_names = kLaws;
    string(30, 0.0F);
  }
  void link(std::uint32_t a, std::uint32_t b, const std::string& law) {
    StructureMaker::link(a, b);
    structure.link_types.back() =
        static_cast<std::uint8_t>(std::find(kLaws.begin(), kLaws.end(), law) - kLaws.begin());
  }
  std::uint32_t hand(float x = -0.01F) { return module(ModelStructure::SLICE, x, 0.0F, 0.0F); }
  std::uint32_t mass(float x = -0.01F) { return module(ModelStructure::MASS, x, 0.0F, 0.0F); }
  HandBody bodyOf(std::uint32_t module) const {
    const ModelShape shape = shapeOf(structure);
    const auto at = std::find(shape.bodies.begin(), shape.bodies.end(), module);
    return handsOf(structure, shape).at(static_cast<std::size_t>(at - shape.bodies.begin()));
  }
};

TEST(ModelHandsTest, AHandIsWhatItDoes) {
  Stage stage;
  const std::uint32_t plectrum = stage.hand();
  stage.link(plectrum, 20, "pluck");
  const std::uint32_t finger = stage.hand(0.01F);
  stage.link(17, finger, "contact");
  const std::uint32_t key = stage.hand();
  const std::uint32_t hammer = stage.mass();
  stage.link(key, hammer, "contact");
  stage.link(hammer, 10, "contact");
  const std::uint32_t frog = stage.hand();
  const std::uint32_t hair = stage.mass();
  stage.link(frog, hair, "spring-damper");
  stage.link(25, hair, "friction");
  const std::uint32_t grip = stage.hand();
  const std::uint32_t head = stage.mass();
  stage.link(grip, head, "spring-damper");
  stage.link(head, 5, "felt");
  const std::uint32_t alone = stage.hand();
  EXPECT_EQ(stage.bodyOf(plectrum).form, HandForm::kPlectrum);
  EXPECT_EQ(stage.bodyOf(finger).form, HandForm::kFinger);
  EXPECT_EQ(stage.bodyOf(key).form, HandForm::kKey);
  EXPECT_EQ(stage.bodyOf(hammer).form, HandForm::kHammer);
  EXPECT_EQ(stage.bodyOf(frog).form, HandForm::kKey);
  EXPECT_EQ(stage.bodyOf(hair).form, HandForm::kBow);
  EXPECT_EQ(stage.bodyOf(head).form, HandForm::kHammer);
  EXPECT_EQ(stage.bodyOf(alone).form, HandForm::kNone);
}

TEST(ModelHandsTest, ATipThatAHandHoldsIsAFinger) {
  Stage stage;
  const std::uint32_t tip = stage.mass(0.01F);
  stage.link(stage.hand(0.01F), tip, "spring-damper");
  stage.link(9, tip, "contact");
  EXPECT_EQ(stage.bodyOf(tip).form, HandForm::kFinger);
}

TEST(ModelHandsTest, AHandPointsAtWhatItTouchesAndLiesAcrossIt) {
  Stage stage;
  for (const float x : {-0.01F, 0.01F}) {
    const std::uint32_t hand = stage.hand(x);
    stage.link(hand, 12, "felt");
    const HandBody body = stage.bodyOf(hand);
    EXPECT_NEAR(body.towards.x(), x < 0.0F ? 1.0F : -1.0F, 1e-6F);
    EXPECT_NEAR(std::abs(body.along.y()), 1.0F, 1e-6F);
  }
}

Eigen::Vector3f placeOf(const ModelStructure& structure, std::uint32_t module) {
  return restOf(structure, module);
}

TEST(ModelHandsTest, WhatStandsElsewhereIsPutBesideWhatItTouches) {
  Stage stage;
  const std::uint32_t grip = stage.hand(-0.02F);
  const std::uint32_t head = stage.mass(-0.01F);
  const std::uint32_t home = stage.module(ModelStructure::GROUND, -0.03F, 0.0F, 0.0F);
  stage.link(grip, head, "spring-damper");
  stage.link(head, home, "spring-damper");
  stage.link(head, 24, "felt");
  const ModelStructure placed = withHandsInPlace(stage.structure);
  EXPECT_LT((placeOf(placed, head) - Eigen::Vector3f(-0.01F, 0.24F, 0.0F)).norm(), 1e-6F);
  EXPECT_LT((placeOf(placed, grip) - Eigen::Vector3f(-0.02F, 0.24F, 0.0F)).norm(), 1e-6F);
  EXPECT_LT((placeOf(placed, home) - Eigen::Vector3f(-0.03F, 0.24F, 0.0F)).norm(), 1e-6F);
  for (std::uint32_t i = 0; i < 30; ++i) {
    EXPECT_EQ(placeOf(placed, i), placeOf(stage.structure, i));
  }
}

TEST(ModelHandsTest, WhatHasAPlaceOrSeveralOrMovesInSpaceStays) {
  Stage stage;
  const std::uint32_t beside = stage.module(ModelStructure::SLICE, -0.01F, 0.238F, 0.0F);
  stage.link(beside, 24, "pluck");
  const std::uint32_t wheel = stage.mass();
  stage.link(wheel, 5, "friction");
  stage.link(wheel, 25, "friction");
  const std::uint32_t alone = stage.hand();
  stage.section(3);
  const std::uint32_t mallet = stage.hand();
  stage.link(mallet, 20, "felt");
  const ModelStructure placed = withHandsInPlace(stage.structure);
  for (const std::uint32_t module : {beside, wheel, alone, mallet}) {
    EXPECT_EQ(placeOf(placed, module), placeOf(stage.structure, module)) << module;
  }
}

TEST(ModelHandsTest, AHammerFollowsThePointOnItsStringAndALeverFollowsTheHammer) {
  Stage stage;
  stage.structure.module_types[0] = ModelStructure::GROUND;
  const std::uint32_t hammer = stage.mass();
  const std::uint32_t tip = stage.module(ModelStructure::POINT, 0.0F, 0.0F, 0.0F);
  const std::uint32_t place = stage.module(ModelStructure::POINT, 0.0F, 0.2F, 0.0F);
  stage.link(tip, hammer, "contact");
  stage.link(hammer, place, "felt");
  const ModelStructure placed = withHandsInPlace(stage.structure);
  EXPECT_NEAR(placeOf(placed, hammer).y(), 0.2F, 1e-6F);
  EXPECT_NEAR(placeOf(placed, tip).y(), 0.2F, 1e-6F) << "it lies on the ground of the string";
}

TEST(ModelHandsTest, AStructureWhoseListsDoNotFitIsLeftAsItIs) {
  Stage stage;
  stage.structure.links = {0, 1000};
  EXPECT_EQ(withHandsInPlace(stage.structure).rest_positions, stage.structure.rest_positions);
}

}  // namespace
}  // namespace ergotic::panel
