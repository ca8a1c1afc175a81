// SPDX-License-Identifier: BSD-3-Clause
// What is said of links at taps before anything moves.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr Rates kTapRates{kRate, 10};

Certificate certificateOf(const SceneBuilder& b) {
  return certify(settle(b.scene, kTapRates).scene, kTapRates);
}

/// Two masses, and a spring to the ground from where they are worth 2 and -1.5.
SceneBuilder onTwo(double kappa) {
  SceneBuilder b;
  const int one = b.mass(1e-3, 1e-3);
  const int other = b.mass(4e-3);
  const double k = kappa * kRate * kRate / (4.0 / 1e-3 + 2.25 / 4e-3);
  b.spring(b.tap({{one, 2.0}, {other, -1.5}}), b.ground(), k);
  b.hear(one);
  return b;
}

TEST(TapCertificateTest, SpringIsTheLoadOfItsWeights) {
  EXPECT_NEAR(certificateOf(onTwo(1.0)).sections[0].lambda, 1.0, 1e-5);
  EXPECT_EQ(certificateOf(onTwo(3.99)).verdict, Verdict::kPassive);
  EXPECT_EQ(certificateOf(onTwo(4.01)).verdict, Verdict::kUnstable);
  for (const double kappa : {3.99, 4.01}) {
    Player player(settle(onTwo(kappa).scene, kTapRates).scene, kTapRates);
    player.ticks(3000);
    EXPECT_EQ(std::abs(player.heard[0].back()) < 1.0, kappa < 4.0) << kappa;
  }
}

/// A chain beside whose masses a point moves, tied to what a tap is worth of two others.
TEST(TapCertificateTest, BoundBesideAPointThatMovesHoldsWeightsOfAnySize) {
  const auto lambdaAt = [](double along, bool moves) {
    SceneBuilder b;
    const int first = b.chain(6, 1e-3, 0.01 * 1e-3 * kRate * kRate);
    const int point = b.point(b.grid(first, 8), moves ? 1.0 : along);
    if (moves) {
      b.scene.parameters.push_back({"place", along, 0.0, 1.0, {}});
      b.scene.connections[0].along.at = {1.0, 0};
    }
    const int one = b.mass(2e-3);
    const int other = b.mass(1e-3);
    b.spring(point, b.tap({{one, 3.0}, {other, -2.0}}), 0.1 * 1e-3 * kRate * kRate);
    return certificateOf(b).sections[0].lambda;
  };
  const double bound = lambdaAt(0.5, true);
  for (int i = 0; i <= 14; ++i) {
    EXPECT_LE(lambdaAt(i / 14.0, false), bound * (1.0 + 1e-6)) << i;
  }
  EXPECT_LT(bound, 4.0);
}

/// Friction at a lever rubs what the lever is worth.
TEST(TapCertificateTest, FrictionRubsTheMassOfTheTap) {
  const auto isEnergyStable = [](double lever) {
    SceneBuilder b;
    const int m = b.mass(1e-3);
    b.spring(m, b.ground(), 100.0, 0.01);
    b.link(LiaType::kSmoothBow, b.tap({{m, lever}}), b.ground(), 0.0, 0.1 * 1e-3 * kRate);
    b.scene.lias.back().law.edit().width = {0.1};
    b.scene.lias.back().scheme = Scheme::kAuto;
    return settle(b.scene, kTapRates).scene.lias.back().scheme == Scheme::kEnergyStable;
  };
  EXPECT_FALSE(isEnergyStable(1.0));
  EXPECT_TRUE(isEnergyStable(10.0));
}

/// A table gives to all that its tap moves: one mass that loses nothing is enough.
TEST(TapCertificateTest, AllBodiesUnderATapMustLoseWhatItGives) {
  const auto verdictOf = [](double damping) {
    SceneBuilder b;
    std::vector<scene::Tap::Share> shares;
    for (const double z : {0.01, damping}) {
      const int m = b.mass(1e-3);
      b.spring(m, b.ground(), 100.0, z);
      shares.push_back({m, 0.5});
    }
    b.link(LiaType::kPluck, b.tap(shares), b.ground(), 100.0);
    b.scene.lias.back().law.edit().width = {1e-3};
    return certificateOf(b).verdict;
  };
  EXPECT_EQ(verdictOf(0.01), Verdict::kBounded);
  EXPECT_EQ(verdictOf(0.0), Verdict::kUnproven);
}

/// The hand pushes a mass that a soft spring holds, and the stiff one of a tap.
TEST(TapCertificateTest, HandFeelsWhatHoldsAMassThroughATap) {
  const auto felt = [](bool is_tapped) {
    SceneBuilder b;
    b.scene.sections[0].gestural = true;
    const int m = b.mass(0.1);
    b.spring(b.slice(0), m, 1500.0, 5.0);
    b.spring(m, b.ground(), 10.0);
    if (is_tapped) {
      b.spring(b.tap({{m, 1.0}}), b.ground(), 1e4, 10.0);
    }
    return certificateOf(b).ports[0].stiffness;
  };
  EXPECT_NEAR(felt(false), 1.0 / (1.0 / 1500.0 + 1.0 / 10.0), 1e-9);
  EXPECT_NEAR(felt(true), 1500.0, 1e-9);
}

}  // namespace
}  // namespace ergotic::physics
