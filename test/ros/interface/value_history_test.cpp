// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/value_history.hpp"

#include <cstring>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

TEST(ValueHistoryTest, BringsBackWhatWasThereBitForBit) {
  ValueHistory history;
  EXPECT_FALSE(history.canUndo());
  const std::vector<double> odd = {1.0 / 3.0, -0.0, 5e-324};
  history.note(odd, 0);
  ASSERT_TRUE(history.canUndo());
  const std::vector<double> back = history.undo();
  ASSERT_EQ(back.size(), odd.size());
  EXPECT_EQ(std::memcmp(back.data(), odd.data(), sizeof(double) * odd.size()), 0);
  EXPECT_FALSE(history.canUndo());
}

TEST(ValueHistoryTest, TakesChangesWithinASecondOfOneAnotherForOne) {
  ValueHistory history;
  for (int i = 0; i < 40; ++i) {  // 4 s of a slider
    history.note({static_cast<double>(i)}, i * kSecondNs / 10);
  }
  history.note({40.0}, 39 * kSecondNs / 10 + kSecondNs);  // just a second later
  history.note({41.0}, 6 * kSecondNs);
  EXPECT_THAT(history.undo(), ElementsAre(41.0));
  EXPECT_THAT(history.undo(), ElementsAre(0.0));
  EXPECT_FALSE(history.canUndo());
}

TEST(ValueHistoryTest, BeginsAnotherStepAfterAnUndo) {
  ValueHistory history;
  history.note({1.0}, 0);
  history.undo();
  history.note({2.0}, 1);
  history.undo();
  EXPECT_FALSE(history.canUndo());
}

TEST(ValueHistoryTest, IsFiftyStepsDeep) {
  ValueHistory history;
  for (int i = 0; i < 70; ++i) {
    history.note({static_cast<double>(i)}, 2 * i * kSecondNs);
  }
  int steps = 0;
  double oldest = 0.0;
  for (; history.canUndo(); ++steps) {
    oldest = history.undo().front();
  }
  EXPECT_EQ(steps, 50);
  EXPECT_EQ(oldest, 20.0);
}

TEST(ValueHistoryTest, KnowsNothingOfAnotherScene) {
  ValueHistory history;
  history.note({1.0}, 0);
  history.clear();
  EXPECT_FALSE(history.canUndo());
}

}  // namespace
}  // namespace ergotic::node
