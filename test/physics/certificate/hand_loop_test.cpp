// SPDX-License-Identifier: BSD-3-Clause
// What no hand sets off, against the closed form without a mass, against loops with hands of all
// kinds, and against what a scene is said to be.

#include <random>

#include "constants.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

DeviceTraits device(double damping, double delay_ticks, double mass) {
  DeviceTraits traits;
  traits.damping = damping;
  traits.delay_ticks = delay_ticks;
  traits.mass = mass;
  return traits;
}

/// Colgate and Schenkel (1997): the damping from which on any passive hand will do, N s/m.
double neededDamping(double stiffness, double damping, double delay) {
  constexpr int kAngles = 20000;
  double needed = stiffness * kTick * (0.5 + delay);  // at angle 0, where the damper does nothing
  for (int i = 1; i <= kAngles; ++i) {
    const double angle = kPi * i / kAngles;
    const double of_spring = 0.5 * kTick * std::sin((delay + 0.5) * angle) / std::sin(0.5 * angle);
    needed = std::max(needed, stiffness * of_spring - damping * std::cos((delay + 1.0) * angle));
  }
  return needed;
}

/// What moves: the slice, and what it has of the hand.
struct Held {
  double mass = 0.3;
  double damping = 2.0;
  double stiffness = 0.0;
};

Eigen::Matrix3d exponential(const Eigen::Matrix3d& rate) {
  constexpr int kDoublings = 20;
  const Eigen::Matrix3d part = rate / std::pow(2.0, kDoublings);
  Eigen::Matrix3d rest = part + part * part / 2.0 + part * part * part / 6.0;  // of 1 + rest
  for (int i = 0; i < kDoublings; ++i) {
    rest = (2.0 * rest + rest * rest).eval();
  }
  return rest + Eigen::Matrix3d::Identity();
}

/// Largest eigenvalue of one tick of (x, v, last x, forces on their way): moved exactly between
/// ticks, answered `delay` ticks late.
double heldRadiusOf(const Held& held, double stiffness, double damping, int delay) {
  Eigen::Matrix3d rate;
  rate << 0.0, 1.0, 0.0,                                                        //
      -held.stiffness / held.mass, -held.damping / held.mass, 1.0 / held.mass,  //
      0.0, 0.0, 0.0;
  const Eigen::Matrix3d moved = exponential(rate * kTick);
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(3 + delay);
  force[0] = -stiffness - damping / kTick;
  force[2] = damping / kTick;
  Eigen::MatrixXd tick = Eigen::MatrixXd::Zero(3 + delay, 3 + delay);
  tick.topLeftCorner(2, 2) = moved.topLeftCorner(2, 2);
  tick.topRows(2) +=
      moved.topRightCorner(2, 1) *
      (delay == 0 ? force : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(3 + delay, 3)));
  tick(2, 0) = 1.0;
  for (int i = 0; i < delay; ++i) {
    if (i + 1 < delay) {
      tick(3 + i, 4 + i) = 1.0;
    } else {
      tick.row(3 + i) = force;
    }
  }
  return spectralRadius(tick);
}

TEST(HandLoopTest, WithoutAMassIsTheClosedForm) {
  for (const double delay : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    for (const double stiffness : {0.0, 400.0, 3000.0, 30000.0}) {
      for (const double damping : {0.0, 0.5, 4.0, 60.0}) {
        const double needed = std::max(neededDamping(stiffness, damping, delay),
                                       neededDamping(stiffness, 0.0, delay));
        EXPECT_NEAR(HandLoop(device(2.0, delay, 0.0), kTick).share(stiffness, damping),
                    needed / 2.0, 2e-3 * needed)
            << delay << ", " << stiffness << ", " << damping;
      }
    }
  }
}

TEST(HandLoopTest, ASpringAloneIsTheLimitThatItAlwaysWas) {
  const HandLoop loop(device(2.0, 1.0, 0.3), kTick);
  EXPECT_DOUBLE_EQ(loop.stiffnessLimit(), 2.0 * 2.0 / (3.0 * kTick));
  EXPECT_DOUBLE_EQ(loop.share(4200.0, 0.0), 4200.0 / loop.stiffnessLimit());
}

TEST(HandLoopTest, HandsSetNothingOffBelowTheLimit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  const auto scattered = [&](double low, double high) {
    return low * std::pow(high / low, number(random));
  };
  for (int i = 0; i < 3000; ++i) {
    const int delay = static_cast<int>(4.0 * number(random));
    const DeviceTraits slice = device(scattered(0.5, 8.0), delay, scattered(0.05, 1.0));
    const Held held{slice.mass + (i % 3 == 0 ? 0.0 : scattered(1e-3, 1.0)),
                    slice.damping + (i % 2 == 0 ? 0.0 : scattered(1e-2, 20.0)),
                    i % 5 == 0 ? 0.0 : scattered(10.0, kStiffestHand)};
    const double stiffness = i % 4 == 0 ? 0.0 : scattered(10.0, 1e5);
    const double damping = scattered(0.1, 5000.0);
    const double share = HandLoop(slice, kTick).share(stiffness, damping);
    EXPECT_LT(heldRadiusOf(held, stiffness / share * 0.98, damping / share * 0.98, delay),
              1.0 + 1e-9)
        << i << ": " << stiffness << ", " << damping << ", " << share;
  }
}

