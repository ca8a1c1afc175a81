// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "ergotic/tgr/driver.hpp"

/// What every tgr::Driver must do. A driver takes part with a Rig, default constructible:
///
///   static constexpr bool kFeelsForce;  // do its positions answer to force, from exact rest at 0?
///   tgr::Driver& driver();              // the same one, not yet open at first
///   void elapse();                      // lets the device live through one tick
///
/// and `INSTANTIATE_TYPED_TEST_SUITE_P(MyDriver, DriverContractTest, MyRig)`.
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

REGISTER_TYPED_TEST_SUITE_P(DriverContractTest,
                            HasSlicesWithinTheLimit,
                            WritesItsOwnSlicesOnly,
                            OpensWithZeroForce,
                            GivesNoForceFromMakeSafeUntilRearmed,
                            TakesMakeSafeAsOftenAsItComes,
                            RemembersAMakeSafeFromBeforeOpen,
                            SaysThatTheDeviceIsLostBeforeOpenAndAfterClose,
                            ClosesTwiceAndOpensAgainWithZeroForce,
                            StaysFiniteWhateverTheForce);

}  // namespace ergotic::test
