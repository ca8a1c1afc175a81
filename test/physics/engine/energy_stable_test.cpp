// SPDX-License-Identifier: BSD-3-Clause
// Energy-stable contacts and springs as they are heard, against closed forms and the explicit ones.
#include <random>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

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
  double peakForce() const { return stiffness * std::pow(deepest, exponent); }
};

/// A ball that flies at a wall at x = 0, until it has left it again.
struct Flight {
  Flight(SceneBuilder b, int ball, double rate) {
    b.hear(ball, 0);
    b.hear(ball, 1, Quantity::kForce);
    b.hear(ball, 2, Quantity::kVelocity);
    Player player(b.scene, {rate, 1});
    do {
      player.tick();
      velocity = player.heard[2].back() / rate;
    } while (velocity > 0.0 || player.heard[0].back() > -2.0 * std::abs(velocity));
    depth = player.heard[0];
    force = player.heard[1];
  }
  /// Where the straight line after the contact crosses the wall, frames.
  double out() const { return static_cast<double>(depth.size()) - 1.0 - depth.back() / velocity; }

  std::vector<double> depth;
  std::vector<double> force;
  double velocity = 0.0;  ///< m per frame, in the end
};

/// Relative errors of one impact. Duration: from where the straight line before crosses the wall to
/// where the straight line after does. Peak: the largest force that acted in a step.
struct Errors {
  double duration = 0.0;
  double peak = 0.0;
  double rebound = 0.0;
};

Errors errorsOf(const Impact& impact, Scheme scheme, double phase) {
  const double step = impact.speed / impact.rate;
  const double start = -(5.0 + phase) * step;
  SceneBuilder b;
  const int ball = b.mass(impact.mass, start - step, impact.speed);  // its first step is free
  b.link(LiaType::kPowerContact, ball, b.ground(), impact.stiffness);
  b.scene.lias[0].law.edit().exponent = {impact.exponent};
  b.scene.lias[0].scheme = scheme;
  const Flight flight(b, ball, impact.rate);
  // The wall pushes the ball back: below 0.
  const double strongest = -*std::min_element(flight.force.begin(), flight.force.end());
  return {(flight.out() + start / step) / (impact.rate * impact.duration) - 1.0,
          strongest / impact.peakForce() - 1.0, -flight.velocity / step - 1.0};
}

/// Root mean squares over 64 phases of the impact between two samples.
Errors rmsOf(const Impact& impact, Scheme scheme) {
  Errors sum;
  constexpr int kPhases = 64;
  for (int k = 0; k < kPhases; ++k) {
    const Errors e = errorsOf(impact, scheme, k / double{kPhases});
    sum.duration += e.duration * e.duration / kPhases;
    sum.peak += e.peak * e.peak / kPhases;
    sum.rebound += e.rebound * e.rebound / kPhases;
  }
  return {std::sqrt(sum.duration), std::sqrt(sum.peak), std::sqrt(sum.rebound)};
}

/// The force at first touch jumps in its slope between two samples: only the mean of the law over
/// the step knows when.
TEST(EnergyStableTest, ContactLastsAndReboundsAsInClosedForm) {
  for (const double a : {1.0, 1.5, 2.3, 3.0}) {
    const Errors energy_stable = rmsOf(Impact(a, kRate), Scheme::kEnergyStable);
    EXPECT_LT(energy_stable.duration, 2e-5) << a;
    EXPECT_LT(energy_stable.rebound, 1e-12) << a;
    const Errors plain = rmsOf(Impact(a, kRate), Scheme::kExplicit);
    EXPECT_LT(plain.duration, 5e-4) << a;
    EXPECT_LT(plain.rebound, 5e-4) << a;
    EXPECT_GT(plain.duration, 20.0 * energy_stable.duration) << a;
  }
}

/// Samples miss the peak, and the mean of the law over two steps is below it.
TEST(EnergyStableTest, LargestForceThatActsIsThatOfTheDocumentation) {
  constexpr struct {
    double exponent;
    double plain;
    double energy_stable;
  } kRows[] = {
      {1.0, 3.7e-4, 6.6e-4}, {1.5, 3.4e-4, 1.1e-3}, {2.3, 5.5e-4, 1.9e-3}, {3.0, 7.9e-4, 2.8e-3}};
  for (const auto& row : kRows) {
    const Impact impact(row.exponent, kRate);
    EXPECT_NEAR(rmsOf(impact, Scheme::kExplicit).peak / row.plain, 1.0, 0.03) << row.exponent;
    EXPECT_NEAR(rmsOf(impact, Scheme::kEnergyStable).peak / row.energy_stable, 1.0, 0.03)
        << row.exponent;
  }
}

