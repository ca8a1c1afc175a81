// SPDX-License-Identifier: BSD-3-Clause
#include "physics/disjoint_sets.hpp"

#include <random>

#include "support/test.hpp"

namespace ergotic::physics {
namespace {

/// A joined set keeps the name of the second; each member is at first a set of its own.
TEST(DisjointSetsTest, AreThoseThatRelabellingFinds) {
  std::mt19937 random(4);
  for (int round = 0; round < 100; ++round) {
    const int count = 1 + static_cast<int>(random() % 60);
    const auto any = [&] { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    DisjointSets sets(static_cast<std::size_t>(count));
    std::vector<int> label(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < label.size(); ++i) {
      label[i] = static_cast<int>(i);
    }
    for (int join = 0; join < count; ++join) {
      const int a = any();
      const int b = any();
      sets.join(a, b);
      const int from = label[static_cast<std::size_t>(a)];
      const int to = label[static_cast<std::size_t>(b)];
      for (int& each : label) {
        each = each == from ? to : each;
      }
      if (join % 3 == 0) {
        sets.setOf(any());  // asking changes no name
      }
    }
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(sets.setOf(i), label[static_cast<std::size_t>(i)]);
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
