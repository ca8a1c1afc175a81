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
#include "physics/sparse_order.hpp"
#include "physics/sparse_program.hpp"

namespace ergotic::physics {
namespace {

constexpr int kLanes = SparseProgram::kLanes;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct Network {
  std::string name;
  int nodes = 0;
  std::vector<LinkEnds> links;
};

/// Squares with one random diagonal each, as nets of triangles; nodes in random order.
Network meshOf(int side, unsigned seed) {
  std::mt19937 random(seed);
  Network mesh{"mesh " + std::to_string(side), side * side, {}};
  std::vector<int> id(at(mesh.nodes));
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin(), id.end(), random);
  const auto node = [&](int row, int column) { return id[at(row * side + column)]; };
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      if (c + 1 < side) {
        mesh.links.push_back({node(r, c), node(r, c + 1)});
      }
      if (r + 1 < side) {
        mesh.links.push_back({node(r, c), node(r + 1, c)});
      }
      if (r + 1 < side && c + 1 < side) {
        mesh.links.push_back(random() % 2 == 0 ? LinkEnds{node(r, c), node(r + 1, c + 1)}
                                               : LinkEnds{node(r, c + 1), node(r + 1, c)});
      }
    }
  }
  return mesh;
}

/// Any node with any other; with few nodes, some twice, and some with nobody.
Network randomOf(int nodes, int links, unsigned seed) {
  std::mt19937 random(seed);
  Network net{"random " + std::to_string(nodes) + " " + std::to_string(links), nodes, {}};
  const auto any = [&] { return static_cast<int>(random() % static_cast<unsigned>(nodes)); };
  while (net.links.size() < at(links)) {
    const LinkEnds link{any(), any()};
    if (link.a != link.b) {
      net.links.push_back(link);
    }
  }
  return net;
}

Network starOf(int rays) {
  Network star{"star " + std::to_string(rays), rays + 1, {}};
  for (int i = 0; i < rays; ++i) {
    star.links.push_back({i, rays});
  }
  return star;
}

std::vector<Network> networks() {
  std::vector<Network> all{meshOf(5, 1),
                           meshOf(40, 2),
                           randomOf(3, 9, 3),
                           randomOf(30, 20, 4),
                           randomOf(500, 1500, 5),
                           randomOf(3000, 9000, 6),
                           starOf(3),
                           starOf(300),
                           {"lone node", 1, {}},
                           {"nothing", 0, {}},
                           {"apart", 100, {}},
                           {"parallel", 40, std::vector<LinkEnds>(5, LinkEnds{7, 33})}};
  Network mixed = meshOf(40, 7);  // a mesh with strays: windows and picks
  mixed.name = "mixed";
  for (const LinkEnds& link : randomOf(mixed.nodes, 400, 8).links) {
    mixed.links.push_back(link);
  }
  all.push_back(mixed);
  return all;
}

