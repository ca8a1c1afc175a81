// SPDX-License-Identifier: BSD-3-Clause
// Hands that are inside a wall when force comes back: after a stall, a swap, `engage`, `recover`.

#include "support/test.hpp"
#include "tgr/wall_loop.hpp"

namespace ergotic::tgr {
namespace {

using test::Wall;
using test::WallLoop;

constexpr double kDepthM = 0.02;

/// A device with its noise, and a hand of that stiffness.
VirtualDriverConfig noisyDevice(double hand_n_per_m) {
  VirtualDriverConfig config;
  config.slices = 1;
  config.slice.hand_stiffness = hand_n_per_m;
  config.slice.hand_damping = std::sqrt(hand_n_per_m) / 4.0;
  return config;
}

struct Hand {
  double rate_hz;
  double hand_n_per_m;
  double wall_n_per_m;
};

class MutedWallTest : public ::testing::TestWithParam<Hand> {
 protected:
  /// In half a second, and there for another.
  void dive() { moveTo(-kDepthM - force() / GetParam().hand_n_per_m); }
  void leave() { moveTo(0.002); }
  void engage() {
    loop_.engage();
    loop_.run(config_.ramp_s, wall_);
  }
  /// What the wall gives at 20 mm, N.
  double force() const {
    return std::min(config_.force_limit_n, kDepthM * GetParam().wall_n_per_m);
  }
  /// Least share of the wall's force that goes out within two seconds.
  double leastShare() {
    double least = 1.0;
    for (int n = 0; n < static_cast<int>(2.0 * GetParam().rate_hz); ++n) {
      loop_.tick(wall_);
      const double whole = wall_(loop_.position(), loop_.velocity());
      least = std::min(least, loop_.force() / std::min(whole, config_.force_limit_n));
    }
    return least;
  }
  void expectTheWholeWall() {
    loop_.run(0.05, wall_);
    EXPECT_GT(leastShare(), 0.98);
    EXPECT_NEAR(loop_.position(), -kDepthM, 0.001);
    EXPECT_EQ(loop_.chain().fault(), FaultReason::kNone);
  }

  void moveTo(double target) {
    const double from = aim_;
    for (int i = 1; i <= 500; ++i) {
      aim_ = from + (target - from) * i / 500.0;
      loop_.aimAt(aim_);
      loop_.run(0.001, wall_);
    }
    loop_.run(0.5, wall_);
  }

  /// Less than what the walls store, so that it would tell if that were not known to be theirs.
  static SafetyConfig strictOnModels() {
    SafetyConfig config;
    config.energy_limit_j = 0.03;
    return config;
  }

  SafetyConfig config_ = strictOnModels();
  Wall wall_{GetParam().wall_n_per_m, 0.0, 0.0};
  WallLoop loop_{noisyDevice(GetParam().hand_n_per_m), config_, GetParam().rate_hz};

