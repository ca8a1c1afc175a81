// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/mailbox.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace ergotic::rt {
namespace {

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

}  // namespace
}  // namespace ergotic::rt
