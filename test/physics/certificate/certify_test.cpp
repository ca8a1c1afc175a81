// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/certify.hpp"

#include <stdexcept>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// One cell with kappa + 2 zeta = lambda, half of it from the damper.
SceneBuilder cellWith(double lambda) {
  SceneBuilder b;
  const double m = 0.01;
  b.cell(m, 0.5 * lambda * m * kRate * kRate, 0.25 * lambda * m * kRate, 1e-3);
  b.hear(0);
  return b;
}

double peakAfter(const scene::Scene& scene, int ticks) {
  Player player(scene, {kRate, 1});
  player.ticks(ticks);
  double peak = 0.0;
  for (const double x : player.heard[0]) {
    peak = std::isfinite(x) ? std::max(peak, std::abs(x)) : 1e300;
  }
  return peak;
}

TEST(CertifyTest, BoundOfACellIsExact) {
  const auto below = cellWith(3.999);
  const auto above = cellWith(4.001);
  EXPECT_NEAR(certify(below.scene, {kRate, 14}).sections[0].lambda, 3.999, 1e-9);
  EXPECT_EQ(certify(below.scene, {kRate, 14}).verdict, Verdict::kPassive);
  EXPECT_EQ(certify(above.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  EXPECT_LT(peakAfter(below.scene, 50000), 0.01);
  EXPECT_GT(peakAfter(above.scene, 50000), 1.0);
}

TEST(CertifyTest, ChainIsStableBelowTheBoundAndDivergesAboveIt) {
  for (const double kappa : {0.9999, 1.01}) {
    SceneBuilder b;
    const double m = 1e-4;
    const int first = b.chain(50, m, kappa * m * kRate * kRate);
    b.scene.mats[at(first + 7)].position.x() = 1e-3;
    b.hear(first + 20);
    const Certificate c = certify(b.scene, {kRate, 14});
    EXPECT_EQ(c.verdict, kappa < 1.0 ? Verdict::kPassive : Verdict::kUnstable);
    EXPECT_EQ(peakAfter(b.scene, 20000) > 1.0, kappa > 1.0) << kappa;
  }
}

TEST(CertifyTest, CollatzWielandtSavesANetworkThatTheLinkBoundWouldRefuse) {
  // A light mass between heavy ones: the link bound adds two ends that never load together.
  SceneBuilder b;
  const double k = 1.2 * kRate * kRate;
  const int end = b.ground();
  const int heavy = b.mass(1.0);
  const int other = b.mass(1.0);
  const int last = b.ground();
  b.spring(end, heavy, k);
  b.spring(heavy, other, k);
  b.spring(other, last, 0.2 * k);
  const auto c = certify(b.scene, {kRate, 1});
  EXPECT_GE(c.sections[0].link_bound, 3.8);
  EXPECT_LE(c.sections[0].lambda, c.sections[0].link_bound);
  // exact: eigenvalues of [[2.4, -1.2], [-1.2, 1.44]]
  const double exact = 1.92 + std::sqrt(0.48 * 0.48 + 1.2 * 1.2);
  EXPECT_GE(c.sections[0].lambda, exact - 1e-12);
  EXPECT_EQ(c.verdict, Verdict::kPassive);
}

TEST(CertifyTest, RefusalNamesTheLinkAndARateThatWorks) {
  SceneBuilder b;
  const double m = 1e-4;
  const int first = b.chain(10, m, 0.5 * m * kRate * kRate, 0.01 * m * kRate);
  b.scene.lias[4].stiffness = {3.0 * m * kRate * kRate};
  const Certificate c = certify(b.scene, {kRate, 14});
  ASSERT_EQ(c.verdict, Verdict::kUnstable);
  EXPECT_EQ(c.sections[0].worst_lia, 4);
  EXPECT_THAT(c.findings, Contains(HasSubstr("built.yaml:104:1: error")));
  EXPECT_THAT(c.findings, Contains(HasSubstr("'l4'")));
  const double advised = std::ceil(c.sections[0].stable_rate_hz);
  EXPECT_THAT(c.findings,
              Contains(HasSubstr(" " + std::to_string(static_cast<int>(advised)) + " Hz or more")));
  EXPECT_EQ(certify(b.scene, {advised, 14}).verdict, Verdict::kPassive);
  EXPECT_LT(c.margin(), 0.0);
  b.hear(first + 3);
  const double rate = c.sections[0].stable_rate_hz * 1.0001;
  EXPECT_GT(rate, kRate);
  EXPECT_EQ(certify(b.scene, {rate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifyTest, WorstEndOfEveryParameterCounts) {
  SceneBuilder b;
  b.scene.parameters.push_back({"tension", 0.5, 0.1, 5.0, {}});
  const int mass = b.mass(1.0);
  b.scene.lias[at(b.spring(mass, b.ground(), 0.0))].stiffness = {kRate * kRate, 0};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  b.scene.parameters[0].maximum = 3.9;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  b.scene.lias[0].stiffness = {-kRate * kRate, 0};  // where a factor is below 0, the other end
  b.scene.parameters[0] = {"tension", -0.5, -3.9, -0.1, {}};
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 3.9, 1e-6);
}

TEST(CertifyTest, SectionsOfOneRateAreOneNetwork) {
  SceneBuilder b;
  scene::Section more;
  more.name = "more";
  b.scene.sections.push_back(more);
  const int left = b.mass(1.0, 0.0, 0.0, 0);
  const int right = b.mass(1.0, 0.0, 0.0, 2);
  b.spring(b.ground(), left, 1.5 * kRate * kRate);
  b.spring(left, right, 1.5 * kRate * kRate);
  const auto c = certify(b.scene, {kRate, 14});
  // eigenvalues of 1.5 [[2, -1], [-1, 1]]
  EXPECT_GE(c.sections[0].lambda, 1.5 * (1.5 + std::sqrt(1.25)) - 1e-12);
  EXPECT_EQ(c.verdict, Verdict::kPassive);
  EXPECT_EQ(c.sections[0].lambda, c.sections[2].lambda);
  EXPECT_EQ(c.sections[2].section, 2);
  b.scene.lias[0].stiffness = {3.0 * kRate * kRate};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
}

TEST(CertifyTest, SectionsAreCertifiedAtTheirOwnStep) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 1.0, 0.0, SceneBuilder::kGestural);
  b.spring(mass, b.ground(0.0, SceneBuilder::kGestural), 0.1 * kRate * kRate);
  EXPECT_EQ(certify(b.scene, {kRate, 4}).verdict, Verdict::kPassive);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
}

TEST(CertifyTest, CoupledMassesAreProvenByEigenvalues) {
  const auto verdict = [](double coupling, double fast_kappa, double heaviest = 1.0) {
    SceneBuilder b;
    const int slow = b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
    b.scene.parameters.push_back({"kg", heaviest, 1.0, heaviest, {}});
    b.scene.mats[at(slow)].mass = {1.0, 0};
    const int fast = b.mass(0.1);
    b.spring(slow, fast, coupling * kRate * kRate / 14.0);
    b.spring(fast, b.ground(), fast_kappa * 0.1 * kRate * kRate);
    return certify(b.scene, {kRate, 14});
  };
  EXPECT_EQ(verdict(0.001, 1e-4).verdict, Verdict::kPassive);
  EXPECT_EQ(verdict(0.001, 1.0).verdict, Verdict::kPassive);
  EXPECT_EQ(verdict(0.5, 1.0).verdict, Verdict::kUnstable);
  EXPECT_EQ(verdict(0.5, 1.0, 1e6).verdict, Verdict::kUnstable) << "at its lightest";
  EXPECT_THAT(verdict(0.5, 1.0).findings, Contains(HasSubstr("stiffly for its rate")));
  EXPECT_THAT(verdict(0.5, 1.0).findings, Contains(HasSubstr("grows by a factor of exp(")));
}

TEST(CertifyTest, CoupledMassesAreWatchedWhereTheyAreMoreThanThreeHundred) {
  SceneBuilder b;
  const int slow = b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(slow, b.chain(300, 1e-3, 100.0) + 1, 1.0);
  const Certificate certificate = certify(b.scene, {kRate, 14});
  EXPECT_EQ(certificate.verdict, Verdict::kUnproven);
  EXPECT_THAT(certificate.findings,
              Contains(HasSubstr("With 301 masses it is too large for its eigenvalues")));
}

TEST(CertifyTest, ASliceIsHeldAndNeedsNoMass) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int mass = b.mass(0.001);
  b.spring(slice, mass, 1000.0);
  b.spring(mass, b.ground(), 0.5 * 0.001 * kRate * kRate);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifyTest, WhatOverflowsIsNotProven) {
  for (const auto& [kg, k] : {std::pair(1e-20, 1e300), {1e-320, 7.6e4}, {1e-300, 1e20}}) {
    SceneBuilder b;
    b.spring(b.mass(kg), b.ground(), k);
    const int chain = b.mass(kg);
    b.spring(chain, b.mass(kg), k);
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable) << kg << ' ' << k;
  }
}

