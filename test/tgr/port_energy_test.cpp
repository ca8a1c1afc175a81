// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/port_energy.hpp"

#include "ergotic/tgr/safety/passivity.hpp"
#include "support/test.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {
namespace {

PortEnergy::Rules rules(int delay_ticks = 1) {
  return {10.0, 0.0, 0.0, 1e-3, delay_ticks};
}

TEST(PortEnergyTest, CountsTheWorkOfTheForceThatActed) {
  for (const int delay : {1, 2, 5, PortEnergy::kMaxDelayTicks}) {
    PortEnergy port(rules(delay));
    SensorNoise noise(7);
    std::vector<double> forces;
    std::vector<double> ways;
    double energy = 0.0;
    for (int n = 0; n < 1000; ++n) {
      ways.push_back(1e-4 * noise.next());
      port.moved(ways.back(), 1);
      // Issued at m, sent by the exchange m + 1, acting until the next: d + 1 ticks later it acted.
      const int issued = n - 1 - delay;
      energy -= issued >= 0 ? forces[static_cast<std::size_t>(issued)] * ways.back() : 0.0;
      ASSERT_NEAR(port.energy(), energy, 1e-15) << "delay " << delay << ", tick " << n;
      double under_way = 0.0;
      for (int q = std::max(0, n - delay); q < n; ++q) {
        under_way += forces[static_cast<std::size_t>(q)];
      }
      ASSERT_NEAR(port.predicted(2e-4), energy - under_way * 2e-4, 1e-13);
      forces.push_back(noise.next());
      port.issue(forces.back());
    }
    EXPECT_LT(port.least(), 0.0);
    EXPECT_LE(port.least(), port.energy());
  }
}

TEST(PortEnergyTest, GivesBackAllThatASpringHasStored) {
  for (const double stiffness : {100.0, 1000.0, 10000.0}) {
    PortEnergy::Rules strict = rules();
    strict.cap_j = 1e-6;
    PortEnergy port(strict);
    double x = 0.0;
    const double step = -1e-6;
    for (int n = 0; n < 2000; ++n) {
      port.moved(step, 1);
      x += step;
      port.follow(-stiffness * x);
      port.issue(-stiffness * x);
    }
    EXPECT_NEAR(port.energy(), 0.5 * stiffness * x * x, 0.005 * stiffness * x * x);
  }
}

TEST(PortEnergyTest, RemembersNoMoreThanTheCapOfWhatWasDissipated) {
  PortEnergy::Rules strict = rules();
  strict.cap_j = 0.02;
  PortEnergy port(strict);
  for (int n = 0; n < 1000; ++n) {
    const double v = std::sin(0.1 * n);
    port.moved(1e-3 * v, 1);
    port.follow(-20.0 * v);
    port.issue(-20.0 * v);
  }
  port.follow(0.0);
  port.issue(0.0);
  port.moved(0.0, 1);
  EXPECT_LE(port.energy(), 0.02);
}

TEST(PortEnergyTest, GivesCreditForTheDampingOfTheSliceWhileThereIsForce) {
  PortEnergy::Rules damped = rules();
  damped.damping = 2.0;
  PortEnergy port(damped);
  port.moved(1e-3, 1);
  EXPECT_EQ(port.energy(), 0.0) << "no force";
  port.issue(1.0);
  port.moved(1e-3, 1);
  port.issue(1.0);
  port.moved(1e-3, 1);
  EXPECT_DOUBLE_EQ(port.energy(), -1e-3 + 2.0 * 1e-6 / 1e-3);
  port.moved(1e-3, 4);
  EXPECT_DOUBLE_EQ(port.energy(), -2e-3 + 2.0 * 1e-6 / 1e-3 * 1.25);
}

/// A spring is pushed to and fro at up to 0.1 m/s. \return lowest energy in the last 50 ms, J
double leastOfASpring(PortEnergy& port, double stiffness, double seconds) {
  constexpr double kTick = 1e-3;
  constexpr double kDepthM = 0.002;
  const auto ticks = static_cast<int>(seconds / kTick);
  double least = 0.0;
  double last = 0.0;
  for (int n = 0; n < ticks; ++n) {
    const double x = kDepthM * (std::cos(50.0 * kTick * n) - 1.0);
    port.moved(n == 0 ? 0.0 : x - last, 1);
    last = x;
    port.follow(-stiffness * x);
    port.issue(-stiffness * x);
    least = n >= ticks - 50 ? std::min(least, port.energy()) : least;
  }
  return least;
}

TEST(PortEnergyTest, GivesCreditAsLongAsTheDampingIsEnoughForWhatSamplingGivesOut) {
  PortEnergy::Rules damped = rules();
  damped.damping = 2.0;
  const double passive = 2.0 * damped.damping / (3.0 * damped.tick_s);
  PortEnergy soft(damped);
  EXPECT_GE(leastOfASpring(soft, 0.95 * passive, 1.0), 0.0);
  PortEnergy stiff(damped);
  PortEnergy alone(rules());
  EXPECT_DOUBLE_EQ(leastOfASpring(stiff, 1.05 * passive, 1.0),
                   leastOfASpring(alone, 1.05 * passive, 1.0));
  EXPECT_LT(stiff.energy(), -0.01) << "it pays for itself";
}

TEST(PortEnergyTest, SoonForgetsHowStiffAContactWas) {
  PortEnergy::Rules damped = rules();
  damped.damping = 2.0;
  const double passive = 2.0 * damped.damping / (3.0 * damped.tick_s);
  PortEnergy port(damped);
  leastOfASpring(port, 2.0 * passive, 0.5);
  leastOfASpring(port, 0.5 * passive, 0.2);
  port.restart();
  EXPECT_GE(leastOfASpring(port, 0.5 * passive, 1.0), 0.0);
}

TEST(PortEnergyTest, SuppliesPowerUpToTheCap) {
  PortEnergy::Rules supplied = rules();
  supplied.supply_w = 1.0;
  supplied.cap_j = 0.01;
  PortEnergy port(supplied);
  port.moved(0.0, 4);
  EXPECT_DOUBLE_EQ(port.energy(), 0.004);
  port.moved(0.0, 100);
  EXPECT_DOUBLE_EQ(port.energy(), 0.01);
}

TEST(PortEnergyTest, TakesBackAForceThatWasNotSent) {
  PortEnergy port(rules());
  port.moved(0.0, 1);
  port.issue(5.0);
  port.withdraw();
  EXPECT_EQ(port.issued(), 0.0);
  port.moved(1.0, 1);
  port.issue(0.0);
  port.moved(1.0, 1);
  EXPECT_EQ(port.energy(), 0.0);
}

TEST(PortEnergyTest, ForgetsOnRequest) {
  PortEnergy port(rules());
  port.issue(5.0);
  port.issue(5.0);
  port.moved(1.0, 1);
  ASSERT_EQ(port.energy(), -5.0);
  port.restart();
  EXPECT_EQ(port.energy(), 0.0);
  EXPECT_EQ(port.least(), -5.0);
  EXPECT_EQ(port.issued(), 5.0);
  port.forget();
  EXPECT_EQ(port.least(), 0.0);
  EXPECT_EQ(port.issued(), 0.0);
}

/// A port that a spring pushed back over 20 mm up to 10 N, without a force that went out.
PortEnergy unfeltSpring() {
  PortEnergy port(rules());
  for (int n = 1; n <= 20; ++n) {
    port.moved(-1e-3, 1);
    port.follow(0.5 * n);
  }
  return port;
}

TEST(PortEnergyTest, GivesARampWhatALinearSpringHasStored) {
  PortEnergy port = unfeltSpring();
  EXPECT_EQ(port.energy(), 0.0);
  const double stored = 0.5 * 10.0 * 0.019;  // the first force was met 1 mm inside
  port.lift(0.25);
  EXPECT_DOUBLE_EQ(port.energy(), 0.25 * stored);
  port.lift(0.75);
  EXPECT_DOUBLE_EQ(port.energy(), stored);
  port.lift(-0.5);
  EXPECT_DOUBLE_EQ(port.energy(), 0.5 * stored);
}

TEST(PortEnergyTest, TakesNoMoreThanThereIsWhenTheGainFalls) {
  PortEnergy port = unfeltSpring();
  port.lift(-1.0);
  EXPECT_EQ(port.energy(), 0.0);
  port.issue(5.0);
  port.issue(5.0);
  port.moved(1e-3, 1);
  port.lift(-1.0);
  EXPECT_EQ(port.energy(), -5e-3);
  EXPECT_EQ(port.least(), -5e-3);
}

TEST(PortEnergyTest, GivesARampNothingForAForceThatPointsAwayFromWhereItBegan) {
  PortEnergy port(rules());
  port.follow(5.0);
  port.moved(0.02, 1);
  port.lift(1.0);
  EXPECT_EQ(port.energy(), 0.0);
  port.moved(-0.04, 1);
  port.follow(-5.0);  // begins here
  port.lift(1.0);
  EXPECT_EQ(port.energy(), 0.0);
}

TEST(EnergyClampTest, GivesOutWhatThereIsAndNoMore) {
  EXPECT_EQ(EnergyClamp::limited(10.0, 1e-3, 0.02), 10.0);
  EXPECT_DOUBLE_EQ(EnergyClamp::limited(10.0, 1e-3, 0.004), 4.0);
  EXPECT_DOUBLE_EQ(EnergyClamp::limited(-10.0, -1e-3, 0.004), -4.0);
  EXPECT_EQ(EnergyClamp::limited(10.0, 1e-3, 0.0), 0.0);
  EXPECT_EQ(EnergyClamp::limited(10.0, 1e-3, -7.0), 0.0);
}

TEST(EnergyClampTest, LeavesForcesThatTakeEnergyAlone) {
  EXPECT_EQ(EnergyClamp::limited(-10.0, 1e-3, -7.0), -10.0);
  EXPECT_EQ(EnergyClamp::limited(10.0, 0.0, -7.0), 10.0);
}

TEST(EnergyClampTest, NeverMakesAForceLarger) {
  SensorNoise noise(11);
  for (int n = 0; n < 100000; ++n) {
    const double force = 20.0 * noise.next();
    const double dx = 1e-3 * noise.next();
    const double energy = 1e-3 * noise.next();
    const double limited = EnergyClamp::limited(force, dx, energy);
    ASSERT_LE(std::abs(limited), std::abs(force));
    ASSERT_GE(limited * force, 0.0);
    ASSERT_LE(limited * dx, std::max(energy, 0.0) * (1.0 + 1e-12));
  }
}

TEST(PassivityControllerTest, DampsWhatWasGivenOut) {
  const double tick = 1e-3;
  const PassivityController controller(0.3, tick);
  EXPECT_EQ(controller.damped(5.0, 1e-4, 0.0), 5.0) << "a passive port";
  EXPECT_EQ(controller.damped(5.0, 0.0, -1.0), 5.0) << "it stands still";
  // alpha = -E / (T v^2) = 1e-7 / (1e-3 (0.1 m/s)^2) = 0.01 N s/m
  EXPECT_DOUBLE_EQ(controller.damped(5.0, 1e-4, -1e-7), 5.0 - 0.01 * 0.1);
  // at most 0.15 m / T = 45 N s/m
  EXPECT_DOUBLE_EQ(controller.damped(5.0, 1e-4, -1.0), 5.0 - 45.0 * 0.1);
  EXPECT_DOUBLE_EQ(controller.damped(5.0, -1e-4, -1.0), 5.0 + 45.0 * 0.1);
}

}  // namespace
}  // namespace ergotic::tgr
