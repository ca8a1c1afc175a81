// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/presence_owner.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(PresenceOwnerTest, HearsOnePublisherUntilAnotherIsAccepted) {
  constexpr std::int64_t kLater = 1'000'000'000 + PresenceOwner::kSilentNs;
  PresenceOwner owner;
  EXPECT_EQ(owner.name(), "");
  EXPECT_TRUE(owner.hears("/switch", 0));
  EXPECT_FALSE(owner.hears("/rostopic_1", 0));
  EXPECT_TRUE(owner.hears("/switch", 1'000'000'000));
  EXPECT_EQ(owner.name(), "/switch");
  owner.acceptAnother(kLater + 1);
  EXPECT_TRUE(owner.hears("/rostopic_1", kLater + 1));
  EXPECT_FALSE(owner.hears("/switch", kLater + 1));
}

TEST(PresenceOwnerTest, WhoSpeaksKeepsTheSwitch) {
  PresenceOwner owner;
  owner.hears("/switch", 1'000'000'000);
  owner.acceptAnother(1'000'000'000 + PresenceOwner::kSilentNs);
  EXPECT_FALSE(owner.hears("/rostopic_1", 1'000'000'000 + PresenceOwner::kSilentNs));
  EXPECT_EQ(owner.name(), "/switch");
}

}  // namespace
}  // namespace ergotic::node
