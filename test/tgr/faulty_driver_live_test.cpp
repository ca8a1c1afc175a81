// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/faulty_driver.hpp"

#include "ergotic/rt/clock.hpp"
#include "support/test.hpp"
#include "tgr/scripted_driver.hpp"

namespace ergotic::tgr {
namespace {

using test::kNan;

class FaultyDriverTest : public ::testing::Test {
 protected:
  void SetUp() override {
    script_.slices = 3;
    driver_->open(1000.0);
    exchange(0.0);
  }
  /// The device is at `x`, `x + 0.01`, ...
  std::uint32_t exchange(double x) {
    for (std::size_t i = 0; i < 3; ++i) {
      script_.positions[i] = x + 0.01 * static_cast<double>(i);
      true_[i] = script_.positions[i];
    }
    return driver_->exchange(forces_.data(), positions_.data());
  }
  void inject(InjectedFault kind, int slice, std::int64_t ticks, double amount = 0.0) {
    driver_->inject({kind, slice, ticks, amount});
  }
  bool isTrue() const { return positions_ == true_; }

  test::Script script_;
  std::unique_ptr<FaultyDriver> driver_ =
      makeFaultyDriver(std::make_unique<test::ScriptedDevice>(script_));
  std::array<double, 3> forces_{1.0, 2.0, 3.0};
  std::array<double, 3> positions_{};
  std::array<double, 3> true_{};
};

/// Else each tick that a slow exchange has cost would cost as much again.
TEST_F(FaultyDriverTest, IsNotSteppedByExchangesWhileItIsSlow) {
  EXPECT_FALSE(driver_->isSteppedByExchange());
  script_.is_stepped_by_exchange = true;
  EXPECT_TRUE(driver_->isSteppedByExchange());
  inject(InjectedFault::kSlow, 0, 2, 1e-6);
  exchange(0.0);
  EXPECT_FALSE(driver_->isSteppedByExchange());
  exchange(0.0);
  EXPECT_TRUE(driver_->isSteppedByExchange());
}

TEST_F(FaultyDriverTest, IsTheDeviceInsideWithoutOrders) {
  script_.flags = kMissingSample;
  script_.extra_delay_ticks = 4;
  script_.damping = 0.7;
  script_.uncalibrated = 5;
  script_.has_clock = true;
  EXPECT_EQ(exchange(0.02), kMissingSample);
  EXPECT_TRUE(isTrue());
  EXPECT_EQ(script_.forces[2], 3.0);
  EXPECT_EQ(driver_->extraDelayTicks(), 4);
  EXPECT_EQ(driver_->damping(), 0.7);
  EXPECT_DOUBLE_EQ(driver_->declaredDamping(), 0.07);
  EXPECT_TRUE(driver_->canHurt());
  script_.can_hurt = false;
  EXPECT_FALSE(driver_->canHurt());
  EXPECT_EQ(driver_->uncalibrated(), 5U);
  EXPECT_NE(driver_->clock(), nullptr);
  EXPECT_TRUE(driver_->setTarget(2, 0.01));
  EXPECT_EQ(script_.target, std::make_pair(2, 0.01));
  driver_->makeSafe();
  EXPECT_TRUE(script_.is_safe);
  driver_->rearm();
  EXPECT_FALSE(script_.is_safe);
}

TEST_F(FaultyDriverTest, SpoilsOnePositionForAsManyTicksAsOrdered) {
  struct Case {
    InjectedFault kind;
    double amount;
    double expected;  // of slice 1, which is at 0.03
  };
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const Case& c :
       {Case{InjectedFault::kNotANumber, 0.0, kNan}, Case{InjectedFault::kInfinite, 0.0, kInf},
        Case{InjectedFault::kJump, -0.05, 0.03 - 0.05}, Case{InjectedFault::kFrozen, 0.0, 0.02},
        Case{InjectedFault::kRail, 0.1, 0.1}}) {
    exchange(0.01);
    inject(c.kind, 1, 3, c.amount);
    for (int n = 0; n < 3; ++n) {
      EXPECT_EQ(exchange(0.02), kExchangeOk);
      EXPECT_TRUE(positions_[1] == c.expected ||
                  (std::isnan(c.expected) && std::isnan(positions_[1])))
          << static_cast<int>(c.kind) << ": " << positions_[1];
      EXPECT_EQ(positions_[0], true_[0]);
      EXPECT_EQ(positions_[2], true_[2]);
    }
    exchange(0.02);
    EXPECT_TRUE(isTrue()) << "over after three ticks";
  }
}

TEST_F(FaultyDriverTest, SpoilsAllSlices) {
  inject(InjectedFault::kRail, -1, 1, 0.5);
  exchange(0.02);
  EXPECT_EQ(positions_, (std::array<double, 3>{0.5, 0.5, 0.5}));
}

TEST_F(FaultyDriverTest, HoldsAndFlagsWhatIsMissing) {
  for (const int ticks : {1, 20, 1000}) {
    exchange(0.01);
    const auto before = true_;
    inject(InjectedFault::kMissing, -1, ticks);
    for (int n = 0; n < ticks; ++n) {
      ASSERT_EQ(exchange(0.02), kMissingSample);
      ASSERT_EQ(positions_, before);
    }
    EXPECT_EQ(exchange(0.02), kExchangeOk);
    EXPECT_TRUE(isTrue());
  }
}

TEST_F(FaultyDriverTest, HoldsWhatTheDeviceSawNotWhatAnotherFaultMadeOfIt) {
  inject(InjectedFault::kNotANumber, -1, 5);
  exchange(0.01);
  const auto before = true_;
  inject(InjectedFault::kMissing, -1, 1);
  exchange(0.02);
  EXPECT_EQ(positions_, before);
  const auto later = true_;
  inject(InjectedFault::kUnplugged, -1, 1);
  exchange(0.03);
  EXPECT_EQ(positions_, later);
}

TEST_F(FaultyDriverTest, LeavesTheLastForceWhereAWriteFails) {
  inject(InjectedFault::kWriteFails, 1, 2);
  forces_ = {10.0, 20.0, 30.0};
  EXPECT_EQ(exchange(0.0), kWriteFailed);
  EXPECT_EQ(script_.forces[0], 10.0);
  EXPECT_EQ(script_.forces[1], 2.0);
  EXPECT_EQ(script_.forces[2], 30.0);
  driver_->makeSafe();
  EXPECT_TRUE(script_.is_safe) << "not stopped by the fault";
  EXPECT_EQ(exchange(0.0), kWriteFailed);
  EXPECT_EQ(exchange(0.0), kExchangeOk);
  EXPECT_EQ(script_.forces[1], 20.0);
}

TEST_F(FaultyDriverTest, DoesNotAnswerUntilItIsReconnected) {
  exchange(0.01);
  const auto before = true_;
  inject(InjectedFault::kUnplugged, -1, 1);
  for (int n = 0; n < 50; ++n) {
    ASSERT_EQ(exchange(0.02), kDeviceLost);
    ASSERT_EQ(positions_, before);
    ASSERT_EQ(script_.forces[0], 0.0) << "nobody renews the force";
  }
  inject(InjectedFault::kJump, 0, 1, 0.1);
  EXPECT_EQ(exchange(0.02), kDeviceLost) << "another fault does not plug it in";
  driver_->reconnect();
  EXPECT_EQ(script_.reconnections, 1);
  exchange(0.02);
  EXPECT_EQ(exchange(0.02), kExchangeOk);
  EXPECT_TRUE(isTrue());
  EXPECT_EQ(script_.forces[0], 1.0);
}

TEST_F(FaultyDriverTest, TakesLongerByTheOrderedTime) {
  for (const double amount : {50e-6, 1e-3, 0.02}) {
    inject(InjectedFault::kSlow, -1, 1, amount);
    const std::int64_t start = rt::monotonicNs();
    EXPECT_EQ(exchange(0.02), kExchangeOk);
    EXPECT_GE(rt::monotonicNs() - start, static_cast<std::int64_t>(amount * 1e9));
    EXPECT_TRUE(isTrue());
    EXPECT_EQ(script_.forces[2], 3.0);
  }
}

TEST_F(FaultyDriverTest, AddsNoiseOfTheOrderedSize) {
  const int ticks = 20000;
  inject(InjectedFault::kNoise, 0, ticks, 2e-3);
  double squares = 0.0;
  for (int n = 0; n < ticks; ++n) {
    exchange(0.0);
    squares += positions_[0] * positions_[0];
  }
  EXPECT_NEAR(std::sqrt(squares / ticks), 2e-3, 5e-5);
  exchange(0.0);
  EXPECT_TRUE(isTrue());
}

TEST_F(FaultyDriverTest, TakesAnOrderInPlaceOfTheOneBefore) {
  inject(InjectedFault::kJump, 0, 100, 0.1);
  exchange(0.0);
  inject(InjectedFault::kJump, 1, 100, 0.2);
  inject(InjectedFault::kJump, 2, 100, 0.3);
  exchange(0.0);
  EXPECT_EQ(positions_[0], true_[0]);
  EXPECT_EQ(positions_[1], true_[1]);
  EXPECT_EQ(positions_[2], true_[2] + 0.3);
}

TEST_F(FaultyDriverTest, ForgetsItsOrdersWhenItIsOpenedAgain) {
  inject(InjectedFault::kRail, -1, 1000, 0.5);
  inject(InjectedFault::kUnplugged, -1, 1);
  driver_->close();
  driver_->open(1000.0);
  EXPECT_EQ(exchange(0.02), kExchangeOk);
  EXPECT_TRUE(isTrue());
}

TEST_F(FaultyDriverTest, RefusesOrdersOutsideTheirRange) {
  const auto complaint = [this](InjectedFault kind, int slice, std::int64_t ticks, double amount) {
    return complaintOf([&] { inject(kind, slice, ticks, amount); });
  };
  EXPECT_EQ(complaint(InjectedFault::kFrozen, 3, 1, 0.0), "slice of the fault: 3 , allowed -1...2");
  EXPECT_EQ(complaint(InjectedFault::kFrozen, 0, 0, 0.0),
            "ticks of the fault: 0 , allowed 1...1e+09");
  EXPECT_EQ(complaint(InjectedFault::kJump, 0, 1, std::nan("")),
            "amount of jump: nan m, allowed -1...1");
  EXPECT_EQ(complaint(InjectedFault::kSlow, 0, 1, 11.0), "amount of slow: 11 s, allowed 0...10");
  EXPECT_EQ(complaint(InjectedFault::kNoise, 0, 1, -1.0), "amount of noise: -1 m, allowed 0...0.1");
  EXPECT_EQ(complaint(static_cast<InjectedFault>(77), 0, 1, 0.0),
            "fault 77 is not known, allowed: 0...9");
  exchange(0.02);
  EXPECT_TRUE(isTrue());
}

TEST_F(FaultyDriverTest, ChecksAnOrderWithoutTakingIt) {
  const FaultOrder order{InjectedFault::kJump, 1, 3, 0.1};
  driver_->check(order);
  exchange(0.02);
  EXPECT_TRUE(isTrue());
  FaultOrder beyond = order;
  beyond.amount = 1.1;
  const std::string complaint = complaintOf([&] { driver_->check(beyond); });
  EXPECT_EQ(complaint, "amount of jump: 1.1 m, allowed -1...1");
  EXPECT_EQ(complaint, complaintOf([&] { driver_->inject(beyond); }));
}

TEST(FaultNamesTest, AreTheKinds) {
  EXPECT_EQ(faultNamed("not_a_number"), InjectedFault::kNotANumber);
  EXPECT_EQ(faultNamed("frozen"), InjectedFault::kFrozen);
  EXPECT_EQ(faultNamed("write_fails"), InjectedFault::kWriteFails);
  EXPECT_EQ(faultNamed("noise"), InjectedFault::kNoise);
  EXPECT_EQ(complaintOf([] { faultNamed("gremlin"); }),
            "fault 'gremlin' is not known, allowed: not_a_number, infinite, jump, frozen, rail, "
            "missing, slow, write_fails, unplugged, noise");
  EXPECT_EQ(complaintOf([] {
              faultNamed("gremlin", {"model_sulks", "signal"});
            }),
            "fault 'gremlin' is not known, allowed: not_a_number, infinite, jump, frozen, rail, "
            "missing, slow, write_fails, unplugged, noise, model_sulks, signal");
}

}  // namespace
}  // namespace ergotic::tgr
