// SPDX-License-Identifier: BSD-3-Clause
// Verdicts on links that are more than springs and dampers.

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// Hold and mean make no energy on the average only: what is not linear may keep what they lend.
TEST(CertifyLinksTest, NothingNonlinearIsProvenBesideACoupledSlowMass) {
  const auto verdict = [](LiaType type, scene::Scheme scheme, bool by_hand) {
    SceneBuilder b;
    const int string = b.chain(10, 1e-3, 1e4, 0.1);
    const int slow = by_hand ? b.slice(0) : b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
    b.spring(slow, string + 4, 100.0);
    scene::Lia& lia = b.scene.lias[at(b.link(type, string + 6, b.ground(), 10.0, 1e-3))];
    lia.scheme = scheme;
    lia.law.edit().width = {type == LiaType::kContact ? 0.0 : 1.0};
    return certify(b.scene, {kRate, 14}).verdict;
  };
  for (const auto scheme : {scene::Scheme::kExplicit, scene::Scheme::kEnergyStable}) {
    EXPECT_EQ(verdict(LiaType::kContact, scheme, false), Verdict::kUnproven);
    EXPECT_EQ(verdict(LiaType::kContact, scheme, true),
              scheme == scene::Scheme::kEnergyStable ? Verdict::kPassive : Verdict::kUnproven);
    EXPECT_EQ(verdict(LiaType::kBow, scheme, false), Verdict::kUnproven);
    EXPECT_EQ(verdict(LiaType::kBow, scheme, true), Verdict::kBounded);
  }
  EXPECT_EQ(verdict(LiaType::kConditional, scene::Scheme::kExplicit, false), Verdict::kUnproven);
  EXPECT_EQ(verdict(LiaType::kSpringDamper, scene::Scheme::kExplicit, false), Verdict::kPassive);
}

TEST(CertifyLinksTest, LinesThatTurnAreProvenOnlyWithoutRestLengthOrEnergyStable) {
  const auto verdict = [](double rest_length, scene::Scheme scheme) {
    SceneBuilder b;
    b.scene.sections[0].geometry = scene::Geometry::kPlane;
    scene::Lia& lia = b.scene.lias[at(b.spring(b.mass(1.0), b.ground(), 0.1 * kRate * kRate))];
    lia.rest_length = rest_length;
    lia.scheme = scheme;
    return certify(b.scene, {kRate, 14});
  };
  EXPECT_EQ(verdict(0.0, scene::Scheme::kExplicit).verdict, Verdict::kPassive);
  EXPECT_EQ(verdict(0.1, scene::Scheme::kExplicit).verdict, Verdict::kUnproven);
  EXPECT_THAT(verdict(0.1, scene::Scheme::kExplicit).findings,
              Contains(HasSubstr("where its direction turns")));
  EXPECT_EQ(verdict(0.1, scene::Scheme::kEnergyStable).verdict, Verdict::kPassive);
}

/// However soft and damped: what swings in time with the steps is pumped all the same.
TEST(CertifyLinksTest, NoForceThatSwitchesWithoutBoundIsProven) {
  const auto verdict = [](LiaType type, double kappa) {
    SceneBuilder b;
    const int mass = b.mass(1.0);
    b.spring(mass, b.ground(), 0.0, 0.01 * kRate);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), kappa * kRate * kRate))];
    lia.law.edit().stiffness_limit = lia.stiffness;
    lia.damping = {0.01 * kRate};
    return certify(b.scene, {kRate, 14});
  };
  for (const LiaType type : {LiaType::kContact, LiaType::kCubicContact, LiaType::kClippedCubic}) {
    EXPECT_EQ(verdict(type, 0.004).verdict, Verdict::kUnproven);
    EXPECT_THAT(verdict(type, 0.004).findings, Contains(HasSubstr("Use scheme: energy_stable")));
    const bool is_linear_at_rest = type == LiaType::kClippedCubic;
    EXPECT_EQ(verdict(type, 4.1).verdict,
              is_linear_at_rest ? Verdict::kUnstable : Verdict::kUnproven);
  }
}