TEST(CertifyTest, WhatFollowsAnAudioInputIsUnproven) {
  SceneBuilder b;
  b.scene.lias[at(b.spring(b.mass(1.0), b.ground(), 0.0))].stiffness = {1.0, -1, 0};
  b.scene.audio_parameters.push_back({"k", 0, 0.0, {7, 1}});
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  EXPECT_THAT(c.findings,
              Contains(HasSubstr("built.yaml:7:1: warning: 'k' follows an audio input")));
}

TEST(CertifyTest, PlacesThatFollowAnAudioInputAreJudgedOverTheirRange) {
  const auto certificate = [](double k) {
    SceneBuilder b;
    const int first = b.chain(3, 1.0, 0.5 * kRate * kRate, 0.01 * kRate);
    const int place = b.point(b.grid(first, 5), 0.5);
    b.scene.audio_parameters.push_back({"place", 0, 0.0, {7, 1}});
    b.scene.connections.back().along.at = {1.0, -1, 0};
    b.spring(place, b.ground(), k * kRate * kRate);
    return certify(b.scene, {kRate, 14});
  };
  EXPECT_EQ(certificate(1.0).verdict, Verdict::kBounded);
  EXPECT_TRUE(certificate(1.0).findings.empty());
  EXPECT_EQ(certificate(4.0).verdict, Verdict::kUnstable) << "where it lies on a module";
}

