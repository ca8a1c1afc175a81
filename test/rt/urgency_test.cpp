// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/urgency.hpp"

#include <algorithm>
#include <random>

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// A thread that asks whether it may be urgent, and is so from then on.
class UrgencyTest : public ::testing::Test {
 protected:
  /// What it is told `ms` later, of which it used so many.
  bool step(std::int64_t ms, double used_ms) {
    now_ns_ += ms * kMs;
    used_ns_ += static_cast<std::int64_t>(used_ms * static_cast<double>(kMs));
    // The largest that any time up to now has used as an urgent thread beyond its share.
    beyond_ms_ += (is_urgent_ ? used_ms : 0.0) - Urgency::kShare * static_cast<double>(ms);
    beyond_ms_ = std::max(beyond_ms_, 0.0);
    is_urgent_ = urgency_.allows(now_ns_, used_ns_);
    return is_urgent_;
  }

  /// What it is told after so many ms of which it takes a share, if it asks once a ms.
  bool after(int ms, double share) {
    for (int i = 0; i < ms; ++i) {
      step(1, share);
    }
    return is_urgent_;
  }

  double beyondMs() const { return beyond_ms_; }

 private:
  Urgency urgency_;
  std::int64_t now_ns_ = 1'000'000 * kMs;
  std::int64_t used_ns_ = 0;
  bool is_urgent_ = true;
  double beyond_ms_ = 0.0;
};

TEST_F(UrgencyTest, LastsAsLongAsTheThreadTakesLittle) {
  EXPECT_TRUE(after(1, 1.0)) << "it begins so";
  EXPECT_TRUE(after(10'000, 0.24));
  EXPECT_FALSE(after(10'100, 0.26));
}

TEST_F(UrgencyTest, BearsABurstButNoFloodAndComesBackAfterIt) {
  EXPECT_TRUE(after(500, 0.01));
  EXPECT_TRUE(after(130, 1.0)) << "130 ms, of which a quarter is its share";
  EXPECT_FALSE(after(5, 1.0));
  EXPECT_FALSE(after(190, 1.0)) << "the flood goes on, but takes ordinary time";
  EXPECT_TRUE(after(15, 0.0));
}

TEST_F(UrgencyTest, CountsTimeThatWasSleptThrough) {
  EXPECT_TRUE(after(500, 0.1));
  EXPECT_TRUE(step(1000, 200.0));
}

TEST_F(UrgencyTest, IsBackSoonAfterItsHostStoppedTheMachine) {
  EXPECT_TRUE(after(500, 0.1));
  EXPECT_TRUE(step(3000, 3000.0)) << "3 s that look like use, of which a burst counts";
  EXPECT_TRUE(step(100, 100.0));
  EXPECT_FALSE(step(100, 100.0));
  EXPECT_FALSE(after(390, 1.0));
  EXPECT_TRUE(after(20, 1.0));
}

TEST_F(UrgencyTest, NobodyGetsMoreThanAShareAndABurstAndWhatIsUsedBetweenTwoQuestions) {
  constexpr double kBurstMs = Urgency::kBurstNs / 1e6;
  constexpr std::int64_t kLongestMs = 60;
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::uniform_int_distribution<std::int64_t> length(1, kLongestMs);
  double most_ms = 0.0;
  bool is_flooded = true;
  for (int i = 0; i < 200'000; ++i) {
    is_flooded = share(dice) < 0.1 ? !is_flooded : is_flooded;
    const std::int64_t ms = length(dice);
    step(ms, is_flooded ? share(dice) * static_cast<double>(ms) : 0.0);
    most_ms = std::max(most_ms, beyondMs());
  }
  EXPECT_LE(most_ms, kBurstMs + kLongestMs);
  EXPECT_GE(most_ms, kBurstMs) << "it was tried";
}

}  // namespace
}  // namespace ergotic::rt
