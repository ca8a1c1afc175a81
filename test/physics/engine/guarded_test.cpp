// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "physics/engine/guarded_network.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using Law = GuardedLaw<double>;
using scene::LiaType;
using Network = test::GuardedNetwork<double>;

constexpr double kPi = 3.14159265358979323846;

Law powerContact(double stiffness, double exponent) {
  Law law = test::guardedLaw(exponent == 1.0 ? LiaType::kContact : LiaType::kPowerContact);
  law.stiffness = stiffness;
  law.exponent = exponent;
  return law;
}

Law cubicSpring(double stiffness, double nonlinearity) {
  Law law = test::guardedLaw(LiaType::kCubic);
  law.stiffness = stiffness;
  law.nonlinearity = nonlinearity;
  return law;
}

/// A ball that hits a wall with F = K p^a and stays in contact for 1 ms: closed form.
struct Impact {
  double exponent;
  double rate;
  double mass = 5e-3;
  double speed = 1.0;
  double duration = 1e-3;
  double deepest = 0.0;
  double stiffness = 0.0;

  Impact(double a, double rate_hz) : exponent(a), rate(rate_hz) {
    const double i =
        std::sqrt(kPi) * std::tgamma(1.0 + 1.0 / (a + 1.0)) / std::tgamma(0.5 + 1.0 / (a + 1.0));
    deepest = duration * speed / (2.0 * i);
    stiffness = (a + 1.0) * mass * speed * speed / (2.0 * std::pow(deepest, a + 1.0));
  }
  double inverseMass() const { return 1.0 / (rate * rate * mass); }
  double force(double p) const { return p > 0.0 ? stiffness * std::pow(p, exponent) : 0.0; }
};

/// Relative errors of one impact. Duration: from where the straight line before crosses the wall to
/// where the straight line after does. Peak: by a parabola through the three deepest samples, each
/// less `correction` h^2 F/M: what a sample stands for, to second order, is the position of the
/// continuous motion plus that much.
struct Errors {
  double duration = 0.0;
  double peak = 0.0;
  double rebound = 0.0;
};

struct Flight {
  std::vector<double> depth;
  std::vector<double> force;
  double position = 0.0;
  double velocity = 0.0;
};

Errors judge(const Impact& impact, double start, const Flight& flight, double correction) {
  const double d = impact.speed / impact.rate;
  std::vector<double> p(flight.depth);
  for (std::size_t n = 0; n < p.size(); ++n) {
    p[n] -= correction * impact.inverseMass() * flight.force[n];
  }
  const auto top = std::max_element(p.begin(), p.end());
  const double curve = (top[-1] - 2.0 * top[0] + top[1]) / 2.0;
  const double slope = (top[1] - top[-1]) / 2.0;
  const double deepest = top[0] - slope * slope / (4.0 * curve);
  const double out = static_cast<double>(p.size()) - flight.position / flight.velocity;
  return {(out + start / d) / (impact.rate * impact.duration) - 1.0,
          impact.force(deepest) / impact.force(impact.deepest) - 1.0, -flight.velocity / d - 1.0};
}

Errors guardedImpact(const Impact& impact, double phase) {
  const double d = impact.speed / impact.rate;
  const double start = -(5.0 + phase) * d;
  Network net;
  const int ball = net.mass(impact.inverseMass(), start, d);
  net.guard(powerContact(impact.stiffness, impact.exponent), {{ball, 1.0}});
  net.start();
  Flight flight;
  do {
    flight.depth.push_back(net.x(ball));
    net.step();
    flight.force.push_back(net.states[0].force);
  } while (net.d(ball) > 0.0 || flight.force.back() != 0.0 || net.states[0].tank > 0.0);
  flight.position = net.x(ball);
  flight.velocity = net.d(ball);
  return judge(impact, start, flight, 0.0);
}