 private:
  double aim_ = 0.0;
};

TEST_P(MutedWallTest, ComesBackWholeAfterAStall) {
  engage();
  dive();
  for (const int muted : {0, 1, 30}) {
    loop_.resume(muted);
    loop_.run(config_.resume_ramp_s, wall_);
    expectTheWholeWall();
  }
}

TEST_P(MutedWallTest, ComesWholeToAHandThatIsInside) {
  dive();
  engage();
  expectTheWholeWall();
  loop_.resume(10);
  loop_.run(config_.resume_ramp_s, wall_);
  expectTheWholeWall();
}

/// Its force was not seen to grow from nothing.
TEST_P(MutedWallTest, ComesWholeToAHandThatIsInsideWhenTheModelComes) {
  const Wall wall = wall_;
  wall_ = {0.0, 0.0, 0.0};
  engage();
  moveTo(-kDepthM);
  wall_ = wall;
  loop_.resume(10);
  loop_.run(config_.resume_ramp_s + 1.0, wall_);  // soft hands are pushed out, and come again
  EXPECT_GT(leastShare(), 0.98);
  EXPECT_EQ(loop_.chain().fault(), FaultReason::kNone);
}

TEST_P(MutedWallTest, IsNoFaultForAHandThatGoesOutAfterwards) {
  dive();
  engage();
  leave();
  dive();
  loop_.resume(10);
  leave();
  EXPECT_EQ(loop_.chain().fault(), FaultReason::kNone);
}

TEST_P(MutedWallTest, IsNoFaultForAHandThatGoesOutWithTheGateClosed) {
  dive();
  loop_.recover();
  leave();
  EXPECT_EQ(loop_.chain().fault(), FaultReason::kNone);
  engage();
  dive();
  loop_.disengage();
  leave();
  EXPECT_EQ(loop_.chain().fault(), FaultReason::kNone);
}

TEST_P(MutedWallTest, ComesWholeAfterRecoveryInside) {
  engage();
  dive();
  loop_.recover();
  loop_.run(0.5, wall_);
  engage();
  expectTheWholeWall();
}

INSTANTIATE_TEST_SUITE_P(Hands,
                         MutedWallTest,
                         ::testing::Values(Hand{1000.0, 500.0, 1000.0},
                                           Hand{3000.0, 500.0, 1000.0},
                                           Hand{3000.0, 50000.0, 1000.0},
                                           Hand{1000.0, 50000.0, 1000.0},
                                           Hand{3000.0, 500.0, 3000.0},
                                           Hand{3000.0, 50000.0, 300.0}));

TEST(ClosedGateTest, NoEnergyIsJudgedThatReachesNoHand) {
  SafetyChain chain(SafetyConfig(), 1, 1e-3);
  const auto push = [&](double from, double to) {
    for (int n = 0; n <= 1000; ++n) {
      double x = from + (to - from) * n / 1000.0;
      chain.validate(&x, kExchangeOk, 0);
      double force = 15.0;
      chain.limit(&force);
    }
  };
  push(-0.09, 0.09);
  push(0.09, -0.09);
  EXPECT_EQ(chain.fault(), FaultReason::kNone);
  chain.engage();
  push(-0.09, 0.09);
  EXPECT_EQ(chain.fault(), FaultReason::kEnergy);
}

TEST(FadedForceTest, KeepsItsPlaceWhileAnotherModelTakesOver) {
  const double tick = 1e-3;
  SafetyConfig config;
  config.ramp_s = 0.1;
  config.resume_ramp_s = 0.01;
  SafetyChain chain(config, 1, tick);
  double force = 0.0;
  const auto run = [&](double x, double fade) {
    chain.validate(&x, kExchangeOk, 0);
    force = -1000.0 * x;
    chain.limit(&force, fade);
  };
  chain.engage();
  for (int n = 0; n <= 200; ++n) {
    run(0.01 * std::min(0.0, 1.0 - 0.01 * n), 1.0);
  }
  const double stored = chain.reading(0).energy_j;
  EXPECT_NEAR(stored, 0.05, 0.002);
  run(-0.01, 0.5);
  EXPECT_EQ(force, 5.0);
  run(-0.01, 0.0);
  EXPECT_EQ(force, 0.0);
  EXPECT_LT(chain.reading(0).energy_j, 0.002);
  chain.resume();
  for (int n = 0; n < 12; ++n) {
    run(-0.01, 1.0);
  }
  EXPECT_EQ(force, 10.0);
  EXPECT_NEAR(chain.reading(0).energy_j, stored, 0.002);
}

/// Pulls a hand that swings by 20 mm about 0 along with it: outwards with all its might, inwards
/// with next to nothing, never with nothing. Every swing begins with `again` at its inner end.
struct Pump {
  double given_out_j = 0.0;
  double way_m = 0.0;  ///< of the hand, from end to end
};

template <class Again>
Pump pump(const SafetyConfig& config, int swings, Again again) {
  VirtualDriverConfig device = test::plainDevice();
  device.slice.hand_stiffness = 5000.0;
  device.slice.hand_damping = 50.0;
  WallLoop loop(device, config, 3000.0);
  const auto model = [](double, double v) { return v > 0.0 ? 1000.0 : 0.01; };
  double least = 0.0;
  double most = 0.0;
  loop.engage();
  loop.run(config.ramp_s, [](double, double) { return 0.0; });
  loop.startMeter();
  for (int i = 0; i < swings * 200; ++i) {
    loop.aimAt(0.02 * std::sin(2.0 * M_PI * i / 200.0));
    if (i % 200 == 150) {
      again(loop);
    }
    loop.run(0.002, model);
    least = std::min(least, loop.position());
    most = std::max(most, loop.position());
  }
  EXPECT_EQ(loop.chain().fault(), FaultReason::kNone);
  return {-loop.leastEnergy(), most - least};
}

SafetyConfig withoutDetector() {
  SafetyConfig config;
  config.ramp_s = 0.1;
  config.energy_limit_j = 100.0;
  return config;
}

SafetyConfig withoutClamp() {
  SafetyConfig config = withoutDetector();
  config.energy_cap_j = 10.0;
  config.energy_supply_w = 20.0;
  return config;
}

TEST(PumpTest, EveryRampGivesNoMoreThanASpringOfItsForceAndWay) {
  const int swings = 20;
  const auto resume = [](WallLoop& loop) { loop.resume(3); };
  const auto engage = [](WallLoop& loop) {
    loop.disengage();
    loop.engage();
  };
  const SafetyConfig config = withoutDetector();
  const auto bound = [&](const Pump& p) {
    return swings * 0.5 * config.force_limit_n * p.way_m + config.energy_cap_j;
  };
  const Pump resumed = pump(config, swings, resume);
  EXPECT_LT(resumed.given_out_j, bound(resumed));
  const Pump engaged = pump(config, swings, engage);
  EXPECT_LT(engaged.given_out_j, bound(engaged));
  const Pump open = pump(withoutClamp(), swings, resume);
  EXPECT_GT(open.given_out_j, 1.5 * bound(open)) << "without the clamp";
}

TEST(PumpTest, GivesNextToNothingWithoutARamp) {
  const Pump pumped = pump(withoutDetector(), 20, [](WallLoop&) {});
  EXPECT_LT(pumped.given_out_j, withoutDetector().energy_cap_j + 0.001);
}

/// Holds a hand while force comes back again and again, then moves it out and in, ten times.
/// \return J, from there on
double givenOutAfter(int resumes, const SafetyConfig& config) {
  VirtualDriverConfig device = test::plainDevice();
  device.slice.hand_stiffness = 50000.0;
  device.slice.hand_damping = 100.0;
  WallLoop loop(device, config, 3000.0);
  const auto model = [](double, double v) { return v > -1e-3 ? 20.0 : 0.01; };
  loop.engage();
  loop.run(config.ramp_s, [](double, double) { return 0.0; });
  for (int i = 1; i <= 200; ++i) {
    loop.aimAt(-1e-4 * i);
    loop.run(0.001, model);
  }
  for (int n = 0; n < resumes; ++n) {
    loop.resume(0);
    loop.run(config.resume_ramp_s, model);
  }
  loop.startMeter();
  for (int i = 0; i < 2000; ++i) {
    loop.aimAt(-0.01 - 0.01 * std::cos(2.0 * M_PI * i / 200.0));
    loop.run(0.001, model);
  }
  EXPECT_EQ(loop.chain().fault(), FaultReason::kNone);
  return -loop.leastEnergy();
}

TEST(PumpTest, DoesNotGatherRampsWhileTheHandIsHeld) {
  const SafetyConfig config = withoutDetector();
  const double most = config.energy_cap_j + config.force_limit_n * kDepthM;
  EXPECT_LT(givenOutAfter(100, config), config.energy_cap_j + 0.005);
  EXPECT_GT(givenOutAfter(100, withoutClamp()), 5.0 * most);
}

/// What stalls of 1.2 ms give to a hand that is pushed with 15 N, J in a second.
double givenByStalls(int per_second) {
  constexpr double kRateHz = 3000.0;
  constexpr int kSeconds = 10;
  const SafetyConfig config = withoutDetector();
  const Wall wall{1000.0, 2.0, 0.0};
  WallLoop loop(test::plainDevice(), config, kRateHz);
  loop.engage();
  loop.aimAt(-0.045);
  loop.run(2.0, wall);
  EXPECT_NEAR(loop.force(), 15.0, 0.1);
  double given = 0.0;
  for (int n = 0; n < kSeconds * per_second; ++n) {
    loop.startMeter();
    loop.resume(4);
    loop.run(1.0 / per_second, wall);
    given -= loop.leastEnergy();
  }
  return given / kSeconds;
}

// docs/safety.md, "Stalls".
TEST(StallsTest, GiveAHandNoMoreThanIsSaid) {
  const double three = givenByStalls(3);
  const double ten = givenByStalls(10);
  RecordProperty("three_mW", std::to_string(1e3 * three));
  RecordProperty("ten_mW", std::to_string(1e3 * ten));
  EXPECT_LT(three, 0.6);
  EXPECT_GT(ten, 1.5 * three) << "which is why so many are a fault";
}

}  // namespace
}  // namespace ergotic::tgr