Network inOrder(const Network& net, const std::vector<int>& order) {
  std::vector<int> place(at(net.nodes));
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[at(order[i])] = static_cast<int>(i);
  }
  Network moved = net;
  for (LinkEnds& link : moved.links) {
    link = {place[at(link.a)], place[at(link.b)]};
  }
  return moved;
}

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
  for (const Network& net : networks()) {
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
  const Network mesh = meshOf(40, 9);
  for (const SparseSweep sweep : kSweeps) {
    const Network ordered = inOrder(mesh, sparseOrder(mesh.nodes, mesh.links, sweep));
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
  const Network mesh = meshOf(kSide, 14);
  const Network ordered =
      inOrder(mesh, sparseOrder(mesh.nodes, mesh.links, SparseSweep::kFromSide));
  for (const LinkEnds& link : ordered.links) {
    EXPECT_LE(std::abs(link.a / kSide - link.b / kSide), 1);
  }
}

TEST(SparseOrderTest, NetworksThatHangTogetherStayTogether) {
  Network two{"two chains", 200, {}};
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
  for (const Network& net : networks()) {
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
  for (const Network& net : networks()) {
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
  const Network chain{"chain", 64, {{0, 1}, {15, 16}, {20, 30}}};
  EXPECT_EQ(makeSparseProgram(chain.nodes, chain.links).span, 1);
  EXPECT_EQ(makeSparseProgram(64, {{63, 16}, {0, 15}}).span, 2);
  EXPECT_EQ(makeSparseProgram(64, {{0, 15}}).span, 0);
}

TEST(SparseProgramTest, MeshesHaveWindowsAndRandomNetworksMostlyPicks) {
  const Network net = randomOf(20000, 60000, 10);
  const SparsePlan random = planSparse(net.nodes, net.links);
  EXPECT_GT(random.program.pick.size() / at(kLanes), 5 * at(random.program.groups));
  const Network mesh = meshOf(60, 11);
  EXPECT_TRUE(planSparse(mesh.nodes, mesh.links).program.pick.empty());
}

TEST(SparseProgramTest, PlanKeepsAnOrderThatIsBetterThanItsOwn) {
  const Network shuffled = meshOf(48, 12);
  const SparsePlan plan = planSparse(shuffled.nodes, shuffled.links);
  EXPECT_LT(plan.program.cost(), 0.5 * makeSparseProgram(shuffled.nodes, shuffled.links).cost());
  Network rows{"rows", 48 * 48, {}};  // of hexagons' neighbours: six slots at best
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

/// A network at some instant, and what its links do then.
template <class Real>
struct Instant {
  explicit Instant(const Network& given, unsigned seed = 1)
      : net(given), program(makeSparseProgram(net.nodes, net.links)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (std::vector<Real>* of : {&x, &d, &d_last}) {
      of->assign(at(program.reach()), Real(0));
      for (int n = 0; n < net.nodes; ++n) {
        (*of)[at(n)] = static_cast<Real>(any(random));
      }
    }
    for (std::size_t l = 0; l < net.links.size(); ++l) {
      k.push_back(1.5 + any(random));
      z.push_back(1.5 + any(random));
    }
  }

  void makeUniform() {
    std::fill(k.begin(), k.end(), 0.7);
    std::fill(z.begin(), z.end(), 0.3);
    uniform = true;
  }

  struct Result {
    std::vector<Real> f;
    double lost = 0.0;
  };

  Result step(rt::Isa isa, bool metered = true) const {
    Result result{std::vector<Real>(x.size(), std::numeric_limits<Real>::quiet_NaN()), 0.0};
    std::vector<Real> ks(program.slots() * at(kLanes));
    std::vector<Real> zs(ks.size());
    program.spread(k, ks.data());
    program.spread(z, zs.data());
    std::vector<Real> pairs(2 * x.size());
    auto arguments = program.template arguments<Real>();
    arguments.x = x.data();
    arguments.d = d.data();
    arguments.d_last = metered ? d_last.data() : nullptr;
    arguments.f = result.f.data();
    if (uniform) {
      arguments.k = Real(0.7);
      arguments.z = Real(0.3);
    } else {
      arguments.ks = ks.data();
      arguments.zs = zs.data();
    }
    const kernels::SparseKernels<Real>& kernels = kernels::sparseKernels<Real>(isa);
    if (program.needsPairs(isa)) {
      kernels.pair(arguments, pairs.data(), 0, program.groups);
      arguments.pairs = pairs.data();
    }
    const int middle = program.groups / 2;
    result.lost = kernels.forces(arguments, 0, middle);
    result.lost += kernels.forces(arguments, middle, program.groups);
    return result;
  }

  Network net;
  SparseProgram program;
  std::vector<Real> x, d, d_last;
  std::vector<double> k, z;
  bool uniform = false;
};

/// Link by link.
template <class Real>
struct Expected {
  explicit Expected(const Instant<Real>& now)
      : f(now.x.size(), 0.0), sum_of_sizes(now.x.size(), 0.0) {
    for (std::size_t l = 0; l < now.net.links.size(); ++l) {
      const std::size_t a = at(now.net.links[l].a);
      const std::size_t b = at(now.net.links[l].b);
      const auto apart = [=](const std::vector<Real>& of) {
        return static_cast<double>(of[b]) - static_cast<double>(of[a]);
      };
      const double v = apart(now.d);
      const double force = now.k[l] * apart(now.x) + now.z[l] * v;
      f[a] += force;
      f[b] -= force;
      const double size = now.k[l] * std::abs(apart(now.x)) + now.z[l] * std::abs(v);
      sum_of_sizes[a] += size;
      sum_of_sizes[b] += size;
      lost += now.z[l] * v * (v + apart(now.d_last));
      sum_of_losses += now.z[l] * std::abs(v) * 4.0;
    }
  }
  std::vector<double> f;
  std::vector<double> sum_of_sizes;
  double lost = 0.0;
  double sum_of_losses = 0.0;
};

template <class Real>
class SparseKernelTest : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SparseKernelTest, Reals);

template <class Real>
void expectLinkByLink(const Instant<Real>& now) {
  const auto result = now.step(rt::Isa::kBaseline);
  const Expected<Real> expected(now);
  // Each sum rounds once per neighbour at most, of at most its size.
  const double rounding = 8.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  for (std::size_t n = 0; n < at(now.net.nodes); ++n) {
    ASSERT_NEAR(static_cast<double>(result.f[n]), expected.f[n],
                rounding * (expected.sum_of_sizes[n] + 1.0))
        << now.net.name << " node " << n;
  }
  EXPECT_NEAR(result.lost, expected.lost, rounding * (expected.sum_of_losses + 1.0))
      << now.net.name;
}

TYPED_TEST(SparseKernelTest, ForcesAndLossesAreThoseOfItsLinks) {
  for (const Network& net : networks()) {
    expectLinkByLink(Instant<TypeParam>(net));
    Instant<TypeParam> uniform(net);
    uniform.makeUniform();
    expectLinkByLink(uniform);
  }
}

TYPED_TEST(SparseKernelTest, AllLevelsGiveTheSameBits) {
  for (const Network& net : networks()) {
    for (const bool uniform : {false, true}) {
      Instant<TypeParam> now(net);
      if (uniform) {
        now.makeUniform();
      }
      const auto expected = now.step(rt::Isa::kBaseline);
      for (const rt::Isa isa : rt::isas()) {
        const auto result = now.step(isa);
        const std::size_t bytes = at(kLanes * now.program.groups) * sizeof(TypeParam);
        EXPECT_EQ(std::memcmp(result.f.data(), expected.f.data(), bytes), 0)
            << net.name << " " << rt::nameOf(isa) << " uniform " << uniform;
        EXPECT_EQ(result.lost, expected.lost) << net.name << " " << rt::nameOf(isa);
      }
    }
  }
}

TYPED_TEST(SparseKernelTest, MeteringChangesNoForce) {
  for (const Network& net : networks()) {
    const Instant<TypeParam> now(net);
    for (const rt::Isa isa : rt::isas()) {
      const auto metered = now.step(isa);
      const auto plain = now.step(isa, false);
      const std::size_t bytes = at(kLanes * now.program.groups) * sizeof(TypeParam);
      EXPECT_EQ(std::memcmp(metered.f.data(), plain.f.data(), bytes), 0) << net.name;
      EXPECT_EQ(plain.lost, 0.0) << net.name;
    }
  }
}

TYPED_TEST(SparseKernelTest, NetworksThatMoveAsOneFeelNothing) {
  Instant<TypeParam> now(meshOf(20, 13));
  std::fill(now.x.begin(), now.x.end(), TypeParam(0.1));
  std::fill(now.d.begin(), now.d.end(), TypeParam(0.3));
  for (const rt::Isa isa : rt::isas()) {
    const auto result = now.step(isa);
    for (int n = 0; n < now.net.nodes; ++n) {
      EXPECT_EQ(result.f[at(n)], TypeParam(0)) << n;
    }
    EXPECT_EQ(result.lost, 0.0);
  }
}

}  // namespace
}  // namespace ergotic::physics
