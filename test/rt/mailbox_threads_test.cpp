// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "ergotic/rt/mailbox.hpp"

namespace ergotic::rt {
namespace {

using Value = std::array<std::uint64_t, 64>;

TEST(MailboxThreadsTest, ValuesAreAlwaysWholeAndNeverGoBack) {
  constexpr std::uint64_t kSeen = 20'000;
  Mailbox<Value> box;
  std::atomic<bool> enough{false};
  std::uint64_t published = 0;
  std::thread writer([&] {
    while (!enough.load(std::memory_order_relaxed)) {
      box.draft().fill(++published);
      box.publish();
    }
  });
  std::uint64_t seen = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  std::uint64_t last = 0;
  while (seen < kSeen) {
    if (!box.refresh()) {
      std::this_thread::yield();
      continue;
    }
    const std::uint64_t first = box.latest().front();
    for (const std::uint64_t part : box.latest()) {
      torn += part != first ? 1 : 0;
    }
    backwards += first <= last ? 1 : 0;
    last = first;
    ++seen;
  }
  enough.store(true, std::memory_order_relaxed);
  writer.join();
  if (box.refresh()) {
    last = box.latest().front();
  }
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backwards, 0U);
  EXPECT_GE(published, kSeen);
  EXPECT_EQ(last, published);
}

}  // namespace
}  // namespace ergotic::rt
