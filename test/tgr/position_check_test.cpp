// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/position_check.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "ergotic/tgr/safety/missing_samples.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What became of a sample.
struct Accepted {
  FaultReason reason = FaultReason::kNone;
  double x = 0.0;
};
bool operator==(const Accepted& a, const Accepted& b) {
  return a.reason == b.reason && a.x == b.x;
}
std::ostream& operator<<(std::ostream& out, const Accepted& a) {
  return out << toString(a.reason) << ", x = " << a.x;
}

class PositionCheckTest : public ::testing::Test {
 protected:
  Accepted accept(double x, std::int64_t ticks = 1) {
    Accepted result{FaultReason::kNone, x};
    result.reason = check_.accept(result.x, ticks);
    return result;
  }
  static Accepted good(double x) { return {FaultReason::kNone, x}; }

  PositionCheck check_{{0.1, 0.001, 5}};
};

TEST_F(PositionCheckTest, PassesWhatAHandDoes) {
  EXPECT_EQ(accept(0.05), good(0.05)) << "the first sample may be anywhere";
  EXPECT_EQ(accept(0.051), good(0.051));
  EXPECT_EQ(accept(0.0505), good(0.0505));
}

TEST_F(PositionCheckTest, HoldsWhatIsNoNumberOrAtItsRail) {
  accept(0.05);
  for (const double bad : {kNan, kInfinity, -kInfinity, 0.1, -0.1, 3.0}) {
    EXPECT_EQ(accept(bad), (Accepted{FaultReason::kBadPosition, 0.05}));
  }
}

TEST_F(PositionCheckTest, HoldsAJump) {
  accept(0.0);
  EXPECT_EQ(accept(0.00101), (Accepted{FaultReason::kJump, 0.0}));
  accept(0.0);
  EXPECT_EQ(accept(-0.00101), (Accepted{FaultReason::kJump, 0.0}));
}

TEST_F(PositionCheckTest, AllowsMoreWayForMoreTime) {
  accept(0.0);
  EXPECT_EQ(accept(0.0099, 10), good(0.0099)) << "nine ticks that the host missed";
  double x = 0.0;
  check_.hold(x, 1);
  check_.hold(x, 1);
  EXPECT_EQ(x, 0.0099);
  EXPECT_EQ(accept(0.0128), good(0.0128)) << "two samples that were missing";
  EXPECT_EQ(accept(0.0148), (Accepted{FaultReason::kJump, 0.0128})) << "time is used up";
}

TEST_F(PositionCheckTest, FindsASensorThatIsFrozen) {
  accept(0.05);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(accept(0.05), good(0.05));
  }
  EXPECT_EQ(accept(0.05), (Accepted{FaultReason::kFrozen, 0.05}));
  EXPECT_EQ(accept(0.0501), good(0.0501));
}

TEST_F(PositionCheckTest, DoesNotCallASensorFrozenForSamplesThatDidNotCome) {
  accept(0.05);
  double x = 0.0;
  for (int i = 0; i < 100; ++i) {
    check_.hold(x, 1);
  }
  EXPECT_EQ(accept(0.05, 100), good(0.05));
}

TEST_F(PositionCheckTest, LetsAValueStayIfNotToldOtherwise) {
  PositionCheck patient({0.1, 0.001, 0});
  for (int i = 0; i < 10000; ++i) {
    double x = 0.01;
    ASSERT_EQ(patient.accept(x, 1), FaultReason::kNone);
  }
}

TEST_F(PositionCheckTest, MeetsASliceAfreshAfterForgetting) {
  accept(-0.05);
  check_.forget();
  EXPECT_EQ(accept(0.09), good(0.09));
  check_.forget();
  EXPECT_EQ(accept(kNan), (Accepted{FaultReason::kBadPosition, 0.09}));
}

TEST(MissingSamplesTest, HoldsSoManyInARowAndNoMore) {
  MissingSamples missing(2);
  EXPECT_TRUE(missing.miss());
  EXPECT_TRUE(missing.miss());
  EXPECT_FALSE(missing.miss());
  EXPECT_FALSE(missing.miss());
  missing.cameAgain();
  EXPECT_TRUE(missing.miss());
}

TEST(MissingSamplesTest, MayHoldNone) {
  MissingSamples missing(0);
  EXPECT_FALSE(missing.miss());
}

}  // namespace
}  // namespace ergotic::tgr
