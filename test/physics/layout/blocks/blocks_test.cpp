// SPDX-License-Identifier: BSD-3-Clause
// What becomes a block, of what kind, and how irregular networks are laid out. That blocks play as
// their links do: kernels_agree_test.

#include <numeric>
#include <random>
#include <set>

#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/sparse_order.hpp"
#include "physics/layout/blocks/sparse_program.hpp"
#include "support/nets.hpp"
#include "support/one_by_one.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;
using test::Nets;

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
}

/// Then what is beyond the end of a shorter lane has no coefficients of its own.
TEST_F(BlocksTest, LanesOfUnequalLengthGoAloneOnlyBetweenFixedEndsAtRest) {
  for (const Nets::Ends ends : {Nets::Ends::kFixed, Nets::Ends::kFree, Nets::Ends::kFixedAndFree}) {
    for (const double displaced : {0.0, 1e-3}) {
      SceneBuilder unequal;
      Nets strings(unequal);
      strings.ground_position = displaced;
      for (int n = 0; n < kLanes; ++n) {
        strings.string(10 + n, ends);
      }
      const Block block = onlyBlock(unequal.scene);
      EXPECT_EQ(block.kind, Block::Kind::kChains);
      EXPECT_EQ(block.per_lane, ends == Nets::Ends::kFixed && displaced == 0.0);
    }
  }
}

TEST_F(BlocksTest, OneStringAloneIsARow) {
  nets.string(100);
  const Block block = onlyBlock(b.scene);
  EXPECT_EQ(block.kind, Block::Kind::kLattice);
  EXPECT_EQ(block.offsets, std::vector<int>{1});
  EXPECT_EQ(block.elements, 112);
  EXPECT_TRUE(block.one_ratio);
  EXPECT_EQ(uniformElements(block), elementsInSegments(block));
}

TEST_F(BlocksTest, SmallNetworksAreLeftOneByOne) {
  nets.string(11);
  EXPECT_TRUE(findBlocks(b.scene).empty());
}

TEST_F(BlocksTest, PlatesAreUniformWhereTheirCoefficientsAreEqual) {
  for (const bool corners : {false, true}) {
    for (const bool clamped : {false, true}) {
      for (const double scatter : {0.0, 0.3}) {
        SceneBuilder made;
        Nets plate(made);
        plate.scatter = scatter;
        plate.plate(20, 400, corners, clamped);
        const Block block = onlyBlock(made.scene);
        EXPECT_EQ(block.kind, Block::Kind::kLattice);
        if (clamped && scatter == 0.0) {  // corners without links keep the rows equally long
          EXPECT_EQ(block.pitch, 400);
          EXPECT_THAT(describeBlock(block), HasSubstr("rows of 400"));
        }
        EXPECT_EQ(uniformElements(block) == elementsInSegments(block), clamped && scatter == 0.0);
        EXPECT_EQ(uniformElements(block) == 0, scatter > 0.0);
      }
    }
  }
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
}

TEST_F(BlocksTest, BarsHaveTwoDiagonalsAndShuffledMeshesAndStarsAreSparse) {
  nets.bar(200);
  EXPECT_EQ(onlyBlock(b.scene).offsets, (std::vector<int>{1, 2}));
  nets.triangles(15);
  nets.star(60);
  const std::vector<Block> blocks = findBlocks(b.scene);
  EXPECT_EQ(blocks.size(), 3U);
  EXPECT_EQ(std::count_if(blocks.begin(), blocks.end(),
                          [](const Block& block) {
                            return block.kind == Block::Kind::kSparse && block.program != nullptr;
                          }),
            2);
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
}

TEST_F(BlocksTest, LinksThatFollowAudioOrAreNotLinearStayOneByOne) {
  const int first = nets.string(100);
  b.scene.audio_parameters.push_back({"audio", 0, 1.0, {}});
  b.scene.lias[30].stiffness.audio = 0;
  const int contact = b.link(scene::LiaType::kContact, first + 10, first + 70, 500.0);
  b.scene.lias[at(contact)].scheme = scene::Scheme::kEnergyStable;
  const int cubic = b.link(scene::LiaType::kCubic, first + 20, first + 60, 500.0);
  b.scene.lias[at(cubic)].law.edit().nonlinearity = {1e8};
  for (const Block& block : findBlocks(b.scene)) {
    for (const int l : {30, contact, cubic}) {
      EXPECT_EQ(std::count(block.lias.begin(), block.lias.end(), l), 0) << l;
    }
  }
  EXPECT_LT(test::differenceOneByOne(b.scene, Precision::kDouble, {kRate, 14}, 30), 1e-11);
}

/// One network of each kind; lanes, a row, a plate, an irregular net.
TEST_F(BlocksTest, ParametersReachEveryLink) {
  for (int n = 0; n < kLanes; ++n) {
    nets.string(12);
  }
  nets.string(50);
  nets.plate(20, 30, true, true);
  nets.triangles(9);
  b.scene.parameters.push_back({"k", 1.0, 0.5, 2.0, {}});
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

struct SparseNetwork {
  int nodes = 0;
  std::vector<LinkEnds> links;
};

/// `triangles` and `rays`: of test::Nets; `strays`: links between any two, some twice.
SparseNetwork networkOf(int triangles, int rays, int strays) {
  SceneBuilder b;
  test::Nets nets(b);
  if (triangles > 0) {
    nets.triangles(triangles);
  }
  if (rays > 0) {
    nets.star(rays);
  }
  SparseNetwork net{static_cast<int>(b.scene.mats.size()), {}};
  for (const Lia& lia : b.scene.lias) {
    net.links.push_back({lia.a, lia.b});
  }
  for (int n = 0; n < strays; ++n) {
    const auto any = [&] { return static_cast<int>(nets.random() % at(net.nodes)); };
    const LinkEnds link{any(), any()};
    if (link.a != link.b) {
      net.links.push_back(link);
    }
  }
  return net;
}

SparseNetwork meshOf(int side) {
  return networkOf(side, 0, 0);
}

std::vector<SparseNetwork> networks() {
  SparseNetwork random = networkOf(0, 2999, 9000);
  random.links.erase(random.links.begin(), random.links.begin() + 2999);
  return {meshOf(5),
          meshOf(40),
          random,
          networkOf(0, 3, 9),
          networkOf(0, 300, 0),
          {1, {}},
          {0, {}},
          {100, {}},
          {40, std::vector<LinkEnds>(5, LinkEnds{7, 33})},
          networkOf(40, 0, 400)};
}

SparseNetwork inOrder(const SparseNetwork& net, const std::vector<int>& order) {
  std::vector<int> place(at(net.nodes));
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[at(order[i])] = static_cast<int>(i);
  }
  SparseNetwork moved = net;
  for (LinkEnds& link : moved.links) {
    link = {place[at(link.a)], place[at(link.b)]};
  }
  return moved;
}

