// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/urgency.hpp"

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// What it says of a thread that takes so many ms of each 10 ms, after `ms` more.
class UrgencyTest : public ::testing::Test {
 protected:
  bool after(std::int64_t ms, double share) {
    bool allows = true;
    for (const std::int64_t end_ns = now_ns_ + ms * kMs; now_ns_ < end_ns;) {
      now_ns_ += kMs;
      used_ns_ += static_cast<std::int64_t>(share * static_cast<double>(kMs));
      allows = urgency_.allows(now_ns_, used_ns_);
    }
    return allows;
  }

  Urgency urgency_;
  std::int64_t now_ns_ = 1'000'000 * kMs;
  std::int64_t used_ns_ = 0;
};

TEST_F(UrgencyTest, LastsAsLongAsTheThreadTakesLittle) {
  EXPECT_TRUE(after(1, 1.0)) << "it begins so";
  EXPECT_TRUE(after(1000, 0.24));
  EXPECT_FALSE(after(401, 0.26));
  EXPECT_FALSE(after(1000, 1.0));
}

TEST_F(UrgencyTest, EndsWithinTwoWindowsOfAFloodAndComesBackAfterIt) {
  EXPECT_TRUE(after(500, 0.01));
  EXPECT_FALSE(after(400, 1.0));
  EXPECT_TRUE(after(400, 0.0));
}

TEST_F(UrgencyTest, CountsAWindowThatWasSleptThrough) {
  EXPECT_TRUE(after(500, 0.1));
  now_ns_ += 1000 * kMs;
  used_ns_ += 200 * kMs;
  EXPECT_TRUE(urgency_.allows(now_ns_, used_ns_));
}

}  // namespace
}  // namespace ergotic::rt