Errors explicitImpact(const Impact& impact, double phase) {
  const double d = impact.speed / impact.rate;
  const double start = -(5.0 + phase) * d;
  ergotic::test::SceneBuilder b;
  const int ball = b.mass(impact.mass, start - d, impact.speed);  // its first step is free
  b.link(scene::LiaType::kPowerContact, ball, b.ground(), impact.stiffness);
  b.scene.lias.back().law.edit().exponent = {impact.exponent};
  b.hear(ball, 0);
  b.hear(ball, 1, scene::Quantity::kForce);
  b.hear(ball, 2, scene::Quantity::kVelocity);
  ergotic::test::Player player(b.scene, {impact.rate, 1});
  Flight flight;
  do {
    player.tick();
    flight.depth.push_back(player.heard[0].back());
    flight.force.push_back(-player.heard[1].back());
  } while (player.heard[2].back() > 0.0 || flight.depth.back() > 0.0);
  flight.position = flight.depth.back();
  flight.velocity = player.heard[2].back() / impact.rate;
  flight.depth.pop_back();
  flight.force.pop_back();
  return judge(impact, start, flight, 1.0 / 24.0);
}

/// Root mean squares over 64 phases of the impact between two samples.
struct Accuracy {
  Errors rms;
};

template <class Play>
Accuracy accuracyOf(const Impact& impact, const Play& play) {
  Accuracy a;
  constexpr int kPhases = 64;
  for (int k = 0; k < kPhases; ++k) {
    const Errors e = play(impact, k / double{kPhases});
    a.rms.duration += e.duration * e.duration / kPhases;
    a.rms.peak += e.peak * e.peak / kPhases;
    a.rms.rebound += e.rebound * e.rebound / kPhases;
  }
  a.rms = {std::sqrt(a.rms.duration), std::sqrt(a.rms.peak), std::sqrt(a.rms.rebound)};
  return a;
}

TEST(GuardedTest, ContactLastsAsLongAndReboundsAsFastAsInClosedForm) {
  for (const double a : {1.0, 1.5, 2.3, 3.0}) {
    const Accuracy guarded = accuracyOf(Impact(a, 44100.0), guardedImpact);
    EXPECT_LT(guarded.rms.duration, 2e-5) << a;
    EXPECT_LT(guarded.rms.rebound, 1e-12) << a;
    const Accuracy plain = accuracyOf(Impact(a, 44100.0), explicitImpact);
    EXPECT_LT(plain.rms.duration, 5e-4) << a;
    EXPECT_LT(plain.rms.rebound, 5e-4) << a;
    EXPECT_GT(plain.rms.duration, 20.0 * guarded.rms.duration) << a;
  }
}

/// The force at first touch jumps in its slope between two samples: only the mean of the law over
/// the step knows when.
TEST(GuardedTest, ContactPushesAsHardAsInClosedForm) {
  for (const double a : {1.0, 1.5, 2.3, 3.0}) {
    const Accuracy guarded = accuracyOf(Impact(a, 44100.0), guardedImpact);
    EXPECT_LT(guarded.rms.peak, 2e-5) << a;
    EXPECT_LT(accuracyOf(Impact(a, 44100.0), explicitImpact).rms.peak, 5e-4) << a;
  }
}

TEST(GuardedTest, ContactOfFiveSamplesStillReboundsExactly) {
  for (const double a : {1.0, 1.5, 2.3, 3.0}) {
    const Accuracy guarded = accuracyOf(Impact(a, 5512.5), guardedImpact);
    EXPECT_LT(guarded.rms.duration, 4e-3) << a;
    EXPECT_LT(guarded.rms.rebound, 1e-12) << a;
    EXPECT_GT(accuracyOf(Impact(a, 5512.5), explicitImpact).rms.duration, 1e-2) << a;
  }
}

/// A string whose masses all lie near a barrier, plucked towards it.
struct Barrier {
  Network net;
  Barrier(double closed_kappa, double exponent, bool guarded) {
    constexpr int kMasses = 100;
    constexpr double kKappa = 0.9;
    constexpr double kAmplitude = 1e-3;
    const double scale = exponent == 1.0 ? 1.0 : std::pow(kAmplitude, 1.0 - exponent);
    Law law = powerContact(closed_kappa * scale, exponent);
    law.length = -0.3 * kAmplitude;
    for (int m = 0; m < kMasses; ++m) {
      net.mass(1.0, -kAmplitude * std::sin(kPi * (m + 1) / (kMasses + 1.0)));
    }
    for (int m = 0; m < kMasses; ++m) {
      net.spring(m, m + 1 < kMasses ? m + 1 : -1, kKappa);
      if (guarded) {
        net.guard(law, {{m, 1.0}});
      }
    }
    net.spring(0, -1, kKappa);
    net.start();
  }
};

