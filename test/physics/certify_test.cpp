// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certify.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}
bool has(const Certificate& c, const std::string& text) {
  return std::any_of(c.findings.begin(), c.findings.end(), [&](const std::string& finding) {
    return finding.find(text) != std::string::npos;
  });
}

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
  EXPECT_TRUE(has(c, "built.yaml:104:1: error")) << c.findings.front();
  EXPECT_TRUE(has(c, "'l4'"));
  const double advised = std::ceil(c.sections[0].stable_rate_hz);
  EXPECT_TRUE(has(c, " " + std::to_string(static_cast<int>(advised)) + " Hz or more"));
  EXPECT_EQ(certify(b.scene, {advised, 14}).verdict, Verdict::kPassive);
  EXPECT_LT(c.margin(), 0.0);
  b.hear(first + 3);
  const double rate = c.sections[0].stable_rate_hz * 1.0001;
  EXPECT_GT(rate, kRate);
  EXPECT_EQ(certify(b.scene, {rate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifyTest, WorstEndOfEveryParameterCounts) {
  SceneBuilder b;
  scene::Parameter tension;
  tension.name = "tension";
  tension.value = 0.5;
  tension.minimum = 0.1;
  tension.maximum = 5.0;
  b.scene.parameters.push_back(tension);
  const int mass = b.mass(1.0);
  b.scene.lias[at(b.spring(mass, b.ground(), 0.0))].stiffness = {kRate * kRate, 0};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  b.scene.parameters[0].maximum = 3.9;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
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

TEST(CertifyTest, CoupledMassesAreProvenOnlyWhereTheRuleCovers) {
  const auto verdict = [](double fast_kappa) {
    SceneBuilder b;
    const int slow = b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
    const int fast = b.mass(0.1);
    b.spring(slow, fast, 0.001 * kRate * kRate / 14.0);
    b.spring(fast, b.ground(), fast_kappa * 0.1 * kRate * kRate);
    return certify(b.scene, {kRate, 14});
  };
  EXPECT_EQ(verdict(1e-4).verdict, Verdict::kPassive);
  EXPECT_EQ(verdict(1.0).verdict, Verdict::kUnproven);
  EXPECT_TRUE(has(verdict(1.0), "modes reach above half the slower rate"));
}

TEST(CertifyTest, ASliceIsHeldAndNeedsNoMass) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int mass = b.mass(0.001);
  b.spring(slice, mass, 0.5 * 0.001 * kRate * kRate);
  b.spring(mass, b.ground(), 0.5 * 0.001 * kRate * kRate);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifyTest, SwitchingLinksAreJudgedByTheirKappa) {
  const auto verdict = [](LiaType type, double kappa) {
    SceneBuilder b;
    const int mass = b.mass(1.0);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), kappa * kRate * kRate))];
    lia.stiffness_limit = lia.stiffness;
    return certify(b.scene, {kRate, 14});
  };
  for (const LiaType type : {LiaType::kContact, LiaType::kCubicContact, LiaType::kClippedCubic}) {
    EXPECT_EQ(verdict(type, 0.04).verdict, Verdict::kPassive);
    EXPECT_TRUE(verdict(type, 0.04).findings.empty());
    EXPECT_EQ(verdict(type, 0.2).verdict, Verdict::kPassive);
    EXPECT_TRUE(has(verdict(type, 0.2), "hard hits"));
    EXPECT_EQ(verdict(type, 0.5).verdict, Verdict::kUnproven);
    EXPECT_EQ(verdict(type, 4.1).verdict, Verdict::kUnstable);
  }
}

TEST(CertifyTest, SaturatingElementsAreBounded) {
  for (const LiaType type : {LiaType::kPluck, LiaType::kBow, LiaType::kSmoothBow}) {
    SceneBuilder b;
    const int mass = b.mass(1.0);
    scene::Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), 0.0, 0.0))];
    lia.width = {0.1};
    lia.damping = {0.1 * kRate};
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
    lia.damping = {2.5 * kRate};
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  }
}

TEST(CertifyTest, SteepestLineOfATableCounts) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kPluck, mass, b.ground(), 0.0))];
  const double k = 4.5 * kRate * kRate;
  lia.table.points = {{-0.01, 0.0}, {0.0, 0.0}, {0.001, 0.001 * k}, {0.002, 0.0}};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnstable);
  lia.table.points[2].second *= 0.5;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

TEST(CertifyTest, WhatNoBoundCoversIsUnproven) {
  SceneBuilder cubic;
  const int mass = cubic.mass(1.0);
  scene::Lia& lia = cubic.scene.lias[at(cubic.link(LiaType::kCubic, mass, cubic.ground(), 1.0))];
  EXPECT_EQ(certify(cubic.scene, {kRate, 14}).verdict, Verdict::kPassive);
  lia.nonlinearity = {1.0};
  EXPECT_EQ(certify(cubic.scene, {kRate, 14}).verdict, Verdict::kUnproven);

  SceneBuilder negative;
  const int free_mass = negative.mass(1.0);
  negative.spring(free_mass, negative.ground(), 1.0, -0.1);
  EXPECT_EQ(certify(negative.scene, {kRate, 14}).verdict, Verdict::kUnproven);
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
  EXPECT_TRUE(has(c, "built.yaml:7:1: warning: 'k' follows an audio input"));
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