TEST(CertifyLinksTest, SaturatingElementsAreBoundedWhereEnergyIsLost) {
  for (const LiaType type : {LiaType::kPluck, LiaType::kBow, LiaType::kSmoothBow}) {
    SceneBuilder b;
    b.scene.lias.reserve(3);
    const int mass = b.mass(1.0);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), 0.1 * kRate * kRate))];
    lia.law.edit().width = {0.1};
    lia.damping = {type == LiaType::kPluck ? 0.0 : 0.1 * kRate};
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
    b.spring(mass, b.ground(), 0.0, 0.01);
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
    if (type == LiaType::kPluck) {
      lia.damping = {0.01};
      EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven) << "it comes and goes";
    }
    lia.damping = {3.5 * kRate};
    const Certificate steep = certify(b.scene, {kRate, 14});
    EXPECT_EQ(steep.verdict, type == LiaType::kPluck ? Verdict::kUnproven : Verdict::kBounded);
    EXPECT_THAT(steep.findings, Contains(HasSubstr("is too stiff or too damped")));
  }
}

/// Odd and nowhere falling, it brakes step by step, whatever it acts on.
TEST(CertifyLinksTest, FrictionThatOnlyBrakesIsPassive) {
  SceneBuilder b;
  b.spring(b.mass(1.0), b.ground(), 1.9 * kRate * kRate);
  b.link(LiaType::kTable, 0, 1, 0.0);
  auto& points = b.scene.lias[1].law.edit().viscous_table.points;
  points = {{-1.0, -0.2 * kRate}, {0.0, 0.0}, {1.0, 0.2 * kRate}};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  points[2].second *= 0.9;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven) << "it is not odd";
  points = {{-2.0, -0.1 * kRate}, {-1.0, -0.2 * kRate}, {1.0, 0.2 * kRate}, {2.0, 0.1 * kRate}};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven) << "it falls";
}

TEST(CertifyLinksTest, SteepestLineOfATableCounts) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kPluckTable, mass, b.ground(), 0.0))];
  const double k = 4.5 * kRate * kRate;
  lia.law.edit().table.points = {{-0.01, 0.0}, {0.0, 0.0}, {0.001, 0.001 * k}, {0.002, 0.0}};
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 4.5, 1e-6);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
  lia.law.edit().table.points[2].second *= 0.5;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
  b.spring(mass, b.ground(), 0.0, 0.01);  // what it gives is lost
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

TEST(CertifyLinksTest, WhatNoBoundCoversIsUnproven) {
  SceneBuilder cubic;
  const int mass = cubic.mass(1.0);
  scene::Lia& lia = cubic.scene.lias[at(cubic.link(LiaType::kCubic, mass, cubic.ground(), 1.0))];
  EXPECT_EQ(certify(cubic.scene, {kRate, 14}).verdict, Verdict::kPassive);
  lia.law.edit().nonlinearity = {1.0};
  EXPECT_EQ(certify(cubic.scene, {kRate, 14}).verdict, Verdict::kUnproven);

  SceneBuilder negative;
  const int free_mass = negative.mass(1.0);
  negative.spring(free_mass, negative.ground(), 1.0, -0.1);
  EXPECT_EQ(certify(negative.scene, {kRate, 14}).verdict, Verdict::kUnproven);

  // At a place that moves only its sign is known.
  for (const auto& [k, z] : {std::pair(-1.0, 0.1), {1.0, -0.1}, {1.0, 0.1}}) {
    SceneBuilder moving;
    const int first = moving.chain(3, 1.0, 1e4, 1.0);
    const int place = moving.point(moving.grid(first, 5), 0.5);
    moving.scene.connections.back().along.guide = moving.slice(0);
    moving.scene.connections.back().along.scale = 1.0;
    moving.spring(place, moving.ground(), k, z);
    const bool gives = k < 0.0 || z < 0.0;
    const Certificate certificate = certify(moving.scene, {kRate, 14});
    EXPECT_EQ(testing::Value(certificate.findings, Contains(HasSubstr("an end that moves"))), gives)
        << k << " " << z;
  }
}

