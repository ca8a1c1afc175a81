// SPDX-License-Identifier: BSD-3-Clause
// What becomes a block, of what kind, and that every special case still plays as its links do.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "physics/layout/blocks/lanes.hpp"
#include "support/nets.hpp"
#include "support/one_by_one.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;
using test::Nets;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int uniformElements(const Block& block) {
  int uniform = 0;
  for (const Block::Segment& segment : block.segments) {
    uniform += segment.uniform ? segment.end - segment.begin : 0;
  }
  return uniform;
}

int elementsInSegments(const Block& block) {
  return block.segments.back().end - block.segments.front().begin;
}

/// The only block of a scene.
Block onlyBlock(const Scene& scene) {
  std::vector<Block> blocks = findBlocks(scene);
  EXPECT_EQ(blocks.size(), 1U);
  return blocks.empty() ? Block{} : blocks.front();
}

void expectAgreement(const Scene& scene, const std::string& what = "") {
  EXPECT_LT(test::differenceOneByOne(scene, Precision::kDouble, {kRate, 14}, 30), 1e-11) << what;
}

struct BlocksTest : testing::Test {
  SceneBuilder b;
  Nets nets{b};
};

TEST_F(BlocksTest, EqualStringsLieSixteenSideBySide) {
  for (int n = 0; n < 64; ++n) {
    nets.string(30);
  }
  const std::vector<Block> blocks = findBlocks(b.scene);
  ASSERT_EQ(blocks.size(), 4U);
  std::set<int> mats;
  for (const Block& block : blocks) {
    EXPECT_EQ(block.kind, Block::Kind::kChains);
    EXPECT_TRUE(block.per_lane);
    EXPECT_EQ(block.elements, 30 * kLanes);
    mats.insert(block.mats.begin(), block.mats.end());
  }
  EXPECT_EQ(mats.size(), 64U * 30U);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, NeighboursInALaneAreThoseOfTheString) {
  for (int n = 0; n < kLanes; ++n) {
    nets.string(10 + n);
  }
  const Block block = onlyBlock(b.scene);
  ASSERT_EQ(block.kind, Block::Kind::kChains);
  EXPECT_TRUE(block.per_lane);
  int links = 0;
  for (int e = 0; e + kLanes < block.elements; ++e) {
    const int here = block.mats[at(e)];
    const int next = block.mats[at(e + kLanes)];
    if (here >= 0 && next >= 0) {
      EXPECT_EQ(std::abs(here - next), 1) << e;
      ++links;
    }
  }
  EXPECT_EQ(links, static_cast<int>(b.scene.lias.size()));
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, FreeEndsBesideLongerLanesAreTiedToNothing) {
  for (const Nets::Ends ends : {Nets::Ends::kFree, Nets::Ends::kFixedAndFree}) {
    SceneBuilder free;
    Nets strings(free);
    for (int n = 0; n < kLanes; ++n) {
      strings.string(10 + n, ends);
    }
    const Block block = onlyBlock(free.scene);
    EXPECT_EQ(block.kind, Block::Kind::kChains);
    EXPECT_FALSE(block.per_lane);
    expectAgreement(free.scene);
  }
}

TEST_F(BlocksTest, DisplacedEndsBesideLongerLanesAreTiedToNothing) {
  nets.ground_position = 1e-3;
  for (int n = 0; n < kLanes; ++n) {
    nets.string(10 + n);
  }
  EXPECT_FALSE(onlyBlock(b.scene).per_lane);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, OneStringAloneIsARow) {
  nets.string(100);
  const Block block = onlyBlock(b.scene);
  EXPECT_EQ(block.kind, Block::Kind::kLattice);
  EXPECT_EQ(block.offsets, std::vector<int>{1});
  EXPECT_EQ(block.elements, 112);
  EXPECT_TRUE(block.one_ratio);
  EXPECT_EQ(uniformElements(block), elementsInSegments(block));
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, StringsInOneRowAreNotTiedTogether) {
  for (const Nets::Ends ends : {Nets::Ends::kFixed, Nets::Ends::kFree}) {
    SceneBuilder row;
    Nets strings(row);
    strings.string(100, ends);
    strings.string(41, ends);
    EXPECT_EQ(onlyBlock(row.scene).elements, 144);
    expectAgreement(row.scene);
  }
}

