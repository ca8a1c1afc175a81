// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/coarse_string.hpp"

#include <Eigen/Eigenvalues>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kHz = 110.0;
constexpr double kStringMass = 1e-4;

/// A coarse string as the reader leaves it: its links without stiffness.
SceneBuilder coarse(int masses, double hz, int section = SceneBuilder::kAudio) {
  SceneBuilder b;
  scene::StringInfo info;
  info.name = "string";
  info.first = b.ground(0.0, section);
  info.count = masses + 2;
  info.mass = {kStringMass};
  info.frequency_hz = hz;
  info.coarse = true;
  for (int i = 0; i < masses; ++i) {
    b.mass(kStringMass, 0.0, 0.0, section);
  }
  b.ground(0.0, section);
  for (int i = 0; i < scene::coarseLinks(masses); ++i) {
    const scene::CoarseLink link = scene::coarseLink(masses, i);
    b.spring(info.first + link.a, info.first + link.b, 0.0);
  }
  b.scene.strings.push_back(info);
  return b;
}

double heardPartial(int masses, double hz, int partial, int section, const Rates& rates) {
  SceneBuilder b = coarse(masses, hz, section);
  for (int i = 1; i <= masses; ++i) {
    b.scene.mats[at(i)].position.x() = 1e-3 * std::sin(kPi * partial * i / (masses + 1));
  }
  b.hear(1);
  Player player(b.scene, rates);
  player.ticks(4000);
  const int divisor = section == SceneBuilder::kGestural ? rates.ratio : 1;
  std::vector<double> steps;
  for (std::size_t n = 0; n < player.heard[0].size(); n += at(divisor)) {
    steps.push_back(player.heard[0][n]);
  }
  return std::arg(test::poleOf(steps)) / (2.0 * kPi) * rates.audio_hz / divisor;
}

TEST(CoarseStringTest, TwentyMassesCarryTenPartialsOf110Hz) {
  const CoarseFit fit = fitCoarseString(20, kHz / kRate, 10);
  EXPECT_NEAR(fit.kappa[0], 0.01736008, 5e-9);
  EXPECT_NEAR(fit.kappa[1], -0.00204130, 5e-9);
  EXPECT_NEAR(fit.kappa[2], 0.00019792, 5e-9);
  EXPECT_NEAR(fit.worstCents(10), 0.785, 0.005);
  EXPECT_LT(fit.worstCents(1), 1e-9) << "in tune";
  EXPECT_LT(fit.worstCents(5), fit.worstCents(10));
}

TEST(CoarseStringTest, FortyMassesCarryTwentyPartials) {
  EXPECT_NEAR(fitCoarseString(40, kHz / kRate, 20).worstCents(20), 1.27, 0.01);
}

TEST(CoarseStringTest, ThreePartialsAreMetExactly) {
  const CoarseFit fit = fitCoarseString(7, kHz / kRate, 3);
  EXPECT_LT(fit.worstCents(3), 1e-8);
}

TEST(CoarseStringTest, PartialsThatSoundAreThoseThatWerePredicted) {
  const CoarseFit fit = fitCoarseString(20, kHz / kRate, 10);
  for (int j = 1; j <= 10; ++j) {
    const double predicted = j * kHz * std::exp2(fit.cents[at(j - 1)] / 1200.0);
    const double heard = heardPartial(20, kHz, j, SceneBuilder::kAudio, {kRate, 14});
    EXPECT_LT(std::abs(1200.0 * std::log2(heard / predicted)), 0.05) << j;
    EXPECT_LT(std::abs(1200.0 * std::log2(heard / (j * kHz))), 0.79) << j;
  }
}

