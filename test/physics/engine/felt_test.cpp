// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/felt.hpp"

#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

Lia& felt(SceneBuilder& b, int from, int to, double k, double exponent, double c, Scheme scheme) {
  Lia& lia = b.scene.lias[at(b.link(LiaType::kFelt, from, to, k, c))];
  lia.law.edit().exponent = {exponent};
  lia.scheme = scheme;
  return lia;
}

/// A ball that hits a wall of felt. Without losses it would stay for `duration`.
struct FeltImpact {
  double exponent;
  double loss;  ///< c times the speed of the impact
  double duration;
  double mass = 5e-3;
  double speed = 0.8;

  double stiffness() const {
    const double a = exponent + 1.0;
    const double i = std::sqrt(kPi) * std::tgamma(1.0 + 1.0 / a) / std::tgamma(0.5 + 1.0 / a);
    const double deepest = duration * speed / (2.0 * i);
    return 0.5 * a * mass * speed * speed / std::pow(deepest, a);
  }
  double damping() const { return loss / speed; }
};

struct Rebound {
  double time = 0.0;  ///< in touch
  double speed = 0.0;
};

/// Runge-Kutta of fourth order in steps of 1e-5 of the contact.
Rebound integrate(const FeltImpact& impact) {
  const double k = impact.stiffness() / impact.mass;
  const auto acceleration = [&](double p, double v) {
    return p > 0.0 ? -k * std::pow(p, impact.exponent) * std::max(0.0, 1.0 + impact.damping() * v)
                   : 0.0;
  };
  const double h = 1e-5 * impact.duration;
  double p = 0.0;
  double v = impact.speed;
  for (double t = 0.0;; t += h) {
    const double a1 = acceleration(p, v);
    const double v2 = v + 0.5 * h * a1;
    const double a2 = acceleration(p + 0.5 * h * v, v2);
    const double v3 = v + 0.5 * h * a2;
    const double a3 = acceleration(p + 0.5 * h * v2, v3);
    const double v4 = v + h * a3;
    const double a4 = acceleration(p + h * v3, v4);
    const double next = p + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (next <= 0.0 && v < 0.0) {
      return {t + h * p / (p - next), -v};
    }
    p = next;
  }
}

/// In touch: between the straight lines before and after.
Rebound bounce(const FeltImpact& impact, double phase, Scheme scheme) {
  const double d = impact.speed / kRate;
  const double start = -(5.0 + phase) * d;
  SceneBuilder b;
  const int ball = b.mass(impact.mass, start - d, impact.speed);  // its first step is free
  felt(b, ball, b.ground(), impact.stiffness(), impact.exponent, impact.damping(), scheme);
  b.hear(ball, 0);
  b.hear(ball, 1, Quantity::kVelocity);
  Player player(b.scene, {kRate, 1});
  player.ticks(20 + static_cast<int>(2.0 * impact.duration * kRate));
  const double speed = -player.heard[1].back();
  const double out =
      static_cast<double>(player.heard[0].size() - 1) + player.heard[0].back() * kRate / speed;
  return {(out + start / d) / kRate, speed};
}

/// From 1 ms on, and the longer the more of it is lost, an energy-stable impact is that of the law.
TEST(FeltTest, EnergyStableImpactsLastAndReboundAsTheyShould) {
  for (const double exponent : {1.0, 1.5, 2.3, 3.0}) {
    for (const auto& [loss, duration] :
         {std::pair(0.0, 1e-3), {0.1, 1e-3}, {0.3, 1e-3}, {0.8, 2e-3}, {3.0, 5e-3}}) {
      const FeltImpact impact{exponent, loss, duration};
      const Rebound law = integrate(impact);
      EXPECT_NEAR(law.speed, impact.speed * scene::feltRestitution(loss), 1e-8);
      for (int k = 0; k < 8; ++k) {
        const Rebound played = bounce(impact, k / 8.0, Scheme::kEnergyStable);
        EXPECT_NEAR(played.time, law.time, 1e-5 * law.time) << exponent << " " << loss;
        EXPECT_NEAR(played.speed, law.speed, 1e-5 * law.speed) << exponent << " " << loss;
      }
    }
  }
}

