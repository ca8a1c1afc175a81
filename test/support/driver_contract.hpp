// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"
#include "support/alloc_count.hpp"

/// What every tgr::Driver must do. A driver takes part with a Rig, default constructible:
///
///   static constexpr bool kFeelsForce;  // do its positions answer to force, from exact rest at 0?
///   tgr::Driver& driver();              // the same one, not yet open at first
///   void elapse();                      // lets the device live through one tick
///
/// and `INSTANTIATE_TYPED_TEST_SUITE_P(MyDriver, DriverContractTest, MyRig)` in this namespace. It
/// is installed, for drivers of others (docs/driver.md).

namespace ergotic::test {

constexpr double kContractTickRateHz = 1000.0;

template <class Rig>
class DriverContractTest : public ::testing::Test {
 protected:
  using Slices = std::array<double, tgr::kMaxSlices>;

  tgr::Driver& driver() { return rig_.driver(); }
  void open() { driver().open(kContractTickRateHz); }

  std::uint32_t exchange(double force) {
    Slices forces;
    forces.fill(force);
    const std::uint32_t flags = driver().exchange(forces.data(), positions_.data());
    rig_.elapse();
    return flags;
  }
  /// The bits of makeSafe in `count` exchanges: how many had it.
  int madeSafe(int count, double force) {
    int safe = 0;
    for (int n = 0; n < count; ++n) {
      safe += (exchange(force) & tgr::kMadeSafe) != 0 ? 1 : 0;
    }
    return safe;
  }
  bool isAtRest() const {
    for (int i = 0; i < slices_; ++i) {
      if (positions_[static_cast<std::size_t>(i)] != 0.0) {
        return false;
      }
    }
    return true;
  }

  Rig rig_;
  int slices_ = rig_.driver().slices();
  Slices positions_{};
};
TYPED_TEST_SUITE_P(DriverContractTest);

TYPED_TEST_P(DriverContractTest, HasSlicesWithinTheLimit) {
  this->open();
  EXPECT_GE(this->driver().slices(), 1);
  EXPECT_LE(this->driver().slices(), tgr::kMaxSlices);
  EXPECT_EQ(this->driver().slices(), this->slices_);
  EXPECT_GE(this->driver().extraDelayTicks(), 0);
}

TYPED_TEST_P(DriverContractTest, WritesItsOwnSlicesOnly) {
  this->open();
  this->positions_.fill(777.0);
  this->exchange(0.0);
  for (int i = 0; i < tgr::kMaxSlices; ++i) {
    const double x = this->positions_[static_cast<std::size_t>(i)];
    EXPECT_EQ(x == 777.0, i >= this->slices_) << "slice " << i;
  }
}

TYPED_TEST_P(DriverContractTest, OpensWithZeroForce) {
  this->open();
  EXPECT_EQ(this->madeSafe(50, 0.0), 0);
  if (TypeParam::kFeelsForce) {
    EXPECT_TRUE(this->isAtRest());
    this->exchange(15.0);
    this->madeSafe(3, 15.0);
    EXPECT_FALSE(this->isAtRest()) << "or the test sees nothing";
  }
}

TYPED_TEST_P(DriverContractTest, GivesNoForceFromMakeSafeUntilRearmed) {
  this->open();
  EXPECT_EQ(this->madeSafe(5, 0.0), 0);
  this->driver().makeSafe();
  EXPECT_EQ(this->madeSafe(50, 15.0), 50);
  if (TypeParam::kFeelsForce) {
    EXPECT_TRUE(this->isAtRest());
  }
  this->driver().rearm();
  EXPECT_EQ(this->madeSafe(50, 15.0), 0);
  if (TypeParam::kFeelsForce) {
    EXPECT_FALSE(this->isAtRest());
  }
}

TYPED_TEST_P(DriverContractTest, TakesMakeSafeAsOftenAsItComes) {
  this->open();
  for (int n = 0; n < 3; ++n) {
    this->driver().makeSafe();
    EXPECT_EQ(this->madeSafe(2, 15.0), 2);
  }
  this->driver().rearm();
  EXPECT_EQ(this->madeSafe(2, 0.0), 0) << "one rearm is enough";
}

TYPED_TEST_P(DriverContractTest, RemembersAMakeSafeFromBeforeOpen) {
  this->driver().makeSafe();
  this->open();
  EXPECT_EQ(this->madeSafe(5, 15.0), 5);
  this->driver().close();
  this->open();
  EXPECT_EQ(this->madeSafe(5, 15.0), 5);
}

TYPED_TEST_P(DriverContractTest, SaysThatTheDeviceIsLostBeforeOpenAndAfterClose) {
  EXPECT_NE(this->exchange(15.0) & tgr::kDeviceLost, 0U);
  this->open();
  EXPECT_EQ(this->exchange(0.0) & tgr::kDeviceLost, 0U);
  this->driver().close();
  for (int n = 0; n < 5; ++n) {
    EXPECT_NE(this->exchange(15.0) & tgr::kDeviceLost, 0U);
  }
  for (int i = 0; i < this->slices_; ++i) {
    EXPECT_TRUE(std::isfinite(this->positions_[static_cast<std::size_t>(i)]));
  }
}

TYPED_TEST_P(DriverContractTest, ClosesTwiceAndOpensAgainWithZeroForce) {
  this->open();
  this->madeSafe(5, 15.0);
  this->driver().close();
  this->driver().close();
  this->driver().makeSafe();
  this->driver().rearm();
  this->open();
  EXPECT_EQ(this->exchange(0.0) & (tgr::kDeviceLost | tgr::kMadeSafe), 0U);
}

TYPED_TEST_P(DriverContractTest, StaysFiniteWhateverTheForce) {
  this->open();
  for (const double force : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), -1e308}) {
    for (int n = 0; n < 20; ++n) {
      this->exchange(force);
      for (int i = 0; i < this->slices_; ++i) {
        ASSERT_LT(std::abs(this->positions_[static_cast<std::size_t>(i)]), 1.0);
      }
    }
  }
}

