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

#include "physics/kernels/levels.hpp"
#include "physics/kernels/sparse_arguments.hpp"
#include "physics/layout/blocks/sparse_networks.hpp"
#include "physics/layout/blocks/sparse_program.hpp"

namespace ergotic::physics {
namespace {

/// A network at some instant, and what its links do then.
template <class Real>
struct Instant {
  explicit Instant(const SparseNetwork& given, unsigned seed = 1)
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
    auto arguments = kernels::sparseArguments<Real>(program);
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
    const kernels::SparseKernels<Real>& kernels =
        kernels::kernelsOf<kernels::SparseKernels<Real>>(isa);
    if (kernels::sparseNeedsPairs(isa, program.pick.size())) {
      kernels.pair(arguments, pairs.data(), 0, program.groups);
      arguments.pairs = pairs.data();
    }
    const int middle = program.groups / 2;
    result.lost = kernels.forces(arguments, 0, middle);
    result.lost += kernels.forces(arguments, middle, program.groups);
    return result;
  }

  SparseNetwork net;
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
  for (const SparseNetwork& net : networks()) {
    expectLinkByLink(Instant<TypeParam>(net));
    Instant<TypeParam> uniform(net);
    uniform.makeUniform();
    expectLinkByLink(uniform);
  }
}

TYPED_TEST(SparseKernelTest, AllLevelsGiveTheSameBits) {
  for (const SparseNetwork& net : networks()) {
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
  for (const SparseNetwork& net : networks()) {
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