TEST(FeltTest, ExplicitImpactsAreNearTheLaw) {
  const FeltImpact impact{2.3, 0.3, 5e-3};
  const Rebound law = integrate(impact);
  const Rebound played = bounce(impact, 0.3, Scheme::kExplicit);
  EXPECT_NEAR(played.time, law.time, 1e-3 * law.time);
  EXPECT_NEAR(played.speed, law.speed, 3e-3 * law.speed);
}

/// Impacts that are over within two steps lose what the law says of their speed.
TEST(FeltTest, ShortEnergyStableImpactsReboundByTheirRestitution) {
  for (const double loss : {0.1, 1.0, 5.0}) {
    for (int k = 0; k < 8; ++k) {
      const FeltImpact impact{1.5, loss, 5e-6};
      const double ratio = bounce(impact, k / 8.0, Scheme::kEnergyStable).speed / impact.speed;
      EXPECT_GE(ratio, scene::feltRestitution(loss) - 0.01) << loss << " " << k;
      EXPECT_LE(ratio, 1.0 + 1e-12) << loss << " " << k;
    }
  }
}

TEST(FeltTest, RestitutionSolvesItsEquation) {
  EXPECT_EQ(scene::feltRestitution(0.0), 1.0);
  EXPECT_NEAR(scene::feltRestitution(1e-4), 1.0 - 2e-4 / 3.0, 1e-8);
  for (const double u : {1e-3, 0.1, 1.0, 10.0, 700.0}) {
    const double x = u * scene::feltRestitution(u);
    ASSERT_LE(x, 1.0) << u;
    if (u < 20.0) {
      EXPECT_NEAR(-x - std::log1p(-x), u - std::log1p(u), 1e-9 * u) << u;
    }
  }
}

/// Ends of an explicit felt move towards each other at v, or apart.
TEST(FeltTest, ExplicitForceIsThatOfTheLawAndNeverPulls) {
  const auto force = [](double e, double v) {
    SceneBuilder b;
    const int driven = b.driven(0);
    const int ground = b.ground();
    Lia& lia = felt(b, driven, ground, 1e4, 1.5, 2.0, Scheme::kExplicit);
    lia.law.edit().width = {0.01};
    b.hear(ground, 0, Quantity::kForce);
    Player player(b.scene, {kRate, 2});
    player.inputs = {e - v / kRate, e};
    player.tick();
    return player.heard[0][1];
  };
  EXPECT_NEAR(force(0.03, 0.2), 1e4 * std::pow(0.04, 1.5) * 1.4, 1e-9);
  EXPECT_NEAR(force(0.03, -0.2), 1e4 * std::pow(0.04, 1.5) * 0.6, 1e-9);
  EXPECT_EQ(force(0.03, -0.6), 0.0);
  EXPECT_EQ(force(-0.011, 0.2), 0.0);
}

/// Four balls that move at random, with felt between any two, of numbers from soft to absurd.
struct Hostile : SceneBuilder {
  Hostile(Geometry geometry, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
    scene.sections[0].geometry = geometry;
    for (int m = 0; m < kBalls; ++m) {
      scene::Mat& mat = scene.mats[at(mass(std::pow(10.0, between(-2.0, 2.0))))];
      for (int k = 0; k < dimensionsOf(geometry); ++k) {
        mat.position[k] = between(-1.0, 1.0);
        mat.push.edit().velocity[k] = kRate * between(-0.3, 0.3);
      }
      hearAxes(m, 3 * m, Quantity::kVelocity);
    }
    for (int a = 0; a < kBalls; ++a) {
      for (int b = a + 1; b < kBalls; ++b) {
        const double k = std::pow(10.0, between(-4.0, 8.0)) * kRate * kRate;
        Lia& lia = felt(*this, a, b, k, between(1.0, 5.0),
                        std::pow(10.0, between(-3.0, 6.0)) / kRate, Scheme::kEnergyStable);
        lia.law.edit().width = {between(0.0, 1.0)};
      }
    }
  }
  static constexpr int kBalls = 4;
};