TEST(CoarseStringTest, FitHoldsAtTheStepOfItsSection) {
  const Rates rates{kRate, 4};
  const CoarseFit fit = fitCoarseString(16, 4 * kHz / kRate, 8);
  for (const int j : {1, 8}) {
    const double heard = heardPartial(16, kHz, j, SceneBuilder::kGestural, rates);
    const double predicted = j * kHz * std::exp2(fit.cents[at(j - 1)] / 1200.0);
    EXPECT_LT(std::abs(1200.0 * std::log2(heard / predicted)), 0.05) << j;
  }
}

TEST(CoarseStringTest, LinksHaveTheModesOfTheFit) {
  const int masses = 9;
  const Settled settled = settle(coarse(masses, kHz).scene, {kRate, 14});
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(masses + 2, masses + 2);
  for (const scene::Lia& lia : settled.scene.lias) {
    const double kappa = lia.stiffness.factor / (kStringMass * kRate * kRate);
    k(lia.a, lia.a) += kappa;
    k(lia.b, lia.b) += kappa;
    k(lia.a, lia.b) -= kappa;
    k(lia.b, lia.a) -= kappa;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(k.block(1, 1, masses, masses));
  const CoarseFit fit = fitCoarseString(masses, kHz / kRate, 4);
  for (int j = 1; j <= masses; ++j) {
    EXPECT_NEAR(modes.eigenvalues()[j - 1], coarseEigenvalue(fit, masses, j), 1e-12) << j;
  }
}

TEST(CoarseStringTest, NegativeSpringsHoldStillAndAreCertified) {
  const Settled settled = settle(coarse(20, kHz).scene, {kRate, 14});
  const CoarseFit fit = fitCoarseString(20, kHz / kRate, 10);
  double lowest = 4.0;
  for (int j = 1; j <= 20; ++j) {
    lowest = std::min(lowest, coarseEigenvalue(fit, 20, j));
  }
  EXPECT_NEAR(lowest, 2.5e-4, 1e-5);
  EXPECT_NE(certify(settled.scene, {kRate, 14}).verdict, Verdict::kUnstable);
}

TEST(CoarseStringTest, NoteSaysTheErrorAndThePitchIsTheFittedOne) {
  const Settled settled = settle(coarse(20, kHz).scene, {kRate, 14});
  ASSERT_EQ(settled.notes.size(), 1U);
  EXPECT_THAT(settled.notes[0], HasSubstr("built.yaml:1:1: note: string 'string'"));
  EXPECT_THAT(settled.notes[0], HasSubstr("0.616 cents on 5, 0.785 cents on 10 partials"));
  const double pitch = stringPitchHz(settled.scene, settled.scene.strings[0], kRate);
  EXPECT_NEAR(pitch, kHz, 1e-9);
  EXPECT_TRUE(scene::isSettled(settled.scene));
}

TEST(CoarseStringTest, MassThatIsAParameterKeepsThePitch) {
  SceneBuilder b = coarse(20, kHz);
  b.scene.parameters.push_back({"mass", 2e-4, 1e-4, 3e-4, {}});
  b.scene.strings[0].mass = {0.5, 0};
  for (scene::Mat& mat : b.scene.mats) {
    mat.mass = {0.5, 0};
  }
  const Settled settled = settle(b.scene, {kRate, 14});
  const scene::Value& k = settled.scene.lias[5].stiffness;
  EXPECT_EQ(k.parameter, 0);
  EXPECT_NEAR(settled.scene.valueOf(k) / (1e-4 * kRate * kRate), 0.01736008, 5e-9);
}

TEST(CoarseStringTest, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(settle(coarse(2, kHz).scene, {kRate, 14}), TextError);
  EXPECT_THROW(settle(coarse(20, 2300.0).scene, {kRate, 14}), TextError)
      << "the tenth partial is above half the rate";
  EXPECT_THROW(settle(coarse(20, 1500.0).scene, {kRate, 14}), TextError) << "unstable";
  EXPECT_NO_THROW(settle(coarse(20, 500.0).scene, {kRate, 14}));
}

}  // namespace
}  // namespace ergotic::physics
