// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "physics/engine/guarded_network.hpp"

namespace ergotic::physics {
namespace {

using Law = GuardedLaw<double>;
using scene::LiaType;
using Network = test::GuardedNetwork<double>;

Law wallAt(double stiffness, double threshold = 0.0) {
  Law law = test::guardedLaw(LiaType::kContact);
  law.stiffness = stiffness;
  law.length = threshold;
  return law;
}

Law cubicSpring(double stiffness, double nonlinearity) {
  Law law = test::guardedLaw(LiaType::kCubic);
  law.stiffness = stiffness;
  law.nonlinearity = nonlinearity;
  return law;
}

/// A point between two masses weighs 1 / sum(w^2/M).
TEST(GuardedEndsTest, PointBetweenMassesMovesAsOneMass) {
  const double w = 0.3;
  Network pair;
  pair.mass(1.0, -0.01, 2e-3);
  pair.mass(0.5, -0.01, 2e-3);
  pair.guard(wallAt(0.4), {{0, 1.0 - w}, {1, w}});
  pair.start();
  Network single;
  single.mass((1.0 - w) * (1.0 - w) + 0.5 * w * w, -0.01, 2e-3);
  single.guard(wallAt(0.4), {{0, 1.0}});
  single.start();
  for (int n = 0; n < 60; ++n) {
    pair.step();
    single.step();
    ASSERT_NEAR((1.0 - w) * pair.x(0) + w * pair.x(1), single.x(0), 1e-16) << n;
  }
  EXPECT_GT(single.states[0].active, 3.0);
}

/// Two places between the same masses: only the difference of their weights works on each.
TEST(GuardedEndsTest, LinkBetweenPlacesOfOneStringActsByTheDifference) {
  Network places;
  places.mass(1.0, 0.3);
  places.mass(1.0, -0.1);
  places.guard(cubicSpring(1.0, 2.0), {{0, 0.7}, {1, 0.3}}, {{0, 0.4}, {1, 0.6}});
  places.start();
  Network difference;
  difference.mass(1.0, 0.3);
  difference.mass(1.0, -0.1);
  difference.guard(cubicSpring(1.0, 2.0), {{0, 0.3}}, {{1, 0.3}});
  difference.start();
  for (int n = 0; n < 100; ++n) {
    places.step();
    difference.step();
    ASSERT_NEAR(places.x(0), difference.x(0), 1e-14) << n;
  }
  EXPECT_LT(difference.x(0), 0.29);
}

TEST(GuardedEndsTest, PointsThatShareMassesKeepTheEnergy) {
  Network net;
  constexpr int kMasses = 10;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (int m = 0; m < kMasses; ++m) {
    net.mass(std::pow(2.0, anywhere(random)), anywhere(random));
    if (m > 0) {
      net.spring(m - 1, m, 0.3);
    }
  }
  net.spring(0, -1, 0.3);
  for (int l = 0; l < 12; ++l) {
    const int m = l % (kMasses - 1);
    const double w = 0.5 + 0.5 * anywhere(random);
    net.guard(l % 2 == 0 ? wallAt(3.0, -0.2) : cubicSpring(0.5, 4.0), {{m, 1.0 - w}, {m + 1, w}});
  }
  net.start();
  const double before = net.energy();
  // Two-sided springs start with the energy of their elongation, the grid of linear ones with that
  // between two steps: the sum is fixed from the first step on.
  for (int n = 0; n < 20000; ++n) {
    net.step();
    ASSERT_NEAR((net.energy() + net.lost()) / before, 1.0, 1e-11) << n;
  }
  EXPECT_LT(net.lost(), 1e-11 * before);
}

TEST(GuardedEndsTest, DampersOnSharedMassesOnlyDissipate) {
  Network net;
  constexpr int kMasses = 20;
  Law damped = cubicSpring(0.3, 0.2);
  damped.damping = 0.2;
  Law wall = wallAt(0.8, -0.1);
  wall.damping = 0.1;
  for (int m = 0; m < kMasses; ++m) {
    net.mass(1.0, std::sin(m * 1.3));
    net.guard(wall, {{m, 1.0}});
    if (m > 0) {
      net.guard(damped, {{m - 1, 1.0}}, {{m, 1.0}});
    }
  }
  net.guard(damped, {{0, 1.0}});
  net.start();
  const double before = net.energy();
  double energy = before;
  for (int n = 0; n < 2000; ++n) {
    net.step();
    ASSERT_LE(net.energy(), energy + 1e-14 * before) << n;
    ASSERT_NEAR((net.energy() + net.lost()) / before, 1.0, 1e-12) << n;
    energy = net.energy();
  }
  double moving = energy;
  for (const GuardedState<double>& state : net.states) {
    moving -= state.tank;
  }
  EXPECT_LT(moving, 1e-3 * before);
}

/// A hand, whose next place nobody knows, throws a ball about.
TEST(GuardedEndsTest, WorkOfAHandIsCountedWithItsRealMotion) {
  Network net;
  const int hand = net.mass(0.0, -0.5);
  const int ball = net.mass(1.0, 0.0);
  net.drift(ball) = -1e-3;
  Law law = wallAt(0.4);
  law.damping = 0.05;
  net.guard(law, {{hand, 1.0}}, {{ball, 1.0}});
  net.start();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  double work = 0.0;
  double weight = 0.0;
  double on_hand = 0.0;
  for (int n = 0; n < 20000; ++n) {
    net.step();
    const double before = net.d(hand);
    on_hand = -(net.states[0].force + net.states[0].damper);
    // It does not keep to its velocity.
    net.x(hand) -= before;
    const double d =
        std::clamp(before + any(random) - 0.05 * net.x(hand) - 0.1 * before, -1.0, 1.0);
    net.d(hand) = d;
    net.x(hand) += d;
    work -= on_hand * (before + d) / 2.0;
    weight -= 1e-3 * (2.0 * net.x(ball) - net.d(ball)) / 2.0;
    // Of the last step, the tank learns the hand's real motion in the next one.
    const double owed = -on_hand * (before - d) / 2.0;
    const double potential = 1e-3 * (net.x(ball) - net.d(ball) / 2.0);
    const double balance = net.energy() + net.lost() + potential - work - owed;
    ASSERT_NEAR(balance, 0.0, 1e-9 * (1.0 + std::abs(work))) << n;
  }
  EXPECT_GT(net.states[0].active, 50.0);
}

/// A slower module, stepped every fourth step of the link, is held in between.
TEST(GuardedEndsTest, HeldEndMovesAtOnceAndWorksThen) {
  constexpr int kRatio = 4;
  const std::vector<GuardedTerm> terms = {{0, 0, 0, {1, 0, 0}, 0}, {1, 1, 0, {-1, 0, 0}, -1}};
  std::vector<GuardedModule<double>> modules(2);
  GuardedLinks<double> links({{0, terms, 0, {0, 0, 0}}}, modules);
  std::vector<double> x = {0.2, 0.0};
  std::vector<double> d = {0.0, 0.0};
  std::vector<double> f = {0.0, 0.0};
  const std::vector<double> inverse_mass = {1.0, 1.0};
  const std::vector<double> zero = {0.0, 0.0};
  unsigned char due = 1;
  const Law law = wallAt(0.1);
  GuardedState<double> state;
  const GuardedView<double> view{x.data(),    d.data(),    f.data(),    inverse_mass.data(),
                                 zero.data(), zero.data(), zero.data(), &due};
  links.start(view, &law, &state);
  EXPECT_NEAR(state.tank, 0.002, 1e-15);
  double work = 0.0;
  for (int n = 0; n < 400; ++n) {
    due = n % kRatio == 0 ? 1 : 0;
    const double step = n > 0 && due != 0 ? 0.01 * std::cos(0.1 * n) : 0.0;
    const double held_force = -(state.force + state.damper);
    d[0] = due != 0 ? step : d[0];
    x[0] += step;
    work -= held_force * step / 2.0;
    links.step(view, &law, &state);
    work -= -(state.force + state.damper) * step / 2.0;
    d[1] += state.force + state.damper;
    x[1] += d[1];
    const double after = d[1] * d[1] / 2.0;
    ASSERT_NEAR(after + state.tank + state.lost, 0.002 + work, 1e-14) << n;
  }
}

/// Other threads step links on other modules meanwhile.
TEST(GuardedEndsTest, ModulesThatALinkDoesNotReachStayUntouched) {
  std::vector<GuardedModule<double>> modules(2);
  modules[0].links = 7.0;
  // Room for the ends of a link that moves.
  GuardedLinks<double> links({{0, {{1, 1, 0, {1, 0, 0}, -1}}, 5, {0, 0, 0}}}, modules);
  const std::vector<double> x = {0.0, 0.2};
  const std::vector<double> zero = {0.0, 0.0};
  const std::vector<double> one = {1.0, 1.0};
  const Law law = wallAt(0.1);
  GuardedState<double> state;
  links.step({x.data(), zero.data(), zero.data(), one.data(), zero.data(), one.data(), zero.data()},
             &law, &state);
  EXPECT_NE(state.active, 0.0);
  EXPECT_EQ(modules[0].links, 7.0);
  EXPECT_EQ(modules[1].links, 0.0);
}

TEST(GuardedEndsTest, EndMovesToOtherModulesWhilePlaying) {
  Network net;
  for (int m = 0; m < 3; ++m) {
    net.mass(1.0, 0.1);
  }
  net.guard(cubicSpring(0.3, 0.0), {{0, 0.5}, {1, 0.5}});
  net.start();
  const GuardedTerm terms[] = {{1, 1, 0, {0.2, 0, 0}, -1}, {2, 2, 0, {0.8, 0, 0}, -1}};
  net.guarded().setTerms(0, terms, 2, {0.0, 0.0, 0.0});
  net.links[0].terms.assign(std::begin(terms), std::end(terms));
  net.step();
  EXPECT_EQ(net.d(0), 0.0);
  EXPECT_LT(net.d(1), 0.0);
  EXPECT_NEAR(net.d(2), 4.0 * net.d(1), 1e-16);
}

TEST(GuardedEndsTest, StifferLawFillsTheTank) {
  Network net;
  net.mass(1.0, 0.1);
  net.guard(cubicSpring(0.3, 2.0), {{0, 1.0}});
  net.start();
  const double before = net.energy();
  const std::vector<Law> stiffer = {cubicSpring(0.6, 4.0)};
  net.guarded().retune(net.view(), net.laws.data(), stiffer.data(), net.states.data());
  EXPECT_NEAR(net.energy(), 2.0 * before, 1e-16);
}

TEST(GuardedEndsTest, EndsInOnePlaceOfSpaceDoNotPush) {
  Network net(3);
  net.mass(1.0);
  net.mass(1.0);
  net.guard(wallAt(0.5, 1.0), {{0, 1.0}}, {{1, 1.0}});
  net.start();
  net.step();
  EXPECT_EQ(net.d(0), 0.0);
  EXPECT_EQ(net.energy() - net.states[0].tank, 0.0);
}

TEST(GuardedEndsTest, SinglePrecisionKeepsABouncingBallGoing) {
  test::GuardedNetwork<float> net;
  const int ball = net.mass(1.0, -1.0, 0.01);
  net.guard(
      [] {
        GuardedLaw<float> law = test::guardedLaw<float>(LiaType::kPowerContact);
        law.stiffness = 5.0F;
        law.exponent = 1.5F;
        return law;
      }(),
      {{ball, 1.0}});
  net.drift(ball) = 1e-4F;
  net.start();
  float fastest = 0.0F;
  for (int n = 0; n < 1000000; ++n) {
    net.step();
    if (n >= 990000) {
      fastest = std::max(fastest, net.d(ball));
    }
  }
  const double expected = std::sqrt(0.01 * 0.01 + 2e-4);
  EXPECT_NEAR(static_cast<double>(fastest), expected, 0.02 * expected);
}

}  // namespace
}  // namespace ergotic::physics