TEST(FeltTest, EnergyStableItNeverPullsNorMakesEnergyNorMomentum) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const Geometry geometry =
        std::array{Geometry::kScalar, Geometry::kPlane, Geometry::kSpace}[at(trial % 3)];
    const Hostile b(geometry, random);
    Player player(b.scene, {kRate, 1});
    player.tick();
    double energy = std::numeric_limits<double>::infinity();
    for (int n = 1; n < 500; ++n) {
      const std::vector<EnergyStableState<double>> tanks = test::tankStatesOf(player);
      for (const EnergyStableState<double>& tank : tanks) {
        ASSERT_GE(tank.force + tank.damper, 0.0) << trial << " " << n;
        ASSERT_GE(tank.tank, 0.0) << trial << " " << n;
      }
      player.tick();
      const double now = test::energyBetweenSteps(player, tanks);
      ASSERT_LE(now, energy * (1.0 + 1e-12)) << trial << " " << n;
      energy = now;
    }
    EXPECT_LT((test::momentumOf(player, 499) - test::momentumOf(player, 0)).norm(), 1e-9 * kRate)
        << trial;
  }
}

/// Two balls, the second in a section of its own geometry.
double momentumKept(Geometry first, Geometry second, Scheme scheme) {
  SceneBuilder b;
  b.scene.sections[0].geometry = first;
  scene::Section other = b.scene.sections[0];
  other.name = "other";
  other.geometry = second;
  b.scene.sections.push_back(other);
  const int balls[] = {b.mass(1e-3, 0.0, 1.0), b.mass(3e-3, 2e-2, -0.5, 2)};
  b.scene.mats[1].position.y() = second == Geometry::kScalar ? 0.0 : 2e-3;
  const bool is_scalar = first == Geometry::kScalar || second == Geometry::kScalar;
  Lia& lia = felt(b, balls[0], balls[1], 1e5, 1.5, 0.7, scheme);
  lia.law.edit().width = {is_scalar ? -0.5e-2 : 1.5e-2};  // how near is a matter of the side
  b.hearAxes(balls[0], 0, Quantity::kVelocity);
  b.hearAxes(balls[1], 3, Quantity::kVelocity);
  Player player(b.scene, {kRate, 1});
  player.ticks(2000);
  const std::size_t last = player.heard[0].size() - 1;
  EXPECT_GT(std::abs(player.heard[0][last] - player.heard[0][0]), 0.1) << "they met";
  return (test::momentumOf(player, last) - test::momentumOf(player, 0)).norm();
}

TEST(FeltTest, MomentumIsKeptInEveryGeometryAndBetweenThem) {
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    for (const auto& [first, second] : {std::pair(Geometry::kScalar, Geometry::kScalar),
                                        {Geometry::kLine, Geometry::kLine},
                                        {Geometry::kPlane, Geometry::kPlane},
                                        {Geometry::kSpace, Geometry::kSpace},
                                        {Geometry::kPlane, Geometry::kSpace},
                                        {Geometry::kLine, Geometry::kPlane}}) {
      EXPECT_LT(momentumKept(first, second, scheme), 1e-15)
          << static_cast<int>(first) << " " << static_cast<int>(second);
    }
  }
}

/// A ball that bounces while all that the felt is turns: the energy accounts know whose work that
/// was.
TEST(FeltTest, ItsNumbersMayMoveWhileItPlays) {
  SceneBuilder b;
  for (const char* name : {"k", "a", "c"}) {
    b.scene.parameters.push_back({name, 1.0, 0.0, 4.0, {}});
  }
  b.scene.sections[0].gravity.x() = 50.0;
  const int ball = b.mass(1e-2, -1e-3, 0.5);
  Lia& lia = felt(b, ball, b.ground(), 0.0, 1.0, 0.0, Scheme::kEnergyStable);
  lia.stiffness = {1e6, 0};
  lia.law.edit().exponent = {1.0, 1};
  lia.damping = {1.0, 2};
  b.hear(ball, 0, Quantity::kVelocity);
  Player player(b.scene, {kRate, 1});
  Energies e = player.instrument->makeEnergies();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  for (int n = 0; n < 3000; ++n) {
    if (n % 10 == 0) {
      player.instrument->exchange(player.instrument->prepare(
          {4.0 * anywhere(random), 1.0 + 3.0 * anywhere(random), 4.0 * anywhere(random)}));
    }
    player.tick();
    player.instrument->readEnergies(e);
    ASSERT_LT(std::abs(e.residual), 1e-10) << n;
  }
  EXPECT_TRUE(std::isfinite(player.heard[0].back()));
}