TYPED_TEST_P(DriverContractTest, SaysTheSameOfItselfAsLongAsItIsOpen) {
  this->open();
  const int delay = this->driver().extraDelayTicks();
  const std::uint64_t uncalibrated = this->driver().uncalibrated();
  const double damping = this->driver().damping();
  const bool is_raw = this->driver().isRaw();
  const tgr::DeviceClock* const clock = this->driver().clock();
  const auto isSame = [&] {
    return this->driver().slices() == this->slices_ && this->driver().extraDelayTicks() == delay &&
           this->driver().uncalibrated() == uncalibrated && this->driver().damping() == damping &&
           this->driver().isRaw() == is_raw && this->driver().clock() == clock;
  };
  EXPECT_TRUE(clock == nullptr || clock->periodS() > 0.0);
  EXPECT_FALSE(this->driver().isSteppedByExchange() && this->driver().canHurt());
  EXPECT_TRUE(std::isfinite(damping));
  EXPECT_GE(damping, 0.0);
  if (this->slices_ < tgr::kMaxSlices) {
    EXPECT_EQ(uncalibrated >> static_cast<unsigned>(this->slices_), 0U) << "slices it has not";
  }
  this->madeSafe(20, 15.0);
  EXPECT_TRUE(isSame());
  this->driver().makeSafe();
  this->madeSafe(5, 15.0);
  this->driver().rearm();
  this->driver().reconnect();
  this->madeSafe(5, 15.0);
  EXPECT_TRUE(isSame());
}

TYPED_TEST_P(DriverContractTest, TakesAReconnectionOfAWellDeviceForNothing) {
  this->open();
  std::atomic<bool> done{false};
  std::atomic<int> begun{0};  // exchanges
  int refused = 0;
  std::thread operators([&] {
    constexpr int kTimes = 200;
    for (int n = 0; n < kTimes; ++n) {
      try {
        this->driver().reconnect();
      } catch (const Exception&) {
        ++refused;
      }
      const int from = begun;
      while (begun < from + 1) {
        std::this_thread::yield();
      }
    }
    done = true;
  });
  int lost = 0;
  while (!done) {
    ++begun;
    const std::uint32_t flags = this->exchange(0.0);
    lost += (flags & (tgr::kDeviceLost | tgr::kMadeSafe | tgr::kWriteFailed)) != 0 ? 1 : 0;
  }
  operators.join();
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(refused, 0);
  if (TypeParam::kFeelsForce) {
    EXPECT_TRUE(this->isAtRest());
  }
}

TYPED_TEST_P(DriverContractTest, StaysSafeThroughAReconnection) {
  this->open();
  this->driver().makeSafe();
  this->driver().reconnect();
  EXPECT_EQ(this->madeSafe(20, 15.0), 20);
  if (TypeParam::kFeelsForce) {
    EXPECT_TRUE(this->isAtRest());
  }
}

TYPED_TEST_P(DriverContractTest, IsSafeFromTheExchangeOnThatFollowsAMakeSafeOfAnotherThread) {
  this->open();
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(this->madeSafe(1, 0.0), 0);
    std::thread([this] { this->driver().makeSafe(); }).join();
    EXPECT_EQ(this->madeSafe(3, 15.0), 3);
    this->driver().rearm();
  }
  if (TypeParam::kFeelsForce) {
    EXPECT_TRUE(this->isAtRest());
  }
}

TYPED_TEST_P(DriverContractTest, AllocatesNothingInExchangeAndMakeSafe) {
  if (!AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the sanitizer has its own heap";
  }
  this->open();
  std::array<double, tgr::kMaxSlices> forces{};
  std::int64_t calls = 0;
  for (int n = 0; n < 300; ++n) {
    forces.fill(n % 2 == 0 ? 10.0 : std::numeric_limits<double>::quiet_NaN());
    {
      const AllocationScope scope;
      this->driver().exchange(forces.data(), this->positions_.data());
      if (n % 100 == 50) {
        this->driver().makeSafe();
      }
      if (n % 100 == 60) {
        this->driver().rearm();
      }
      calls += scope.calls();
    }
    this->rig_.elapse();
  }
  EXPECT_EQ(calls, 0);
}

REGISTER_TYPED_TEST_SUITE_P(DriverContractTest,
                            HasSlicesWithinTheLimit,
                            WritesItsOwnSlicesOnly,
                            OpensWithZeroForce,
                            GivesNoForceFromMakeSafeUntilRearmed,
                            TakesMakeSafeAsOftenAsItComes,
                            RemembersAMakeSafeFromBeforeOpen,
                            SaysThatTheDeviceIsLostBeforeOpenAndAfterClose,
                            ClosesTwiceAndOpensAgainWithZeroForce,
                            StaysFiniteWhateverTheForce,
                            SaysTheSameOfItselfAsLongAsItIsOpen,
                            TakesAReconnectionOfAWellDeviceForNothing,
                            StaysSafeThroughAReconnection,
                            IsSafeFromTheExchangeOnThatFollowsAMakeSafeOfAnotherThread,
                            AllocatesNothingInExchangeAndMakeSafe);

}  // namespace ergotic::test
