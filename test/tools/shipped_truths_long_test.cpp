// SPDX-License-Identifier: BSD-3-Clause
// What the larger instruments that come along claim of themselves, as they are shipped.
#include <gtest/gtest.h>

#include "support/places.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

class ShippedTruthsTest : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedTruthsTest, Hold) {
  const std::string file = std::string("models/") + GetParam() + ".yaml";
  const test::Outcome outcome = test::run("check", test::repository(file) + " --truths");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

INSTANTIATE_TEST_SUITE_P(Models,
                         ShippedTruthsTest,
                         ::testing::Values("guitar",
                                           "piano12",
                                           "marimba12",
                                           "plate6",
                                           "tamtam",
                                           "timpani",
                                           "carillon",
                                           "seesaw",
                                           "clockwork"));

}  // namespace
}  // namespace ergotic::tools