TEST(CertifyTest, ScenesMustBeSettled) {
  SceneBuilder b;
  b.scene.lias[at(b.spring(b.mass(1.0), b.ground(), 1.0))].scheme = scene::Scheme::kAuto;
  EXPECT_THROW(certify(b.scene, {kRate, 14}), std::logic_error);
}

TEST(CertifyTest, MatchedCellsAreStableAloneAndCountByTheirOwnCoefficients) {
  // w h = 3: far beyond the explicit limit, and matched still.
  SceneBuilder b = cellWith(9.0);
  b.scene.mats[0].damping = {0.0};
  b.scene.mats[0].stiffness = {9.0 * 0.01 * kRate * kRate};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  b.scene.mats[0].matched = true;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  const double room = 4.0 - (2.0 - 2.0 * std::cos(3.0));
  const int link = b.spring(0, b.ground(), 0.999 * room * 0.01 * kRate * kRate);
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 4.0 - 0.001 * room, 1e-5);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  b.scene.mats[0].position.x() = 1e-3;
  EXPECT_LT(peakAfter(b.scene, 20000), 1.0);
  b.scene.lias[at(link)].stiffness = {1.001 * room * 0.01 * kRate * kRate};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  EXPECT_GT(peakAfter(b.scene, 20000), 1.0);
  // At w h = 2 pi it pulls not at all, on the way there with all its might.
  b.scene.parameters.push_back({"k", 1.0, 0.0, 1.0, {}});
  b.scene.mats[0].stiffness = {4.0 * kPi * kPi * 0.01 * kRate * kRate, 0};
  EXPECT_NE(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

/// Beyond a quarter of the rate a cell is worst where it is damped least.
TEST(CertifyTest, MatchedCellsCountAtBothEndsOfTheirDamping) {
  const auto lambda = [](double lowest, double highest) {
    SceneBuilder b = cellWith(9.0);
    b.scene.mats[0].matched = true;
    b.scene.mats[0].stiffness = {9.0 * 0.01 * kRate * kRate};
    b.scene.parameters.push_back({"z", highest, lowest, highest, {}});
    b.scene.mats[0].damping = {0.01 * kRate, 0};
    b.spring(0, b.ground(), 1e-6);
    return certify(b.scene, {kRate, 14}).sections[0].lambda;
  };
  EXPECT_GT(lambda(0.0, 0.0), lambda(1.0, 1.0) + 0.1);
  EXPECT_GE(lambda(0.0, 1.0), lambda(0.0, 0.0));
}

TEST(CertifyTest, MediumCountsOnEveryFreeMass) {
  SceneBuilder b;
  b.spring(b.mass(1.0), b.ground(), 1.0 * kRate * kRate);
  b.scene.sections[0].medium = {0.2 * kRate};
  // Matched: zeta = 1 - e^(-h Z/M).
  EXPECT_NEAR(certify(b.scene, {kRate, 14}).sections[0].lambda, 1.0 - 2.0 * std::expm1(-0.2), 1e-6);
}

TEST(CertifyTest, NegativeSpringsAreProvenWhereTheOthersMakeUpForThem) {
  const auto verdict = [](double stiffness, double damping) {
    SceneBuilder b;
    const int left = b.mass(1.0);
    const int right = b.mass(1.0);
    b.spring(b.ground(), left, kRate * kRate, 0.1 * kRate);
    b.spring(right, b.ground(), kRate * kRate, 0.1 * kRate);
    b.spring(left, right, stiffness * kRate * kRate, damping * kRate);
    return certify(b.scene, {kRate, 14}).verdict;
  };
  EXPECT_EQ(verdict(-0.49, 0.0), Verdict::kPassive);
  EXPECT_EQ(verdict(-0.51, 0.0), Verdict::kUnproven);
  EXPECT_EQ(verdict(0.0, -0.049), Verdict::kPassive);
  EXPECT_EQ(verdict(0.0, -0.051), Verdict::kUnproven);
}

/// A string with a finger that a parameter slides along it.
TEST(CertifyTest, MovingPointsCountAtTheirWorstPlace) {
  const auto certificate = [](double finger) {
    SceneBuilder b;
    const int first = b.chain(30, 1e-4, 0.9 * 1e-4 * kRate * kRate);
    b.scene.parameters.push_back({"place", 0.5, 0.2, 0.8, {}});
    const int point = b.point(b.grid(first, 32), 1.0);
    b.scene.connections[0].along.at = {1.0, 0};
    b.spring(point, b.ground(), finger * 1e-4 * kRate * kRate);
    return certify(b.scene, {kRate, 14});
  };
  // A spring a on one mass of a long chain: lambda = 2 kappa + sqrt(4 kappa^2 + a^2).
  EXPECT_NEAR(certificate(0.5).sections[0].lambda, 1.8 + std::sqrt(3.24 + 0.25), 2e-3);
  EXPECT_EQ(certificate(1.2).verdict, Verdict::kBounded) << "moving it may bring something";
  EXPECT_EQ(certificate(1.35).verdict, Verdict::kUnstable);
}

/// Two masses of two strings, as soft as nothing, and a spring between: 2 K h^2/M at least.
TEST(CertifyTest, ASpringBetweenPointsThatMoveLoadsBoth) {
  SceneBuilder b;
  b.scene.parameters.push_back({"place", 0.5, 0.2, 0.8, {}});
  int points[2];
  for (int& point : points) {
    point = b.point(b.grid(b.chain(9, 1e-4, 1.0), 11), 1.0);
    b.scene.connections.back().along.at = {1.0, 0};
  }
  b.spring(points[0], points[1], 0.9 * 1e-4 * kRate * kRate);
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_GE(c.sections[0].lambda, 1.8);
  EXPECT_LT(c.sections[0].lambda, 1.81);
}

TEST(CertifyTest, SlowMassesOnHeldFastModulesCount) {
  SceneBuilder b;
  const int slow = b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
  const int link = b.spring(slow, b.ground(), 3.9 * kRate * kRate / 196.0);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  b.scene.lias[at(link)].stiffness = {4.1 * kRate * kRate / 196.0};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
}

TEST(CertifyTest, WorstFindingsComeFirst) {
  SceneBuilder b;
  b.link(LiaType::kBow, b.mass(1.0), b.ground(), 0.0, 1.6 * kRate);  // overshoots
  b.scene.lias.back().law.edit().width = {1.0};
  b.scene.sections[0].medium = {1e-3};
  b.link(LiaType::kContact, b.mass(1.0), b.ground(), 0.5 * kRate * kRate);
  const Certificate c = certify(b.scene, {kRate, 14});
  ASSERT_GE(c.findings.size(), 2u);
  EXPECT_THAT(c.findings[0], HasSubstr("'l1'"));
}

/// 24,000 masses, too many for the exact test where bounds tell; the highest mode is at 8 h^2 K/M.
TEST(CertifyTest, ALargeMeshWithDiagonalsIsJudgedByItsCells) {
  for (const double lambda : {3.6, 4.4}) {
    const double k = lambda / 8.0 * 1e-3 * kRate * kRate;
    const scene::Scene mesh = scene::readYaml(
        "ergotic: 1\nsections: {s: {}}\ngenerators:\n"
        "  - {type: mesh, name: p, rows: 160, columns: 160, spacing: 0.01, neighbours: 8,\n"
        "     mass: 1e-3, stiffness: " +
            std::to_string(k) + ", diagonal_stiffness: " + std::to_string(0.5 * k) + "}\n",
        "mesh.yaml");
    const Certificate c = certify(mesh, {kRate, 1});
    EXPECT_GT(c.sections[0].link_bound, 1.3 * lambda);
    EXPECT_NEAR(c.sections[0].lambda, lambda, 0.01 * lambda);
    EXPECT_GE(c.sections[0].lambda, lambda * std::pow(std::cos(kPi / 318.0), 2.0));
    EXPECT_EQ(c.verdict, lambda < 4.0 ? Verdict::kPassive : Verdict::kUnstable);
    const double advised = c.sections[0].stable_rate_hz;
    EXPECT_EQ(certify(mesh, {1.001 * advised, 1}).verdict, Verdict::kPassive);
  }
}

TEST(CertifyTest, SceneWithoutLinksIsPassive) {
  SceneBuilder b;
  b.mass(1.0);
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kPassive);
  EXPECT_EQ(c.margin(), 1.0);
}

}  // namespace
}  // namespace ergotic::physics