/// Between a mass of 1 kg and the ground, with numbers that are parameters.
struct Certified {
  double stiffest;
  double steepest;
  double lossiest;
  Verdict verdict(Scheme scheme) const {
    SceneBuilder b;
    b.scene.parameters = {{"k", 0.0, 0.0, stiffest, {}},
                          {"a", 1.0, 1.0, steepest, {}},
                          {"c", 0.0, 0.0, lossiest, {}}};
    Lia& lia = felt(b, b.mass(1.0), b.ground(), 0.0, 1.0, 0.0, scheme);
    lia.stiffness = {1.0, 0};
    lia.law.edit().exponent = {1.0, 1};
    lia.damping = {1.0, 2};
    return certify(b.scene, {kRate, 14}).verdict;
  }
};

TEST(FeltTest, CertificateLooksAtBothEndsOfItsRanges) {
  const double soft = 0.049 * kRate * kRate;
  // Explicit, its step may give a little at a hit, and it has no damping to lose that.
  EXPECT_EQ((Certified{soft, 1.0, 0.0}.verdict(Scheme::kExplicit)), Verdict::kUnproven);
  EXPECT_EQ((Certified{soft, 1.01, 0.0}.verdict(Scheme::kExplicit)), Verdict::kUnproven);
  EXPECT_EQ((Certified{soft, 1.0, 0.01}.verdict(Scheme::kExplicit)), Verdict::kUnproven);
  EXPECT_EQ((Certified{5.0 * kRate * kRate, 1.0, 0.0}.verdict(Scheme::kExplicit)),
            Verdict::kUnproven);
  EXPECT_EQ((Certified{5.0 * kRate * kRate, 5.0, 1e6}.verdict(Scheme::kEnergyStable)),
            Verdict::kPassive);
}

/// At those ends an energy-stable ball under gravity comes to rest, and the verdict holds.
TEST(FeltTest, WhatIsCertifiedHoldsAtBothEnds) {
  for (const double k : {1e3, 5.0 * kRate * kRate}) {
    for (const double exponent : {1.0, 5.0}) {
      for (const double c : {0.0, 1e3}) {
        SceneBuilder b;
        const int ball = b.mass(1.0, -1e-3, 1.0);
        felt(b, ball, b.ground(), k, exponent, c, Scheme::kEnergyStable);
        Player player(b.scene, {kRate, 1});
        Energies e = player.instrument->makeEnergies();
        double most = 0.5;
        for (int n = 0; n < 5000; ++n) {
          player.tick();
          player.instrument->readEnergies(e);
          ASSERT_LE(e.sections[0].kinetic, most * (1.0 + 1e-9)) << k << " " << exponent << " " << c;
        }
      }
    }
  }
}

TEST(FeltTest, IsEnergyStableWhateverItLoses) {
  const auto scheme = [](double exponent, double c) {
    SceneBuilder b;
    felt(b, b.mass(1.0), b.ground(), 1e3, exponent, c, Scheme::kAuto);
    return settle(b.scene, {kRate, 14}).scene.lias[0].scheme;
  };
  EXPECT_EQ(scheme(1.0, 0.0), Scheme::kEnergyStable);
  EXPECT_EQ(scheme(1.5, 0.0), Scheme::kEnergyStable);
  EXPECT_EQ(scheme(1.0, 0.1), Scheme::kEnergyStable);
}

}  // namespace
}  // namespace ergotic::physics
