// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/presence_owner.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(PresenceOwnerTest, HearsOnePublisherUntilAnotherIsAccepted) {
  PresenceOwner owner;
  EXPECT_EQ(owner.name(), "");
  EXPECT_TRUE(owner.hears("/switch"));
  EXPECT_FALSE(owner.hears("/rostopic_1"));
  EXPECT_TRUE(owner.hears("/switch"));
  EXPECT_EQ(owner.name(), "/switch");
  owner.acceptAnother();
  EXPECT_TRUE(owner.hears("/rostopic_1"));
  EXPECT_FALSE(owner.hears("/switch"));
}

}  // namespace
}  // namespace ergotic::node