TEST(EnergyStableTest, ContactOfFiveSamplesStillReboundsExactly) {
  for (const double a : {1.0, 1.5, 2.3, 3.0}) {
    const Errors energy_stable = rmsOf(Impact(a, 5512.5), Scheme::kEnergyStable);
    EXPECT_LT(energy_stable.duration, 4e-3) << a;
    EXPECT_LT(energy_stable.rebound, 1e-12) << a;
    EXPECT_GT(rmsOf(Impact(a, 5512.5), Scheme::kExplicit).duration, 1e-2) << a;
  }
}

/// An energy-stable wall with h^2 K/M = kt and a damping ratio.
SceneBuilder dampedWall(double kt, double ratio, double x, double speed, double mass = 1.0) {
  SceneBuilder b;
  const int ball = b.mass(mass, x, speed * kRate);
  b.link(LiaType::kPowerContact, ball, b.ground(), kt * kRate * kRate * mass,
         2.0 * ratio * std::sqrt(kt) * kRate * mass);
  b.scene.lias[0].law.edit().exponent = {1.0};
  b.scene.lias[0].scheme = Scheme::kEnergyStable;
  return b;
}

/// Linear wall with a damper: the ball leaves at exp(-pi z/sqrt(1 - z^2)) of its speed, after half
/// a period of the damped oscillator.
Errors dampedImpact(double kt, double ratio, double phase) {
  constexpr double kSpeed = 1e-3;
  const Flight flight(dampedWall(kt, ratio, -(3.0 + phase) * kSpeed, kSpeed), 0, kRate);
  const double root = std::sqrt(1.0 - ratio * ratio);
  return {(flight.out() - 2.0 - phase) * root * std::sqrt(kt) / kPi - 1.0, 0.0,
          -flight.velocity / kSpeed / std::exp(-kPi * ratio / root) - 1.0};
}

TEST(EnergyStableTest, DampedContactReboundsAsInClosedForm) {
  for (int k = 0; k < 64; ++k) {
    const Errors e = dampedImpact(0.005, 0.1, k / 64.0);
    EXPECT_LT(std::abs(e.duration), 1e-3) << k;
    EXPECT_LT(std::abs(e.rebound), 1e-2) << k;
  }
}

/// A stiff wall sees less than two samples of the ball: only the loss is kept, on average.
TEST(EnergyStableTest, StiffDampedContactLosesSpeedByRestitution) {
  double mean = 0.0;
  const double e = std::exp(-kPi * 0.3 / std::sqrt(1.0 - 0.09));
  for (int k = 0; k < 64; ++k) {
    const double speed = (1.0 + dampedImpact(30.0, 0.3, k / 64.0).rebound) * e;
    EXPECT_GT(speed, e - 1e-12) << k;
    EXPECT_LT(speed, 1.0 + 1e-12) << k;
    mean += speed / 64.0;
  }
  EXPECT_LT(mean, 1.2 * e);
}

/// 2 N press a ball of 5 g onto a damped wall.
TEST(EnergyStableTest, PressedContactComesToRest) {
  constexpr double kForce = 2.0;
  constexpr double kMass = 5e-3;
  constexpr double kPressedStep = kForce / kMass / (kRate * kRate);
  for (const double kt : {0.1, 0.3, 0.5, 1.0, 3.0, 6.0, 10.0, 30.0, 100.0, 300.0}) {
    for (const double restitution : {0.37, 0.8}) {
      const double log_e = std::log(restitution);
      const double ratio = -log_e / std::sqrt(kPi * kPi + log_e * log_e);
      for (const double speed : {0.0, 0.1, 0.5}) {
        SceneBuilder b = dampedWall(kt, ratio, -1e-4, speed / kRate, kMass);
        b.scene.mats[0].push.edit().force.x() = kForce;
        b.hear(0);
        Player player(b.scene, {kRate, 1});
        player.ticks(21000);
        const std::vector<double>& x = player.heard[0];
        const auto [low, high] = std::minmax_element(x.end() - 1000, x.end());
        EXPECT_LT(*high - *low, 1e-19) << kt << " " << restitution << " " << speed;
        // In units of what the wall yields in one step.
        EXPECT_LT(std::abs(x.back() - kPressedStep / kt) / kPressedStep, kt > 1.0 ? 2.5 : 1e-12)
            << kt << " " << restitution << " " << speed;
      }
    }
  }
}

/// A damped mass that comes to rest just where it touches: its steps shrink until they vanish.
TEST(EnergyStableTest, ContactThatComesToRestTouchingStaysFinite) {
  for (const LiaType type : {LiaType::kContact, LiaType::kPowerContact, LiaType::kFelt}) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      SceneBuilder b;
      const int mass = b.mass(0.01, 0.001);
      b.spring(mass, b.ground(), 400.0, 1.6);
      scene::Lia& lia = b.scene.lias[at(b.link(type, b.ground(), mass, 20000.0))];
      lia.law.edit().exponent = {type == LiaType::kContact ? 1.0 : 1.5};
      lia.damping = {type == LiaType::kFelt ? 0.1 : 0.0};
      lia.scheme = Scheme::kEnergyStable;
      b.hear(mass);
      Player player(compile(b.scene, {kRate, 14}, precision));
      player.ticks(static_cast<int>(12.0 * kRate / 14));
      EXPECT_LT(std::abs(player.heard[0].back()), 1e-30);  // false of NaN
    }
  }
}