TEST(GuardedTest, StringOnABarrierKeepsItsEnergy) {
  for (const double kappa : {0.05, 1.0, 100.0}) {
    for (const double exponent : {1.0, 1.5}) {
      Barrier barrier(kappa, exponent, true);
      barrier.net.step();
      const double before = barrier.net.energy();
      double worst = 0.0;
      for (int n = 0; n < 40000; ++n) {
        barrier.net.step();
        const double now = barrier.net.energy() + barrier.net.lost();
        worst = std::max(worst, std::abs(now / before - 1.0));
      }
      EXPECT_LT(worst, 1e-11) << kappa << " " << exponent;
    }
  }
}

/// Cubic springs between 64 masses, both ends fixed, at rest in random places.
Network cubicChain(double amplitude) {
  Network net;
  constexpr int kMasses = 64;
  const Law law = cubicSpring(0.2, 0.05);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (int m = 0; m < kMasses; ++m) {
    net.mass(1.0, amplitude * anywhere(random));
  }
  for (int m = 0; m + 1 < kMasses; ++m) {
    net.guard(law, {{m, 1.0}}, {{m + 1, 1.0}});
  }
  net.guard(law, {{0, 1.0}});
  net.guard(law, {{kMasses - 1, 1.0}});
  net.start();
  return net;
}

/// Without refunds it would lose nearly all, without counting shared masses gain 10^4 times.
TEST(GuardedTest, CubicChainKeepsItsEnergyAtAnyAmplitude) {
  for (const double amplitude : {0.1, 2.0, 30.0}) {
    Network net = cubicChain(amplitude);
    const double before = net.energy();
    double worst = 0.0;
    double moving = 0.0;
    constexpr int kSteps = 40000;
    for (int n = 0; n < kSteps; ++n) {
      net.step();
      worst = std::max(worst, std::abs(net.energy() / before - 1.0));
      double tanks = 0.0;
      for (const GuardedState<double>& state : net.states) {
        tanks += state.tank;
      }
      moving += (1.0 - tanks / before) / kSteps;
    }
    EXPECT_LT(worst, 1e-11) << amplitude;
    EXPECT_NEAR(net.lost(), 0.0, 1e-11 * before) << amplitude;
    EXPECT_LT(net.clipFraction(), 0.05) << amplitude;
    if (amplitude < 10.0) {
      EXPECT_GT(moving, 0.1) << amplitude;  // what the tanks hold is not out of reach for good
    }
  }
}

/// Where a ball of 5 g comes to rest that 2 N press onto a damped wall, in units of what the wall
/// yields in one step, and how much it still moves, m.
struct Rest {
  double too_deep = 0.0;
  double peak_to_peak = 0.0;
};

Rest press(double kt, double restitution, double speed) {
  constexpr double kRate = 44100.0;
  constexpr double kLoad = 2.0;
  const double inverse_mass = 1.0 / (kRate * kRate * 5e-3);
  const double log_e = std::log(restitution);
  const double ratio = -log_e / std::sqrt(kPi * kPi + log_e * log_e);
  Law law = powerContact(kt / inverse_mass, 1.0);
  law.damping = 2.0 * ratio * std::sqrt(law.stiffness / inverse_mass);
  Network net;
  const int ball = net.mass(inverse_mass, -1e-4, speed / kRate);
  net.drift(ball) = kLoad * inverse_mass;
  net.guard(law, {{ball, 1.0}});
  net.start();
  for (int n = 0; n < 20000; ++n) {
    net.step();
  }
  const double place = net.x(ball);
  double furthest = 0.0;
  for (int n = 0; n < 1000; ++n) {
    net.step();
    furthest = std::max(furthest, std::abs(net.x(ball) - place));
  }
  return {(place - kLoad / law.stiffness) / (inverse_mass * kLoad), furthest};
}

