// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/ring.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace ergotic::rt {
namespace {

TEST(RingTest, TakesExactlyItsCapacityAndRefusesTheRest) {
  Ring<int> ring(5);
  const std::vector<int> items{1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(ring.push(items.data(), items.size()), 5U);
  EXPECT_EQ(ring.readable(), 5U);
  EXPECT_EQ(ring.writable(), 0U);
  EXPECT_FALSE(ring.push(8));
  std::vector<int> out(7, 0);
  EXPECT_EQ(ring.pop(out.data(), out.size()), 5U);
  EXPECT_EQ(out, (std::vector<int>{1, 2, 3, 4, 5, 0, 0}));
}

TEST(RingTest, KeepsOrderAcrossItsSeam) {
  Ring<int> ring(4);
  int next_in = 0;
  int next_out = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.push(next_in++));
    }
    for (int i = 0; i < 3; ++i) {
      int item = -1;
      ASSERT_TRUE(ring.pop(item));
      ASSERT_EQ(item, next_out++);
    }
  }
}

TEST(RingTest, GivesNothingWhenEmpty) {
  Ring<int> ring(4);
  int item = 42;
  EXPECT_FALSE(ring.pop(item));
  EXPECT_EQ(item, 42);
  EXPECT_EQ(ring.readable(), 0U);
}

}  // namespace
}  // namespace ergotic::rt
