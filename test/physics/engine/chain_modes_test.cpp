// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "support/measure.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kPi = 3.14159265358979323846;
std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct Chain {
  int masses = 1;
  double kappa = 0.6;  ///< of a link, h^2 K/M
  double zeta = 0.0;   ///< of a link, h Z/M

  double eigenvalue(int mode) const {
    const double s = std::sin(kPi * mode / (2.0 * (masses + 1)));
    return 4.0 * s * s;
  }
  /// lambda^2 - (2 - kappa_j - zeta_j) lambda + (1 - zeta_j) = 0
  std::complex<double> expectedPole(int mode) const {
    const double kj = kappa * eigenvalue(mode);
    const double zj = zeta * eigenvalue(mode);
    const double b = 2.0 - kj - zj;
    return (b + std::sqrt(std::complex<double>(b * b - 4.0 * (1.0 - zj)))) / 2.0;
  }
};

/// The chain is let go in the shape of a mode; heard where that moves most.
std::complex<double> playedPole(const Chain& chain, int mode) {
  SceneBuilder b;
  const double m = 1e-4;
  const int first =
      b.chain(chain.masses, m, chain.kappa * m * kRate * kRate, chain.zeta * m * kRate);
  int loudest = 1;
  for (int i = 1; i <= chain.masses; ++i) {
    const double shape = std::sin(kPi * mode * i / (chain.masses + 1));
    b.scene.mats[at(first + i)].position.x() = shape;
    const double most = std::sin(kPi * mode * loudest / (chain.masses + 1));
    loudest = std::abs(shape) > std::abs(most) ? i : loudest;
  }
  b.hear(first + loudest);
  Player player(b.scene, {kRate, 14});
  player.ticks(60);
  return test::poleOf(player.heard[0]);
}

TEST(ChainModesTest, EveryModeTurnsByTheAngleOfTheExplicitScheme) {
  for (const int masses : {1, 3, 10, 50}) {
    for (int mode = 1; mode <= masses; ++mode) {
      const Chain chain{masses, 0.9, 0.0};
      const std::complex<double> pole = playedPole(chain, mode);
      const double omega = 2.0 * std::asin(std::sqrt(0.9 * chain.eigenvalue(mode)) / 2.0);
      EXPECT_NEAR(std::arg(pole), omega, 1e-9) << masses << " masses, mode " << mode;
      EXPECT_NEAR(std::abs(pole), 1.0, 1e-9) << masses << " masses, mode " << mode;
    }
  }
}

TEST(ChainModesTest, EveryDampedModeHasThePoleOfTheExplicitScheme) {
  for (const int masses : {1, 3, 10, 50}) {
    for (int mode = 1; mode <= masses; ++mode) {
      const Chain chain{masses, 0.6, 0.02};
      const std::complex<double> error = playedPole(chain, mode) - chain.expectedPole(mode);
      EXPECT_LT(std::abs(error), 1e-9) << masses << " masses, mode " << mode;
    }
  }
}

TEST(ChainModesTest, HighestModeAlternatesAtTheStabilityLimit) {
  // One mass between two springs: kappa = 2 per spring would be 4 in all.
  const std::complex<double> pole = playedPole({1, 1.98, 0.0}, 1);
  EXPECT_NEAR(std::arg(pole), 2.0 * std::asin(std::sqrt(0.99)), 1e-9);
}

TEST(ChainModesTest, BeyondTheStabilityLimitItGrows) {
  SceneBuilder b;
  const int first = b.chain(1, 1.0, 2.02 * kRate * kRate);
  b.scene.mats[at(first + 1)].position.x() = 1e-3;
  b.hear(first + 1);
  Player player(b.scene, {kRate, 14});
  player.ticks(10);
  EXPECT_GT(std::abs(player.heard[0].back()), 1e6);
}

}  // namespace
}  // namespace ergotic::physics