TEST(CertifyLinksTest, EnergyStableLinksMakeNoEnergy) {
  const auto verdict = [](LiaType type, int section, scene::Scheme scheme) {
    SceneBuilder b;
    const int mass = b.mass(1.0, 0.0, 0.0, section);
    const int other = b.mass(1.0);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, other, 50.0 * kRate * kRate))];
    lia.scheme = scheme;
    lia.law.edit().exponent = {1.5};
    lia.law.edit().width = {0.1};
    lia.damping = {type == LiaType::kBow ? 50.0 * kRate : 0.0};
    return certify(b.scene, {kRate, 14}).verdict;
  };
  const auto energy_stable = scene::Scheme::kEnergyStable;
  EXPECT_EQ(verdict(LiaType::kPowerContact, 0, energy_stable), Verdict::kPassive);
  EXPECT_EQ(verdict(LiaType::kContact, 0, energy_stable), Verdict::kPassive);
  EXPECT_EQ(verdict(LiaType::kBow, 0, energy_stable), Verdict::kBounded);
  EXPECT_EQ(verdict(LiaType::kContact, SceneBuilder::kGestural, energy_stable), Verdict::kUnproven);
  EXPECT_EQ(verdict(LiaType::kPowerContact, 0, scene::Scheme::kExplicit), Verdict::kUnproven);
  EXPECT_EQ(verdict(LiaType::kContact, 0, scene::Scheme::kExplicit), Verdict::kUnproven);
}

/// Forces move neither end: a tank has nothing to hold back, and the hand is given energy for
/// ever.
TEST(CertifyLinksTest, EnergyStableTablesBesideAHandGiveAsTheExplicitOnes) {
  const auto verdict = [](double last, Scheme scheme) {
    SceneBuilder b;
    Lia& lia = b.scene.lias[at(b.link(LiaType::kTable, b.slice(0), b.ground(), 0.0))];
    lia.law.edit().table.points = {{-0.1, -1.0}, {0.1, 1.0}, {0.2, last}};
    lia.scheme = scheme;
    return certify(b.scene, {kRate, 14}).verdict;
  };
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    EXPECT_EQ(verdict(-1.0, scheme), Verdict::kUnproven);
    EXPECT_EQ(verdict(0.0, scheme), Verdict::kBounded);
    EXPECT_EQ(verdict(1.0, scheme), Verdict::kPassive);
  }
}

TEST(CertifyLinksTest, WhatIsSaidOfManyLinksIsSaidOnce) {
  SceneBuilder b;
  for (int i = 0; i < 30; ++i) {
    const int link = b.link(LiaType::kCubic, b.mass(1.0), b.ground(), 1e3);
    b.scene.lias[at(link)].law.edit().nonlinearity = {i < 20 ? 1e9 : 1e8};
    b.scene.lias[at(link)].scheme = scene::Scheme::kExplicit;
  }
  const std::vector<std::string> findings = certify(b.scene, {kRate, 14}).findings;
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_THAT(findings[0], AllOf(HasSubstr("'l0'"), HasSubstr(" (19 more like it)")));
  EXPECT_THAT(findings[1], AllOf(HasSubstr("'l20'"), HasSubstr(" (9 more like it)")));
}

TEST(CertifyLinksTest, PowerContactSaysHowDeepItWouldHold) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  scene::Lia& lia =
      b.scene.lias[at(b.link(LiaType::kPowerContact, mass, b.ground(), kRate * kRate))];
  lia.law.edit().exponent = {2.0};  // slope 2 K p: h^2 2 K p / M = 4 at p = 2
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  EXPECT_THAT(c.findings, Contains(HasSubstr("beyond an elongation of 2 m")));
}

