// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/master_watch.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(RepeatedFailureTest, ForgivesOneFailureAmongSuccesses) {
  RepeatedFailure failure;
  for (int n = 0; n < 3; ++n) {
    EXPECT_FALSE(failure.note(true));
    EXPECT_FALSE(failure.note(false));
  }
}

TEST(RepeatedFailureTest, LastsFromTheSecondFailureInARowToTheNextSuccess) {
  RepeatedFailure failure;
  EXPECT_FALSE(failure.note(true));
  for (int n = 0; n < 5; ++n) {
    EXPECT_TRUE(failure.note(true));
  }
  EXPECT_FALSE(failure.note(false));
  EXPECT_FALSE(failure.note(true));
}

}  // namespace
}  // namespace ergotic::node