constexpr SparseSweep kSweeps[] = {SparseSweep::kFromEnd, SparseSweep::kFromSide};

TEST(SparseOrderTest, OrderIsAPermutation) {
  for (const SparseNetwork& net : networks()) {
    for (const SparseSweep sweep : kSweeps) {
      std::vector<int> order = sparseOrder(net.nodes, net.links, sweep);
      std::sort(order.begin(), order.end());
      std::vector<int> all(at(net.nodes));
      std::iota(all.begin(), all.end(), 0);
      EXPECT_EQ(order, all);
    }
  }
}

TEST(SparseOrderTest, NodesOfShuffledMeshesComeToLieClose) {
  const SparseNetwork mesh = meshOf(40);
  for (const SparseSweep sweep : kSweeps) {
    const SparseNetwork ordered = inOrder(mesh, sparseOrder(mesh.nodes, mesh.links, sweep));
    int reach = 0;
    for (const LinkEnds& link : ordered.links) {
      reach = std::max(reach, std::abs(link.a - link.b));
    }
    EXPECT_LT(reach, 3 * 40);
    const SparseProgram program = makeSparseProgram(ordered.nodes, ordered.links);
    EXPECT_LT(program.cost(), 9.5 * program.groups);
    EXPECT_TRUE(program.pick.empty());
  }
}

TEST(SparseProgramTest, WhatItReadsLiesWithinReach) {
  for (const SparseNetwork& net : networks()) {
    const SparseProgram program = makeSparseProgram(net.nodes, net.links);
    for (const std::uint32_t window : program.window) {
      EXPECT_EQ(window % at(kLanes), 0U);
      EXPECT_LE(window + 2 * at(kLanes), at(program.reach()));
    }
    for (const std::uint32_t node : program.pick) {
      EXPECT_LT(node, at(program.reach()));
    }
    for (const std::uint8_t lane : program.lane) {
      EXPECT_LT(lane, 2 * kLanes);
    }
  }
}

TEST(SparseProgramTest, SpanIsThatOfTheFarthestLink) {
  const SparseNetwork chain{64, {{0, 1}, {15, 16}, {20, 30}}};
  EXPECT_EQ(makeSparseProgram(chain.nodes, chain.links).span, 1);
  EXPECT_EQ(makeSparseProgram(64, {{63, 16}, {0, 15}}).span, 2);
  EXPECT_EQ(makeSparseProgram(64, {{0, 15}}).span, 0);
}

TEST(SparseProgramTest, MeshesHaveWindowsAndRandomNetworksMostlyPicks) {
  SparseNetwork net = networkOf(0, 19999, 60000);
  net.links.erase(net.links.begin(), net.links.begin() + 19999);
  const SparsePlan random = planSparse(net.nodes, net.links);
  EXPECT_GT(random.program.pick.size() / at(kLanes), 5 * at(random.program.groups));
  const SparseNetwork mesh = meshOf(60);
  EXPECT_TRUE(planSparse(mesh.nodes, mesh.links).program.pick.empty());
}

TEST(SparseProgramTest, PlanKeepsAnOrderThatIsBetterThanItsOwn) {
  const SparseNetwork shuffled = meshOf(48);
  const SparsePlan plan = planSparse(shuffled.nodes, shuffled.links);
  EXPECT_LT(plan.program.cost(), 0.5 * makeSparseProgram(shuffled.nodes, shuffled.links).cost());
  SparseNetwork rows{48 * 48, {}};  // of hexagons' neighbours: six slots at best
  for (int n = 0; n < rows.nodes; ++n) {
    for (const int step : {1, 48, 49}) {
      if (n + step < rows.nodes && (step == 48 || n % 48 != 47)) {
        rows.links.push_back({n, n + step});
      }
    }
  }
  std::vector<int> same(at(rows.nodes));
  std::iota(same.begin(), same.end(), 0);
  EXPECT_EQ(planSparse(rows.nodes, rows.links).order, same);
  EXPECT_LE(planSparse(rows.nodes, rows.links).program.cost(), 6.0 * rows.nodes / kLanes);
}

TEST(SparseProgramTest, LinksToNobodyAreRefused) {
  EXPECT_THROW(makeSparseProgram(4, {{0, 4}}), Exception);
  EXPECT_THROW(makeSparseProgram(4, {{-1, 2}}), Exception);
  EXPECT_THAT(complaintOf([&] {
                sparseOrder(4, {{0, 1}, {9, 2}}, SparseSweep::kFromEnd);
              }),
              AllOf(HasSubstr("node 9"), HasSubstr("0...3")));
}

}  // namespace
}  // namespace ergotic::physics
