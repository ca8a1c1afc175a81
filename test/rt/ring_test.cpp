// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/ring.hpp"

#include <thread>

#include "support/test.hpp"

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

TEST(RingThreadsTest, EveryItemCrossesOnceAndInOrder) {
  constexpr std::uint64_t kItems = 500'000;
  Ring<std::uint64_t> ring(64);
  std::thread writer([&ring] {
    for (std::uint64_t i = 0; i < kItems;) {
      if (ring.push(i)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t received = 0;
  std::uint64_t out_of_order = 0;
  while (received < kItems) {
    std::uint64_t item = 0;
    if (ring.pop(item)) {
      out_of_order += item != received ? 1 : 0;
      ++received;
    } else {
      std::this_thread::yield();
    }
  }
  writer.join();
  std::uint64_t extra = 0;
  EXPECT_FALSE(ring.pop(extra));
  EXPECT_EQ(received, kItems);
  EXPECT_EQ(out_of_order, 0U);
}

TEST(RingThreadsTest, WhatIsAcceptedAndWhatIsRefusedAddUp) {
  constexpr std::uint64_t kBlocks = 20'000;
  constexpr std::size_t kBlock = 37;
  Ring<std::uint64_t> ring(256);
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::thread writer([&] {
    std::vector<std::uint64_t> block(kBlock);
    for (std::uint64_t b = 0; b < kBlocks; ++b) {
      for (std::size_t i = 0; i < kBlock; ++i) {
        block[i] = accepted + i;
      }
      const std::size_t taken = ring.push(block.data(), kBlock);
      accepted += taken;
      refused += kBlock - taken;
      if (taken < kBlock) {
        std::this_thread::yield();
      }
    }
    const std::uint64_t end = UINT64_MAX;
    while (!ring.push(end)) {
      std::this_thread::yield();
    }
  });
  std::uint64_t received = 0;
  std::uint64_t wrong = 0;
  bool ended = false;
  std::vector<std::uint64_t> some(50);
  while (!ended) {
    const std::size_t count = ring.pop(some.data(), some.size());
    for (std::size_t i = 0; i < count; ++i) {
      ended = some[i] == UINT64_MAX;
      wrong += !ended && some[i] != received ? 1 : 0;
      received += ended ? 0 : 1;
    }
  }
  writer.join();
  EXPECT_EQ(received, accepted);
  EXPECT_EQ(accepted + refused, kBlocks * kBlock);
  EXPECT_GE(accepted, 256U);
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace ergotic::rt