TEST(GuardedTest, PressedContactComesToRest) {
  for (const double kt : {0.1, 0.3, 0.5, 1.0, 3.0, 6.0, 10.0, 30.0, 100.0, 300.0}) {
    for (const double e : {0.37, 0.8}) {
      for (const double speed : {0.0, 0.1, 0.5}) {
        const Rest rest = press(kt, e, speed);
        EXPECT_LT(rest.peak_to_peak, 1e-19) << kt << " " << e << " " << speed;
        EXPECT_LT(std::abs(rest.too_deep), kt > 1.0 ? 2.5 : 1e-12)
            << kt << " " << e << " " << speed;
      }
    }
  }
}

/// Linear wall with a damper: the ball leaves at exp(-pi z/sqrt(1 - z^2)) of its speed, after half
/// a period of the damped oscillator.
Errors dampedImpact(double kt, double ratio, double phase) {
  Law law = powerContact(kt, 1.0);
  law.damping = 2.0 * ratio * std::sqrt(kt);
  constexpr double kSpeed = 1e-3;
  Network net;
  const int ball = net.mass(1.0, -(2.0 + phase) * kSpeed, kSpeed);
  net.guard(law, {{ball, 1.0}});
  net.start();
  int n = 0;
  while (n < 1000 && (net.d(ball) > 0.0 || net.x(ball) > 0.0 || net.states[0].tank > 0.0)) {
    net.step();
    ++n;
  }
  const double root = std::sqrt(1.0 - ratio * ratio);
  const double out = n - net.x(ball) / net.d(ball);
  return {(out - 2.0 - phase) * root * std::sqrt(kt) / kPi - 1.0, 0.0,
          -net.d(ball) / kSpeed / std::exp(-kPi * ratio / root) - 1.0};
}

TEST(GuardedTest, DampedContactReboundsAsInClosedForm) {
  for (int k = 0; k < 64; ++k) {
    const Errors e = dampedImpact(0.005, 0.1, k / 64.0);
    EXPECT_LT(std::abs(e.duration), 1e-3) << k;
    EXPECT_LT(std::abs(e.rebound), 1e-2) << k;
  }
}

/// A stiff wall sees less than two samples of the ball: only the loss is kept, on average.
TEST(GuardedTest, StiffDampedContactLosesSpeedByRestitution) {
  double mean = 0.0;
  const double e = std::exp(-kPi * 0.3 / std::sqrt(1.0 - 0.09));
  for (int k = 0; k < 64; ++k) {
    const double speed = (1.0 + dampedImpact(30.0, 0.3, k / 64.0).rebound) * e;
    EXPECT_GT(speed, e - 1e-12) << k;
    EXPECT_LT(speed, 1.0 + 1e-12) << k;
    mean += speed / 64.0;
  }
  EXPECT_LT(mean, 0.75);
}

TEST(GuardedTest, ObliqueCollisionsKeepEnergyAndMomentum) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  double worst_energy = 0.0;
  double worst_momentum = 0.0;
  for (int k = 0; k < 160; ++k) {
    Network net(3);
    const double kt = 0.05 * std::pow(1000.0, k / 159.0);
    const double ratio = std::pow(4.0, any(random));
    const int a = net.mass(1.0);
    const int b = net.mass(ratio);
    for (int c = 0; c < 3; ++c) {
      net.x(b, c) = c == 0 ? 2.0 : 0.4 * any(random);
      net.d(b, c) = c == 0 ? -0.03 : 0.003 * any(random);
      net.d(a, c) = 0.003 * any(random);
    }
    Law law = powerContact(kt / (1.0 + ratio), 1.0);
    law.length = 1.0;
    net.guard(law, {{a, 1.0}}, {{b, 1.0}});
    net.start();
    const double before = net.energy();
    const double momentum[3] = {net.momentum(0), net.momentum(1), net.momentum(2)};
    for (int n = 0; n < 200; ++n) {
      net.step();
      worst_energy = std::max(worst_energy, std::abs(net.energy() / before - 1.0));
    }
    EXPECT_GT(net.states[0].active, 0.0);
    EXPECT_EQ(net.states[0].tank, 0.0);
    for (int c = 0; c < 3; ++c) {
      worst_momentum = std::max(worst_momentum, std::abs(net.momentum(c) - momentum[c]));
    }
  }
  EXPECT_LT(worst_energy, 1e-12);
  EXPECT_LT(worst_momentum, 2e-15);
}

}  // namespace
}  // namespace ergotic::physics
