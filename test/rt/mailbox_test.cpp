// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/mailbox.hpp"

#include <thread>

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

using Value = std::array<std::uint64_t, 64>;

TEST(MailboxTest, GivesTheNewestValueOnce) {
  Mailbox<int> box(0);
  EXPECT_FALSE(box.refresh());
  for (int value = 1; value <= 5; ++value) {
    box.draft() = value;
    box.publish();
  }
  EXPECT_TRUE(box.refresh());
  EXPECT_EQ(box.latest(), 5);
  EXPECT_FALSE(box.refresh());
  EXPECT_EQ(box.latest(), 5);
}

TEST(MailboxTest, DoesNotShowADraftThatIsNotPublished) {
  Mailbox<int> box(7);
  box.draft() = 8;
  EXPECT_FALSE(box.refresh());
  EXPECT_EQ(box.latest(), 7);
}

TEST(MailboxTest, StartsEverySlotAsTheInitialValue) {
  Mailbox<std::vector<int>> box(std::vector<int>(3, 9));
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(box.draft().size(), 3U);
    box.publish();
    box.refresh();
    EXPECT_EQ(box.latest().size(), 3U);
  }
}

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