TEST_F(BlocksTest, SmallNetworksAreLeftOneByOne) {
  nets.string(11);
  EXPECT_TRUE(findBlocks(b.scene).empty());
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, ClampedHomogeneousPlatesAreUniform) {
  nets.plate(20, 30, true, true);
  const Block block = onlyBlock(b.scene);
  EXPECT_EQ(block.kind, Block::Kind::kLattice);
  EXPECT_EQ(block.pitch, 30);
  EXPECT_EQ(uniformElements(block), elementsInSegments(block));
  EXPECT_NE(describeBlock(block).find("rows of 30"), std::string::npos);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, CornersWithoutLinksKeepTheRowsEquallyLong) {
  nets.plate(20, 30, false, true);
  const Block block = onlyBlock(b.scene);
  EXPECT_EQ(block.pitch, 30);
  EXPECT_EQ(block.lias.size(), b.scene.lias.size());
  EXPECT_EQ(uniformElements(block), elementsInSegments(block));
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, NetsBesideEachOtherShareNoIdleGrounds) {
  for (int n = 0; n < 40; ++n) {
    b.ground();
    nets.plate(5 + n % 3, 6, n % 2 == 0, true);
  }
  std::vector<int> seen(b.scene.mats.size(), 0);
  for (const Block& block : findBlocks(b.scene)) {
    for (const int m : block.mats) {
      if (m >= 0) {
        EXPECT_EQ(++seen[at(m)], 1) << m;
      }
    }
  }
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, PlatesOfManyCoefficientsAreNotUniform) {
  nets.scatter = 0.3;
  nets.plate(20, 30, true, true);
  const Block block = onlyBlock(b.scene);
  EXPECT_EQ(block.kind, Block::Kind::kLattice);
  EXPECT_EQ(uniformElements(block), 0);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, PlatesWithFreeEdgesAreUniformInside) {
  for (const bool corners : {false, true}) {
    SceneBuilder free;
    Nets plate(free);
    plate.plate(20, 400, corners, false);
    const Block block = onlyBlock(free.scene);
    EXPECT_GT(uniformElements(block), 0);
    EXPECT_LT(uniformElements(block), elementsInSegments(block));
    expectAgreement(free.scene);
  }
}

TEST_F(BlocksTest, BarsHaveTwoDiagonals) {
  nets.bar(200);
  EXPECT_EQ(onlyBlock(b.scene).offsets, (std::vector<int>{1, 2}));
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, ShuffledMeshesAndStarsAreSparse) {
  nets.triangles(15);
  nets.star(60);
  const std::vector<Block> blocks = findBlocks(b.scene);
  ASSERT_EQ(blocks.size(), 2U);
  for (const Block& block : blocks) {
    EXPECT_EQ(block.kind, Block::Kind::kSparse);
    EXPECT_NE(block.program, nullptr);
  }
  expectAgreement(b.scene);
}

/// One network of each kind; lanes, a row, a plate, an irregular net.
void addOneOfEach(Nets& nets) {
  for (int n = 0; n < kLanes; ++n) {
    nets.string(12);
  }
  nets.string(50);
  nets.plate(20, 30, true, true);
  nets.triangles(9);
}

TEST_F(BlocksTest, SpringsWithRestLengthsAreABias) {
  nets.rest_length = 1e-3;
  addOneOfEach(nets);
  for (const Block& block : findBlocks(b.scene)) {
    EXPECT_TRUE(block.has_bias);
    EXPECT_NE(block.kind, Block::Kind::kChains);
  }
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, GravityIsADrift) {
  b.scene.sections[0].gravity.x() = -9.81;
  addOneOfEach(nets);
  for (const Block& block : findBlocks(b.scene)) {
    EXPECT_TRUE(block.has_drift);
  }
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, CellsAndMediumMixWithMasses) {
  nets.has_cells = true;
  addOneOfEach(nets);
  for (const Block& block : findBlocks(b.scene)) {
    EXPECT_TRUE(block.has_cells);
  }
  expectAgreement(b.scene, "cells");
  b.scene.sections[0].medium = {0.1};
  b.scene.sections[0].gravity.x() = -9.81;
  expectAgreement(b.scene, "cells in a medium under gravity");
}