TEST(HandLoopTest, OfDampersASliceByItselfIsSetOffShortlyAboveTheLimit) {
  for (const int delay : {0, 1, 2, 3}) {
    for (const Held& held : {Held{}, Held{0.4, 7.0, 500.0}}) {
      const HandLoop loop(device(held.damping, delay, held.mass), kTick);
      EXPECT_LT(heldRadiusOf(held, 0.0, loop.dampingLimit(), delay), 1.0 + 1e-9);
      EXPECT_GT(heldRadiusOf(held, 0.0, 1.1 * loop.dampingLimit(), delay), 1.0);
    }
  }
}

Certificate certified(double stiffness, double damping, const DeviceTraits& traits = {}) {
  SceneBuilder b;
  b.spring(b.slice(0), b.ground(0.0, SceneBuilder::kGestural), stiffness, damping);
  return certify(b.scene, kRates, traits);
}

TEST(PortDampingTest, ADamperThatSetsTheSliceOffIsUnproven) {
  for (const double damping : {900.0, 2000.0, 3000.0, 5000.0}) {
    const Certificate refused = certified(0.0, damping);
    EXPECT_EQ(refused.verdict, Verdict::kUnproven) << damping;
    EXPECT_EQ(refused.ports.at(0).level, HandLevel::kRefused);
    EXPECT_DOUBLE_EQ(refused.ports[0].damping, damping);
    EXPECT_THAT(refused.findings,
                ElementsAre(AllOf(
                    HasSubstr("the hand may meet"), HasSubstr(" N s/m, mostly by link 'l0'"),
                    HasSubstr("bears up to 773.4 N s/m"), HasSubstr("it will buzz or jump"))));
  }
}

TEST(PortDampingTest, IsSilentBelowHalfAndWarnsAbove) {
  EXPECT_TRUE(certified(1000.0, 300.0).findings.empty());
  const Certificate warned = certified(1000.0, 500.0);
  EXPECT_EQ(warned.verdict, Verdict::kPassive);
  EXPECT_THAT(warned.findings, ElementsAre(HasSubstr("does not buzz below half of it")));
}

TEST(PortDampingTest, GrowsWithTheMassOfTheSliceAndFallsWithDelay) {
  EXPECT_EQ(certified(0.0, 700.0, device(2.0, 1.0, 0.6)).verdict, Verdict::kPassive);
  EXPECT_EQ(certified(0.0, 700.0, device(2.0, 1.0, 0.1)).verdict, Verdict::kUnproven);
  EXPECT_EQ(certified(0.0, 700.0, device(2.0, 3.0, 0.3)).verdict, Verdict::kUnproven);
}

TEST(PortDampingTest, ScalesOfThePortCount) {
  SceneBuilder b;
  b.spring(b.slice(0), b.ground(0.0, SceneBuilder::kGestural), 0.0, 500.0);
  b.scene.ports[0].force_scale = 4.0;
  EXPECT_EQ(certify(b.scene, kRates).verdict, Verdict::kUnproven);
  EXPECT_DOUBLE_EQ(certify(b.scene, kRates).ports[0].damping, 2000.0);
}

/// As strong a push as a hand gives: how fast the slice is 2 s later, m/s.
double speedAfterAPush(const scene::Scene& scene) {
  const DeviceTraits slice;
  const double decay = std::exp(-slice.damping / slice.mass * kTick);
  const double glide = slice.mass / slice.damping * (1.0 - decay);
  Player player(scene, kRates, Precision::kDouble);
  double x = 0.0;
  double v = 1.0;
  double force = 0.0;
  for (int n = 0; n < 6300 && std::abs(v) < 1e6; ++n) {
    player.positions[0] = x;
    player.tick();
    x += glide * v + (kTick - glide) / slice.damping * force;
    v = decay * v + glide / slice.mass * force;
    force = player.forces[0];
  }
  return std::abs(v);
}

/// A tank holds back what forces move. Between a slice and a ground there is nothing of that.
TEST(DrivenHandTest, NoGuardHoldsALinkThatDrivesAHandOnAGround) {
  const auto joined = [](LiaType type, double nonlinearity, bool is_mass) {
    SceneBuilder b;
    const int slice = b.slice(0);
    b.link(type, slice, is_mass ? b.mass(1.0, 0.0) : b.ground(), 100.0);
    b.scene.lias[0].scheme = Scheme::kEnergyStable;
    b.scene.lias[0].law.edit().nonlinearity = {nonlinearity};
    b.scene.lias[0].law.edit().table.points = {{-0.01, 10.0}, {0.01, -10.0}};
    return b.scene;
  };
  for (const auto& [type, nonlinearity] :
       {std::pair(LiaType::kCubic, -1e6), std::pair(LiaType::kQuadratic, -1e4),
        std::pair(LiaType::kTable, 0.0)}) {
    // A table gives what it held at the start, and no more; nothing bounds the others.
    EXPECT_EQ(speedAfterAPush(joined(type, nonlinearity, false)) > 1.0, type != LiaType::kTable);
    EXPECT_EQ(certify(joined(type, nonlinearity, false), kRates).verdict, Verdict::kUnproven);
    EXPECT_LT(speedAfterAPush(joined(type, nonlinearity, true)), 0.1);
    EXPECT_LE(certify(joined(type, nonlinearity, true), kRates).verdict, Verdict::kBounded);
  }
}

}  // namespace
}  // namespace ergotic::physics