/// A spring pulls a ball off a wall, often harder than the wall pushes where it is about to let go.
TEST(EnergyStableTest, ContactsNeverPull) {
  for (const LiaType type : {LiaType::kContact, LiaType::kPowerContact, LiaType::kCubicContact}) {
    for (const double kappa : {0.1, 1.0, 10.0, 100.0}) {
      SceneBuilder b;
      const int ball = b.mass(1.0, 1.0);
      b.spring(ball, b.ground(), 0.9 * kRate * kRate);
      const int wall = b.ground();
      scene::Lia& lia = b.scene.lias[at(b.link(type, ball, wall, kappa * kRate * kRate))];
      lia.law.edit().width = {-0.5};
      lia.law.edit().exponent = {1.5};
      lia.law.edit().nonlinearity = lia.stiffness;
      lia.law.edit().stiffness_limit = 2.0 * lia.stiffness;
      lia.law.edit().tipping_point = 1.0;
      lia.scheme = Scheme::kEnergyStable;
      b.hear(wall, 0, Quantity::kForce);
      Player player(b.scene, {kRate, 1});
      player.ticks(2000);
      const auto [low, high] = std::minmax_element(player.heard[0].begin(), player.heard[0].end());
      EXPECT_EQ(*low, 0.0) << static_cast<int>(type) << " " << kappa;
      EXPECT_GT(*high, 0.01 * kRate * kRate) << static_cast<int>(type) << " " << kappa;
    }
  }
}

/// Torn off in the very step in which an impact would throw it back.
TEST(EnergyStableTest, ImpactsThatArePulledApartDoNotHoldOn) {
  constexpr double kSpeed = 1e-3;
  for (const double kt : {3.0, 30.0, 300.0}) {
    for (const double pull : {0.0, 1.5, 2.0, 4.0}) {  // of the speed, per step
      SceneBuilder b = dampedWall(kt, 0.3, -1.5 * kSpeed, kSpeed);
      b.push(0);
      b.hear(1, 0, Quantity::kForce);
      Player player(b.scene, {kRate, 1});
      player.tick();
      player.inputs[0] = -pull * kSpeed * kRate * kRate;
      player.tick();
      const double most = *std::max_element(player.heard[0].begin(), player.heard[0].end());
      const double least = *std::min_element(player.heard[0].begin(), player.heard[0].end());
      EXPECT_GE(least, 0.0) << kt << " " << pull;
      EXPECT_EQ(most > 0.0, pull == 0.0) << kt << " " << pull;
    }
  }
}

TEST(EnergyStableTest, ObliqueCollisionsKeepEnergyAndMomentum) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 160; ++k) {
    const double kt = 0.05 * std::pow(1000.0, k / 159.0);
    const double kg[2] = {1.0, std::pow(4.0, any(random))};
    SceneBuilder b;
    b.scene.sections[0].geometry = Geometry::kSpace;
    for (int ball = 0; ball < 2; ++ball) {
      scene::Mat& mat = b.scene.mats[at(b.mass(kg[ball]))];
      mat.position = {2.0 * ball, 0.4 * any(random) * ball, 0.4 * any(random) * ball};
      mat.push.edit().velocity = Eigen::Vector3d(-0.03 * ball, 0.003 * any(random), 0.003) * kRate;
      b.hearAxes(ball, 3 * ball, Quantity::kVelocity);
    }
    b.link(LiaType::kContact, 0, 1, kt / (1.0 / kg[0] + 1.0 / kg[1]) * kRate * kRate);
    b.scene.lias[0].law.edit().width = {1.0};
    b.scene.lias[0].scheme = Scheme::kEnergyStable;
    Player player(b.scene, {kRate, 1});
    player.tick();
    const double before = energiesOf(player).sections[0].kinetic;
    player.ticks(199);
    EXPECT_NEAR(energiesOf(player).sections[0].kinetic / before, 1.0, 1e-12) << k;
    EXPECT_LT((test::momentumOf(player, 199) - test::momentumOf(player, 0)).cwiseAbs().maxCoeff(),
              2e-15 * kRate)
        << k;
    EXPECT_GT(std::abs(player.heard[3][199] - player.heard[3][0]), 1.0) << "they did not meet";
  }
}

}  // namespace
}  // namespace ergotic::physics
