// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/energy_stable_form.hpp"

#include "support/test.hpp"

namespace ergotic::scene {
namespace {

template <class Real = double>
EnergyStableLaw<Real> lawOf(LiaType type) {
  Lia lia;
  lia.type = type;
  lia.stiffness = {3.0};
  lia.law.edit().nonlinearity = {5.0};
  lia.law.edit().stiffness_limit = {9.0};
  lia.law.edit().tipping_point = std::sqrt((9.0 - 3.0) / 5.0);
  lia.law.edit().exponent = {1.7};
  lia.law.edit().width = {5.0};
  return EnergyStableLaw<Real>::make(Scene{}, lia, Units{});
}

/// A scheme that lets a damper drive would certify what grows.
TEST(EnergyStableFormTest, DampingIsNeverNegative) {
  for (const LiaType type :
       {LiaType::kSpringDamper, LiaType::kQuadratic, LiaType::kCubic, LiaType::kClippedCubic,
        LiaType::kContact, LiaType::kPowerContact, LiaType::kCubicContact, LiaType::kPluck,
        LiaType::kTable, LiaType::kOneWayPluck}) {
    Lia lia;
    lia.type = type;
    lia.damping = {-1.0};
    lia.law.edit().tipping_point = 0.5;
    lia.law.edit().width = {2.0};
    lia.law.edit().table.points = {{-2.0, -2.0}, {2.0, 2.0}};
    const auto law = EnergyStableLaw<double>::make(Scene{}, lia, Units{});
    for (const double p : {0.1, 0.9}) {
      EXPECT_EQ(law.dampingAt(p, 0.1), 0.0) << static_cast<int>(type) << " " << p;
    }
  }
}

/// By the midpoint rule.
double meanOf(const EnergyStableLaw<double>& law, double p, double w) {
  constexpr int kParts = 20000;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double t = (2.0 * i + 1.0) / kParts - 1.0;
    sum += p + w * t > 0.0 ? (1.0 - std::abs(t)) * law.push(p + w * t).force : 0.0;
  }
  return sum * 2.0 / kParts;
}

TEST(EnergyStableFormTest, SlopePotentialAndMeanAreThoseOfThePush) {
  constexpr double kStep = 1e-5;
  for (const LiaType type : {LiaType::kSpringDamper, LiaType::kQuadratic, LiaType::kCubic,
                             LiaType::kClippedCubic, LiaType::kContact, LiaType::kPowerContact,
                             LiaType::kCubicContact, LiaType::kFelt, LiaType::kPluck}) {
    const EnergyStableLaw<double> law = lawOf(type);
    const std::string what = std::to_string(static_cast<int>(type));
    for (const double p : {0.2, 0.7, 1.6}) {
      const double force = law.push(p).force;
      const double rise = law.push(p + kStep).force - law.push(p - kStep).force;
      EXPECT_NEAR(law.push(p).slope, rise / (2.0 * kStep), 1e-7 * std::abs(force))
          << what << " " << p;
      EXPECT_NEAR((law.potential(p + kStep) - law.potential(p - kStep)) / (2.0 * kStep), force,
                  1e-7 * std::abs(force))
          << what << " " << p;
      for (const double w : {0.03, -0.5, 2.0}) {
        if (law.isContact()) {
          EXPECT_NEAR(law.meanPush(p, w), meanOf(law, p, w), 1e-5 * std::abs(force))
              << what << " " << p;
        }
      }
    }
  }
}

/// Down to its bottom at 0 a table of straight lines gives what lies below them.
TEST(EnergyStableFormTest, PotentialOfATableIsWhatLiesBelowIt) {
  Lia lia;
  lia.type = LiaType::kTable;
  lia.law.edit().table.points = {{-1.0, -4.0}, {0.0, 0.0}, {1.0, 1.0}, {3.0, 2.0}};
  const auto law = EnergyStableLaw<double>::make(Scene{}, lia, Units{});
  EXPECT_NEAR(law.potential(-1.0), 2.0, 1e-12);
  EXPECT_NEAR(law.potential(0.0), 0.0, 1e-12);
  EXPECT_NEAR(law.potential(0.5), 0.125, 1e-12);
  EXPECT_NEAR(law.potential(3.0), 0.5 + 3.0, 1e-12);
  EXPECT_NEAR(law.potential(4.0), 0.5 + 3.0 + 2.0, 1e-12) << "held beyond its end";
}

/// Beside a line that rises, what pushes out of a table ends beyond it, on either side.
TEST(EnergyStableFormTest, BottomMayLieBeyondEitherEndOfATable) {
  for (const double push : {-1.0, 1.0}) {
    const Curve curve = interpolate({{{-1.0, push}, {1.0, push}}, false});
    const EnergyStableCurve<double> well(curve, 0.0, 0.1);
    const double bottom = -10.0 * push;
    EXPECT_NEAR(well.at(bottom).force, 0.0, 1e-12);
    EXPECT_NEAR(well.potential(bottom), 0.0, 1e-12);
    EXPECT_NEAR(well.potential(bottom + 2.0), 0.5 * 0.1 * 4.0, 1e-12);
  }
}

template <class Real>
void expectTheLawWhereNothingMoves() {
  for (const LiaType type :
       {LiaType::kContact, LiaType::kPowerContact, LiaType::kCubicContact, LiaType::kFelt}) {
    const EnergyStableLaw<Real> law = lawOf<Real>(type);
    const double least = std::log10(std::numeric_limits<Real>::denorm_min());
    for (double i = least; i < -1.0; i += 1.3) {
      const Real p = static_cast<Real>(std::pow(10.0, i));
      EXPECT_EQ(law.meanPush(p, Real(0)), law.push(p).force) << p;
      EXPECT_TRUE(std::isfinite(law.push(p).slope)) << p;
      for (double k = least; k < -1.0; k += 1.3) {
        const Real w = static_cast<Real>(std::pow(10.0, k));
        const Real mean = law.meanPush(p, w);
        // It lies between what the law gives at both ends of the steps; sums of cubes are rounded.
        const Real most = law.push(p + w).force;
        EXPECT_GE(mean, -Real(1e-5) * most) << p << " " << w;
        EXPECT_LE(mean, Real(1.00001) * most) << p << " " << w;
      }
    }
    EXPECT_EQ(law.meanPush(Real(0), Real(0)), Real(0));
  }
}

TEST(EnergyStableFormTest, MeanIsTheLawWhereNothingMoves) {
  expectTheLawWhereNothingMoves<float>();
  expectTheLawWhereNothingMoves<double>();
}

TEST(EnergyStableFormTest, HugeOverlapsAreFinite) {
  for (const double p : {1e100, 1e150, 1e300}) {
    for (const double w : {0.0, 1e100, 1e300}) {
      EXPECT_TRUE(std::isfinite(lawOf(LiaType::kContact).meanPush(p, w))) << p << " " << w;
    }
  }
}

}  // namespace
}  // namespace ergotic::scene
