// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "physics/engine/guarded_network.hpp"
#include "physics/engine/reference/bow_periods.hpp"

namespace ergotic::physics {
namespace {

using Law = GuardedLaw<double>;
using scene::LiaType;
using Network = test::GuardedNetwork<double>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kBowSpeed = 0.2;
constexpr double kBowForce = 0.5;

/// F = N sqrt(2a) v exp(-a v^2 + 1/2) as the smooth bow says it.
Law bowOfSteepness(double a, double step) {
  Law law = test::guardedLaw(LiaType::kSmoothBow);
  law.width = 2.0 / std::sqrt(a) * step;
  law.damping = kBowForce * std::sqrt(2.0 * a) / (0.63 * step);
  return law;
}

/// Stick-slip period of the oscillator of the reference, at this rate.
double periodAt(double rate, double steepness) {
  constexpr double kMass = 1e-3;
  constexpr double kOmega = 2.0 * kPi * 200.0;
  constexpr double kDampingRatio = 0.01;
  const double h = 1.0 / rate;
  Network net;
  const int mass = net.mass(h * h / kMass, 0.0, kBowSpeed * h);
  net.lose(mass) = 2.0 * kDampingRatio * kOmega * h;
  net.pull(mass) = kOmega * kOmega * h * h;
  const int bow = net.mass(0.0, 0.0, kBowSpeed * h);
  net.guard(bowOfSteepness(steepness, h), {{bow, 1.0}}, {{mass, 1.0}});
  net.start();
  std::vector<double> turns;
  const int limit = static_cast<int>(rate);
  for (int n = 0; n < limit && turns.size() < 60; ++n) {
    const double before = net.d(mass);
    net.step();
    if (before > 0.0 && net.d(mass) <= 0.0 && net.x(mass) > 0.0) {
      turns.push_back(n + before / (before - net.d(mass)));
    }
  }
  EXPECT_EQ(turns.size(), 60U);
  return (turns.back() - turns[turns.size() - 21]) / 20.0 * h;
}

TEST(GuardedFrictionTest, StickSlipPeriodIsThatOfTheContinuousModel) {
  for (const reference::BowPeriod& r : reference::kBowPeriods) {
    EXPECT_NEAR(periodAt(88200.0, r.steepness) / r.period_s, 1.0, 5e-4) << r.steepness;
  }
}

TEST(GuardedFrictionTest, StickSlipPeriodConverges) {
  for (const reference::BowPeriod& r : reference::kBowPeriods) {
    const double coarse = std::abs(periodAt(88200.0, r.steepness) / r.period_s - 1.0);
    const double fine = std::abs(periodAt(176400.0, r.steepness) / r.period_s - 1.0);
    EXPECT_LT(fine, 0.5 * coarse) << r.steepness;
  }
}

Law linearBow(double damping, double width) {
  Law law = test::guardedLaw(LiaType::kBow);
  law.damping = damping;
  law.width = width;
  return law;
}

Law tableBow(double height, double width) {
  Law law = test::guardedLaw(LiaType::kBowTable);
  const scene::Table table{
      {{-width, 0.0}, {-0.1 * width, -height}, {0.1 * width, height}, {width, 0.0}}, false};
  law.viscous = scene::GuardedCurve<double>(scene::interpolate(table), false);
  return law;
}

/// Slip of a free mass on a bow at rest, step by step, under friction of this stiffness S = F' h/M.
void expectOnlySlowed(const Law& law, double steepness) {
  Network net;
  const int mass = net.mass(1.0, 0.0, 0.9);
  net.guard(law, {{mass, 1.0}});
  net.start();
  double lost = 0.0;
  for (int n = 0; n < 200; ++n) {
    const double before = net.d(mass);
    const double energy = net.energy();
    net.step();
    // The slip that the force works on is the mean of both sides of the step.
    ASSERT_GE((net.d(mass) + before) * before, -1e-15) << steepness;
    ASSERT_LE(net.energy(), energy * (1.0 + 1e-15)) << steepness;
    ASSERT_GE(net.lost(), lost) << steepness;
    lost = net.lost();
  }
  EXPECT_NEAR(net.energy() + lost, 0.405, 1e-14) << steepness;
}

TEST(GuardedFrictionTest, SteepFrictionNeverReversesTheSlipAndAlwaysDissipates) {
  for (const double steepness : {0.1, 1.0, 2.0, 3.0, 10.0, 100.0, 1e4, 1e8}) {
    expectOnlySlowed(linearBow(1.5 * steepness, 1.0), steepness);
    expectOnlySlowed(tableBow(0.1 * steepness, 1.0), steepness);
    Law smooth = test::guardedLaw(LiaType::kSmoothBow);
    smooth.width = 1.0;
    smooth.damping = steepness;
    expectOnlySlowed(smooth, steepness);
  }
}

/// The same friction from the slip before the step, as the explicit scheme has it.
TEST(GuardedFrictionTest, ExplicitFrictionOfThatSteepnessReversesTheSlip) {
  const Law law = linearBow(1.5 * 3.0, 1.0);
  double d = 0.3;
  int reversals = 0;
  for (int n = 0; n < 50; ++n) {
    const double before = d;
    d -= law.slip(d).force;
    reversals += (d + before) * before < 0.0 ? 1 : 0;
  }
  EXPECT_GT(reversals, 10);
}

TEST(GuardedFrictionTest, RoughGroundHoldsAMassAgainstALoad) {
  Network net;
  const int mass = net.mass(1.0);
  net.drift(mass) = 0.01;
  net.guard(linearBow(1e6, 0.1), {{mass, 1.0}});
  net.start();
  for (int n = 0; n < 10000; ++n) {
    net.step();
  }
  EXPECT_LT(std::abs(net.x(mass)), 0.01);
  EXPECT_LT(net.d(mass), 1e-7);
}

/// Bow, contact and springs on the same masses: what friction takes is heat, nothing else is.
TEST(GuardedFrictionTest, BowOnGuardedSpringsKeepsTheBalance) {
  Network net;
  constexpr int kMasses = 12;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (int m = 0; m < kMasses; ++m) {
    net.mass(1.0, anywhere(random));
  }
  Law spring = test::guardedLaw(LiaType::kCubic);
  spring.stiffness = 0.1;
  spring.nonlinearity = 0.3;
  Law wall = test::guardedLaw(LiaType::kContact);
  wall.stiffness = 2.0;
  wall.length = -0.2;
  for (int m = 0; m + 1 < kMasses; ++m) {
    net.guard(spring, {{m, 1.0}}, {{m + 1, 1.0}});
    net.guard(wall, {{m, 1.0}});
  }
  const std::size_t bow = net.guard(linearBow(5.0, 0.05), {{4, 0.4}, {5, 0.6}});
  net.start();
  const double before = net.energy();
  double heat = 0.0;
  for (int n = 0; n < 20000; ++n) {
    net.step();
    ASSERT_GE(net.states[bow].lost, heat * (1.0 - 1e-14));
    heat = net.states[bow].lost;
    ASSERT_NEAR((net.energy() + net.lost()) / before, 1.0, 1e-12);
  }
  EXPECT_GT(heat, 0.1 * before);
  EXPECT_NEAR(net.lost() / heat, 1.0, 1e-9);
}

}  // namespace
}  // namespace ergotic::physics
