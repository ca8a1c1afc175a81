// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/tgr/rig.hpp"
#include "tgr/rig_scenes.hpp"

namespace ergotic::tgr {
namespace {

using test::endEffector;
using test::endEffectors;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kDamping = 2.0;
constexpr double kRate = 3000.0;

TEST(RenderedStiffnessTest, IsThatOfThePortsWhereASliceMovesThemByItself) {
  test::PortScene ports;
  ports.port("a", 3).position_scale = 0.1;  // in the stiffness already
  ports.port("b", 3);
  ports.port("free");
  const auto rendered =
      renderedStiffness(ports.scene, {}, {100.0, 20.0, 7.0}, kDamping, kRate, 1.0);
  ASSERT_EQ(rendered.size(), 1U);
  EXPECT_EQ(rendered[0].slice, 3);
  EXPECT_DOUBLE_EQ(rendered[0].stiffness, 120.0);
  EXPECT_DOUBLE_EQ(rendered[0].together, 120.0);
  EXPECT_DOUBLE_EQ(rendered[0].limit, 4000.0);  // 2 * 2 / (3 / 3000)
}

TEST(TakenPortsTest, AreThoseWhosePortOrSliceAnEndEffectorHas) {
  test::PortScene ports;
  ports.port("own", 0);
  ports.port("claimed", 1);
  ports.port("robbed", 2);
  ports.port("free");
  const EndEffectorConfig key = endEffector(EndEffectorType::kKey, {2}, {"claimed"});
  EXPECT_THAT(takenPorts(ports.scene, {}), IsEmpty());
  EXPECT_THAT(takenPorts(ports.scene, endEffectors({key})), ElementsAre(1, 2));
}

TEST(RenderedStiffnessTest, GrowsWithTheSquareOfALever) {
  test::PortScene ports;
  ports.port("key");
  EndEffectorConfig key = endEffector(EndEffectorType::kKey, {2}, {"key"});
  key.lever = 3.0;
  key.position_scale = 0.5;
  key.force_scale = 4.0;
  const auto rendered =
      renderedStiffness(ports.scene, endEffectors({key}), {10.0}, kDamping, kRate, 0.0);
  ASSERT_EQ(rendered.size(), 1U);
  EXPECT_DOUBLE_EQ(rendered[0].stiffness, 9.0 * 10.0 * 4.0 / 0.5);
  EXPECT_DOUBLE_EQ(rendered[0].limit, 12000.0);
}

TEST(RenderedStiffnessTest, CountsSlicesThatPushTogether) {
  test::PortScene ports;
  ports.port("along");
  ports.port("pressure");
  EndEffectorConfig bow = endEffector(EndEffectorType::kBow, {0, 1}, {"along", "pressure"});
  bow.angle = 0.78539816339744830962;  // each slice feels half of both, together they feel one
  const auto rendered =
      renderedStiffness(ports.scene, endEffectors({bow}), {1000.0, 200.0}, kDamping, kRate, 1.0);
  ASSERT_EQ(rendered.size(), 2U);
  for (const RenderedStiffness& slice : rendered) {
    EXPECT_NEAR(slice.stiffness, 600.0, 1e-9);
    EXPECT_NEAR(slice.together, 1000.0, 1e-9);
  }
}

TEST(RenderedStiffnessTest, IsAThirdOfAPushOnABallForEachOfItsSlices) {
  test::PortScene ports;
  ports.port("z");
  const auto rendered = renderedStiffness(
      ports.scene, endEffectors({endEffector(EndEffectorType::kBall, {5, 6, 7}, {"", "", "z"})}),
      {900.0}, kDamping, kRate, 1.0);
  ASSERT_EQ(rendered.size(), 3U);
  for (const RenderedStiffness& slice : rendered) {
    EXPECT_NEAR(slice.stiffness, 100.0, 1e-10);
    EXPECT_NEAR(slice.together, 300.0, 1e-10);
  }
}

TEST(RenderedStiffnessTest, IsJudgedByTheLimitWithThePlace) {
  test::PortScene ports;
  ports.port("key");
  const EndEffectors hands = endEffectors({endEffector(EndEffectorType::kKey, {0}, {"key"})});
  const auto judged = [&](double times_limit) {
    return judgeStiffness(
        hands, renderedStiffness(ports.scene, hands, {4000.0 * times_limit}, kDamping, kRate, 1.0));
  };
  EXPECT_THAT(judged(0.49).warnings, IsEmpty());
  EXPECT_THAT(judged(0.51).warnings,
              ElementsAre("hands.yaml:4:2: warning: end-effector 'key' renders up to 2040 N/m at "
                          "its slices, which are passive up to 4000 N/m. Lower its force_scale, "
                          "raise its position_scale, or raise the gestural rate"));
  EXPECT_THAT(judged(1.99).refusals, IsEmpty());
  EXPECT_THAT(judged(2.01).warnings, IsEmpty());
  EXPECT_THAT(judged(2.01).refusals,
              ElementsAre("hands.yaml:4:2: error: end-effector 'key' renders up to 8040 N/m at "
                          "its slices, which are passive up to 4000 N/m: it will buzz or jump. "
                          "Lower its force_scale, raise its position_scale, or raise the gestural "
                          "rate"));
}

}  // namespace
}  // namespace ergotic::tgr
