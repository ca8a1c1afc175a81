// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "physics/layout/blocks/sparse_networks.hpp"
#include "physics/layout/blocks/sparse_order.hpp"
#include "physics/layout/blocks/sparse_program.hpp"

namespace ergotic::physics {
namespace {

/// The neighbour that a slot has for each lane.
std::vector<int> neighboursOf(const SparseProgram& program, int group, std::size_t in_group) {
  const std::size_t windows = program.first_window[at(group) + 1] - program.first_window[at(group)];
  std::vector<int> to;
  for (std::size_t lane = 0; lane < at(kLanes); ++lane) {
    if (in_group < windows) {
      const std::size_t w = program.first_window[at(group)] + in_group;
      to.push_back(static_cast<int>(program.window[w] + program.lane[w * at(kLanes) + lane]));
    } else {
      const std::size_t p = program.first_pick[at(group)] + in_group - windows;
      to.push_back(static_cast<int>(program.pick[p * at(kLanes) + lane]));
    }
  }
  return to;
}

struct Entry {
  std::size_t where;
  int node;
  int to;
};

/// All that a program does, from its slots alone.
std::vector<Entry> entriesOf(const SparseProgram& program) {
  std::vector<Entry> entries;
  std::size_t slot = 0;
  for (int group = 0; group < program.groups; ++group) {
    const std::size_t end = program.first_window[at(group) + 1] + program.first_pick[at(group) + 1];
    for (std::size_t in_group = 0; slot < end; ++slot, ++in_group) {
      const std::vector<int> to = neighboursOf(program, group, in_group);
      for (int lane = 0; lane < kLanes; ++lane) {
        if ((program.present[slot] >> lane & 1) != 0) {
          entries.push_back({slot * at(kLanes) + at(lane), group * kLanes + lane, to[at(lane)]});
        }
      }
    }
  }
  return entries;
}

constexpr SparseSweep kSweeps[] = {SparseSweep::kFromEnd, SparseSweep::kFromSide};

TEST(SparseOrderTest, OrderIsAPermutation) {
  for (const SparseNetwork& net : networks()) {
    for (const SparseSweep sweep : kSweeps) {
      std::vector<int> order = sparseOrder(net.nodes, net.links, sweep);
      std::sort(order.begin(), order.end());
      std::vector<int> all(at(net.nodes));
      std::iota(all.begin(), all.end(), 0);
      EXPECT_EQ(order, all) << net.name;
    }
  }
}

TEST(SparseOrderTest, NodesOfShuffledMeshesComeToLieClose) {
  const SparseNetwork mesh = meshOf(40, 9);
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

TEST(SparseOrderTest, FromTheSideAShuffledMembraneIsInRowsAgain) {
  constexpr int kSide = 40;
  const SparseNetwork mesh = meshOf(kSide, 14);
  const SparseNetwork ordered =
      inOrder(mesh, sparseOrder(mesh.nodes, mesh.links, SparseSweep::kFromSide));
  for (const LinkEnds& link : ordered.links) {
    EXPECT_LE(std::abs(link.a / kSide - link.b / kSide), 1);
  }
}

TEST(SparseOrderTest, NetworksThatHangTogetherStayTogether) {
  SparseNetwork two{"two chains", 200, {}};
  for (int i = 0; i + 2 < two.nodes; ++i) {
    two.links.push_back({i, i + 2});
  }
  for (const SparseSweep sweep : kSweeps) {
    const std::vector<int> order = sparseOrder(two.nodes, two.links, sweep);
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(order[i] % 2, order[0] % 2) << i;
      EXPECT_EQ(order[i + 100] % 2, 1 - order[0] % 2) << i;
    }
  }
}

TEST(SparseProgramTest, EveryLinkIsThereOnceFromBothSides) {
  for (const SparseNetwork& net : networks()) {
    const SparseProgram program = makeSparseProgram(net.nodes, net.links);
    const std::vector<Entry> entries = entriesOf(program);
    ASSERT_EQ(entries.size(), 2 * net.links.size()) << net.name;
    std::vector<const Entry*> at_place(program.slots() * at(kLanes), nullptr);
    for (const Entry& entry : entries) {
      at_place[entry.where] = &entry;
    }
    for (std::size_t l = 0; l < net.links.size(); ++l) {
      const Entry* a = at_place[program.sides[l].a];
      const Entry* b = at_place[program.sides[l].b];
      ASSERT_TRUE(a != nullptr && b != nullptr && a != b) << net.name << " link " << l;
      EXPECT_EQ(a->node, net.links[l].a) << net.name << " link " << l;
      EXPECT_EQ(a->to, net.links[l].b) << net.name << " link " << l;
      EXPECT_EQ(b->node, net.links[l].b) << net.name << " link " << l;
      EXPECT_EQ(b->to, net.links[l].a) << net.name << " link " << l;
    }
  }
}

TEST(SparseProgramTest, WhatItReadsLiesWithinReach) {
  for (const SparseNetwork& net : networks()) {
    const SparseProgram program = makeSparseProgram(net.nodes, net.links);
    for (const std::uint32_t window : program.window) {
      EXPECT_EQ(window % at(kLanes), 0U);
      EXPECT_LE(window + 2 * at(kLanes), at(program.reach())) << net.name;
    }
    for (const std::uint32_t node : program.pick) {
      EXPECT_LT(node, at(program.reach())) << net.name;
    }
    for (const std::uint8_t lane : program.lane) {
      EXPECT_LT(lane, 2 * kLanes) << net.name;
    }
  }
}

TEST(SparseProgramTest, SpanIsThatOfTheFarthestLink) {
  const SparseNetwork chain{"chain", 64, {{0, 1}, {15, 16}, {20, 30}}};
  EXPECT_EQ(makeSparseProgram(chain.nodes, chain.links).span, 1);
  EXPECT_EQ(makeSparseProgram(64, {{63, 16}, {0, 15}}).span, 2);
  EXPECT_EQ(makeSparseProgram(64, {{0, 15}}).span, 0);
}

TEST(SparseProgramTest, MeshesHaveWindowsAndRandomNetworksMostlyPicks) {
  const SparseNetwork net = randomOf(20000, 60000, 10);
  const SparsePlan random = planSparse(net.nodes, net.links);
  EXPECT_GT(random.program.pick.size() / at(kLanes), 5 * at(random.program.groups));
  const SparseNetwork mesh = meshOf(60, 11);
  EXPECT_TRUE(planSparse(mesh.nodes, mesh.links).program.pick.empty());
}

TEST(SparseProgramTest, PlanKeepsAnOrderThatIsBetterThanItsOwn) {
  const SparseNetwork shuffled = meshOf(48, 12);
  const SparsePlan plan = planSparse(shuffled.nodes, shuffled.links);
  EXPECT_LT(plan.program.cost(), 0.5 * makeSparseProgram(shuffled.nodes, shuffled.links).cost());
  SparseNetwork rows{"rows", 48 * 48, {}};  // of hexagons' neighbours: six slots at best
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
  try {
    sparseOrder(4, {{0, 1}, {9, 2}}, SparseSweep::kFromEnd);
    FAIL();
  } catch (const Exception& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("node 9"));
    EXPECT_THAT(e.what(), testing::HasSubstr("0...3"));
  }
}

}  // namespace
}  // namespace ergotic::physics
