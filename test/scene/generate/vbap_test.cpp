// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/vbap.hpp"

#include <cmath>
#include <random>

#include "constants.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

std::vector<Eigen::Vector3d> ring(int count, double elevation) {
  std::vector<Eigen::Vector3d> speakers;
  for (int i = 0; i < count; ++i) {
    speakers.push_back(directionOf(2.0 * M_PI * i / count, elevation));
  }
  return speakers;
}

std::vector<Eigen::Vector3d> dome() {
  std::vector<Eigen::Vector3d> speakers = ring(12, 0.0);
  for (const auto& [count, elevation] : {std::pair{8, 35 * kDegree}, std::pair{4, 70 * kDegree}}) {
    const std::vector<Eigen::Vector3d> more = ring(count, elevation);
    speakers.insert(speakers.end(), more.begin(), more.end());
  }
  return speakers;
}

/// Power 1, none below 0, at most `most` speakers, and the vector is the one asked for.
void expectHeardFrom(const std::vector<Eigen::Vector3d>& speakers,
                     const Eigen::Vector3d& direction,
                     int most) {
  const auto gains = Panner(speakers).gains(direction);
  ASSERT_TRUE(gains) << direction.transpose();
  double power = 0.0;
  int used = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < speakers.size(); ++i) {
    EXPECT_GE((*gains)[i], 0.0);
    used += (*gains)[i] > 0.0 ? 1 : 0;
    power += (*gains)[i] * (*gains)[i];
    sum += (*gains)[i] * speakers[i];
  }
  EXPECT_NEAR(power, 1.0, 1e-12);
  EXPECT_LE(used, most);
  EXPECT_LT((sum.normalized() - direction.normalized()).norm(), 1e-9) << direction.transpose();
}

TEST(VbapTest, ASpeakerInTheDirectionIsAlone) {
  for (const std::vector<Eigen::Vector3d>& speakers :
       {ring(8, 0.0), dome(), std::vector{directionOf(0.5, 0), directionOf(-0.5, 0)}}) {
    const Panner panner(speakers);
    for (std::size_t s = 0; s < speakers.size(); ++s) {
      const auto gains = panner.gains(speakers[s]);
      ASSERT_TRUE(gains);
      for (std::size_t i = 0; i < speakers.size(); ++i) {
        EXPECT_NEAR((*gains)[i], i == s ? 1.0 : 0.0, 1e-12) << s << " " << i;
      }
    }
  }
}

TEST(VbapTest, ThePowerIsOneAndTheVectorThatAskedFor) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> azimuth(-M_PI, M_PI);
  std::uniform_real_distribution<double> height(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    expectHeardFrom(ring(8, 0.0), directionOf(azimuth(random), 0.0), 2);
    expectHeardFrom(dome(), directionOf(azimuth(random), std::asin(height(random))), 3);
  }
  expectHeardFrom(dome(), {0.0, 0.0, 1.0}, 3);
}

/// tan(phi)/tan(phi_0) = (g_1 - g_2)/(g_1 + g_2): the law of tangents, to which two speakers come.
TEST(VbapTest, TwoSpeakersFollowTheLawOfTangents) {
  const double half = 30 * kDegree;
  const Panner panner({directionOf(half, 0.0), directionOf(-half, 0.0)});
  for (const double angle : {-0.5, -0.2, 0.0, 0.1, 0.45}) {
    const auto gains = panner.gains(directionOf(angle, 0.0));
    ASSERT_TRUE(gains);
    EXPECT_NEAR(((*gains)[0] - (*gains)[1]) / ((*gains)[0] + (*gains)[1]),
                std::tan(angle) / std::tan(half), 1e-12);
  }
}

TEST(VbapTest, NothingIsHeardFromWhereNoSpeakersAre) {
  const Panner pair({directionOf(0.5, 0.0), directionOf(-0.5, 0.0)});
  EXPECT_FALSE(pair.gains(directionOf(0.6, 0.0)));
  EXPECT_FALSE(pair.gains(directionOf(M_PI, 0.0)));
  EXPECT_FALSE(pair.gains(directionOf(0.0, 0.1)));
  EXPECT_FALSE(Panner(dome()).gains(directionOf(0.3, -0.2)));
}

}  // namespace
}  // namespace ergotic::scene