TEST(CertifyLinksTest, TablesAreBoundedWhereEnergyIsLost) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kTable, mass, b.ground(), 0.0))];
  const double k = 0.04 * kRate * kRate;
  lia.law.edit().table.points = {{-0.01, -0.01 * k}, {0.0, 0.0}, {0.01, 0.005 * k}};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 0.04, 1e-6);
  lia.law.edit().viscous_table.points = {{-1.0, -0.1 * kRate}, {1.0, 0.1 * kRate}};
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 0.04 + 2.0 * 0.1, 1e-6);
  b.scene.sections[0].medium = {1e-3};  // what it gives is lost
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  lia.law.edit().table.points[1].second = 2.0 * kRate * kRate;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

TEST(CertifyLinksTest, ConditionalLinksAreBoundedAndCountClosed) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  b.scene.lias.reserve(2);
  scene::Lia& lia =
      b.scene.lias[at(b.link(LiaType::kConditional, mass, b.ground(), kRate * kRate))];
  lia.law.edit().width = {0.01};
  lia.law.edit().release = 0.02;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
  b.spring(mass, b.ground(), 0.0, 0.01);  // what it gives is lost
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  lia.stiffness = {4.1 * kRate * kRate};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

TEST(CertifyLinksTest, SteepFrictionIsNoted) {
  const auto certificate = [](double rise) {
    SceneBuilder b;
    const int mass = b.mass(1.0);
    b.spring(mass, b.ground(), 0.0, 0.001);
    scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kBow, mass, b.ground(), 0.0))];
    lia.damping = {1.5 * rise * kRate};  // its steepest rise is 2/3 Z, its fall 1/3 Z
    lia.law.edit().width = {0.1};
    return certify(b.scene, {kRate, 14});
  };
  EXPECT_TRUE(certificate(0.39).findings.empty());
  EXPECT_THAT(certificate(0.41).findings, Contains(HasSubstr("stick and slip will be inaccurate")));
  EXPECT_THAT(certificate(0.99).findings, Not(Contains(HasSubstr("overshoots"))));
  EXPECT_THAT(certificate(1.01).findings, Contains(HasSubstr("overshoots")));
  EXPECT_EQ(certificate(1.99).verdict, Verdict::kBounded);
  EXPECT_EQ(certificate(2.01).verdict, Verdict::kBounded);
  EXPECT_THAT(certificate(2.01).findings, Contains(HasSubstr("but not grow")));
}

/// What is shown of linear links holds beside others; what those add is not.
TEST(CertifyLinksTest, OnlyWhatIsShownToGrowIsUnstable) {
  const auto verdict = [](double spring, LiaType type, double stiffness, double damping) {
    SceneBuilder b;
    const int mass = b.mass(1.0);
    b.spring(mass, b.ground(), spring * kRate * kRate, 0.001 * kRate);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), stiffness * kRate * kRate))];
    lia.damping = {damping * kRate};
    lia.law.edit().width = {0.1};
    return certify(b.scene, {kRate, 14}).verdict;
  };
  EXPECT_EQ(verdict(4.1, LiaType::kContact, 1.0, 0.0), Verdict::kUnstable);
  EXPECT_EQ(verdict(3.5, LiaType::kContact, 1.0, 0.0), Verdict::kUnproven);
  EXPECT_EQ(verdict(4.1, LiaType::kSmoothBow, 0.0, 0.5), Verdict::kUnstable);
  EXPECT_EQ(verdict(3.5, LiaType::kSmoothBow, 0.0, 0.5), Verdict::kBounded);
  EXPECT_EQ(verdict(3.5, LiaType::kSpringDamper, 1.0, 0.0), Verdict::kUnstable);
}

}  // namespace
}  // namespace ergotic::physics