TEST_F(BlocksTest, GroundsOfSeveralNetworksStayOneByOne) {
  const int bridge = b.ground();
  for (int n = 0; n < 2; ++n) {
    const int first = nets.string(60, Nets::Ends::kFixedAndFree);
    nets.join(first + 59, bridge);
  }
  for (const Block& block : findBlocks(b.scene)) {
    EXPECT_EQ(std::count(block.mats.begin(), block.mats.end(), bridge), 0);
    EXPECT_EQ(block.lias.size(), 2U * 59U);
  }
  b.hear(bridge, 0, scene::Quantity::kForce);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, LinksThatFollowAudioOrAreNotLinearStayOneByOne) {
  const int first = nets.string(100);
  b.scene.audio_parameters.push_back({"audio", 0, 1.0, {}});
  b.scene.lias[30].stiffness.audio = 0;
  const int contact = b.link(scene::LiaType::kContact, first + 10, first + 70, 500.0);
  b.scene.lias[at(contact)].scheme = scene::Scheme::kGuarded;
  const int cubic = b.link(scene::LiaType::kCubic, first + 20, first + 60, 500.0);
  b.scene.lias[at(cubic)].law.edit().nonlinearity = {1e8};
  for (const Block& block : findBlocks(b.scene)) {
    for (const int l : {30, contact, cubic}) {
      EXPECT_EQ(std::count(block.lias.begin(), block.lias.end(), l), 0) << l;
    }
  }
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, ParallelLinksAddUp) {
  const int first = nets.string(60);
  nets.join(first + 7, first + 8);
  nets.join(first + 8, first + 7);
  const int plate = nets.plate(20, 30, true, true);
  nets.join(plate + 67, plate + 68);
  const int net = nets.triangles(9);
  nets.join(b.scene.lias.back().a, b.scene.lias.back().b);
  ASSERT_GT(net, plate);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, EveryLinkMayBeDouble) {
  const int first = nets.string(60);
  for (int m = first + 1; m < first + 60; ++m) {
    nets.join(m - 1, m);
  }
  EXPECT_EQ(onlyBlock(b.scene).lias.size(), 2U * 59U);
  expectAgreement(b.scene);
}

TEST_F(BlocksTest, GroundsMayStartDisplaced) {
  nets.ground_position = 1e-3;
  addOneOfEach(nets);
  nets.plate(20, 40, false, true);
  expectAgreement(b.scene);
  b.scene.sections[0].gravity.x() = -9.81;
  expectAgreement(b.scene, "under gravity");
}

TEST_F(BlocksTest, HeardGroundsFeelTheirLinks) {
  for (const double rest_length : {0.0, 1e-3}) {
    SceneBuilder heard;
    Nets made(heard);
    made.rest_length = rest_length;
    addOneOfEach(made);
    int channel = 0;
    for (std::size_t m = 0; m < heard.scene.mats.size(); m += 7) {
      if (heard.scene.mats[m].type == scene::MatType::kGround) {
        heard.hear(static_cast<int>(m), channel++, scene::Quantity::kForce);
      }
    }
    ASSERT_GT(channel, 10);
    expectAgreement(heard.scene);
  }
}

TEST_F(BlocksTest, AHeardEndFeelsItsSpringAlone) {
  constexpr double kStiffness = 1000.0;
  const int first = b.chain(60, 1e-3, kStiffness);
  b.scene.mats[at(first + 1)].position.x() = 1e-3;
  b.hear(first, 0, scene::Quantity::kForce);
  b.hear(first + 1);
  b.hear(first + 1, 1);
  b.scene.outputs.erase(b.scene.outputs.begin() + 1);
  ASSERT_FALSE(findBlocks(b.scene).empty());
  Player player(b.scene, {kRate, 1});
  player.ticks(100);
  for (std::size_t n = 0; n < 100; ++n) {
    EXPECT_NEAR(player.heard[0][n], kStiffness * player.heard[1][n], 1e-15 * kStiffness) << n;
  }
}

TEST_F(BlocksTest, ParametersReachEveryLink) {
  b.scene.parameters.push_back({"k", 1.0, 0.5, 2.0, {}});
  addOneOfEach(nets);
  for (scene::Lia& lia : b.scene.lias) {
    lia.stiffness.parameter = 0;
    lia.damping.parameter = 0;
  }
  Scene other = b.scene;
  other.parameters[0].value = 1.7;
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const auto tuned = compile(b.scene, {kRate, 14}, precision);
    tuned->exchange(tuned->prepare({1.7}));
    const auto made = compile(other, {kRate, 14}, precision);
    for (Instrument* instrument : {tuned.get(), made.get()}) {
      for (int n = 0; n < 30; ++n) {
        instrument->tick({});
      }
    }
    EXPECT_EQ(test::displacementsOf(*tuned), test::displacementsOf(*made));
  }
}

}  // namespace
}  // namespace ergotic::physics
