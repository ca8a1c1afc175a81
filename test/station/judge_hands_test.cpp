// SPDX-License-Identifier: BSD-3-Clause
// Which model may play with which end-effectors, and what becomes of those that may not.

#include "ergotic/station/judge_hands.hpp"

#include <algorithm>
#include <functional>
#include <memory>

#include "physics/interpolation.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"
#include "tgr/rig_scenes.hpp"
#include "tgr/wall_loop.hpp"

namespace ergotic::station {
namespace {

using physics::HandLevel;
using test::endEffector;
using test::endEffectors;
using tgr::EndEffectorType;

constexpr physics::Rates kHandRates{48000.0, 16};  // 3000 Hz
constexpr double kLimit = 4000.0;                  // 2 * 2 / (3 / 3000), N/m

/// A port in front of a wall, N/m and N s/m, on slice 0.
scene::Scene wall(double stiffness, double damping = 0.0) {
  test::SceneBuilder b;
  b.spring(b.slice(0), b.ground(0.0, test::SceneBuilder::kGestural), stiffness, damping);
  b.scene.file = "wall.yaml";
  return b.scene;
}

/// A key on slice 1 that moves the port.
tgr::EndEffectors key(double force_scale) {
  tgr::EndEffectorConfig config = endEffector(EndEffectorType::kKey, {1}, {"port0"});
  config.force_scale = force_scale;
  return endEffectors({config});
}

std::unique_ptr<Performer> performerOf(const scene::Scene& scene,
                                       const tgr::EndEffectors& end_effectors = {},
                                       bool allow_unproven = false) {
  PerformerPolicy policy;
  policy.end_effectors = end_effectors;
  policy.allow_unproven = allow_unproven;
  return makePerformer(scene, kHandRates, physics::Precision::kDouble, policy);
}

HandFindings judged(const scene::Scene& scene, const tgr::EndEffectors& end_effectors) {
  return judgeHands(scene, kHandRates, performerOf(scene, end_effectors)->certificate, {},
                    end_effectors);
}

std::string refusalOfHands(const Performer& performer, const tgr::EndEffectors& end_effectors) {
  return complaintOf([&] { fitHands(performer, end_effectors, 2, {}); });
}

TEST(JudgeHandsTest, StiffnessIsJudgedByTheLimitWithThePlace) {
  const auto with = [](double times_limit) { return judged(wall(kLimit * times_limit), key(1.0)); };
  EXPECT_THAT(with(0.49).warnings, IsEmpty());
  EXPECT_THAT(with(0.51).warnings,
              ElementsAre("hands.yaml:4:2: warning: end-effector 'key' renders up to 2040 N/m at "
                          "its slices, which are passive up to 4000 N/m. Lower its force_scale, "
                          "raise its position_scale, or raise the gestural rate"));
  EXPECT_THAT(with(1.99).refusals, IsEmpty());
  EXPECT_THAT(with(2.01).warnings, IsEmpty());
  EXPECT_THAT(with(2.01).refusals,
              ElementsAre("hands.yaml:4:2: error: end-effector 'key' renders up to 8040 N/m at "
                          "its slices, which are passive up to 4000 N/m: it will buzz or jump. "
                          "Lower its force_scale, raise its position_scale, or raise the gestural "
                          "rate"));
}

TEST(JudgeHandsTest, DampersCountThroughEndEffectorsToo) {
  const HandFindings soft = judged(wall(0.0, 500.0), key(0.5));
  EXPECT_THAT(soft.warnings, IsEmpty());
  EXPECT_DOUBLE_EQ(soft.slices.at(0).damping, 250.0);
  EXPECT_THAT(judged(wall(0.0, 500.0), key(10.0)).refusals,
              ElementsAre(HasSubstr("renders up to 5000 N s/m at its slices, which are passive up "
                                    "to 7")));
}

TEST(FitHandsTest, JudgesTheModelThatPlaysWithNewEndEffectors) {
  const auto performer = performerOf(wall(1000.0));
  EXPECT_NE(fitHands(*performer, key(1.0), 2, {}).rig, nullptr);
  EXPECT_THAT(fitHands(*performer, key(3.0), 2, {}).warnings,
              ElementsAre(HasSubstr("renders up to 3000 N/m")));
  EXPECT_THAT(refusalOfHands(*performer, key(100.0)), HasSubstr("renders up to 100000 N/m"));
}

TEST(FitHandsTest, JudgesANewModelWithEndEffectorsThatCameWhileItWasMade) {
  const auto performer = performerOf(wall(1000.0), key(1.0));
  const tgr::Rig* const before = performer->rig.get();
  EXPECT_THAT(complaintOf([&] { giveHands(*performer, key(100.0), 2, {}); }),
              HasSubstr("renders up to 100000 N/m"));
  EXPECT_EQ(performer->rig.get(), before);
  giveHands(*performer, key(3.0), 2, {});
  EXPECT_EQ(performer->rig->slicesInUse(), 2U);
  EXPECT_THAT(performer->warnings, Contains(HasSubstr("renders up to 3000 N/m")));
}

TEST(FitHandsTest, JudgesAPortThatAnEndEffectorLeavesToItsSlice) {
  const auto performer = performerOf(wall(20000.0, 3.0), key(0.01));
  EXPECT_EQ(performer->certificate.verdict, physics::Verdict::kPassive);
  EXPECT_THAT(refusalOfHands(*performer, {}),
              AllOf(HasSubstr("error: port 'port0': the hand may meet 2e+04 N/m"),
                    HasSubstr("it will buzz or jump")));
  EXPECT_THAT(refusalOfHands(*performerOf(wall(0.0, 5000.0), key(0.01)), {}),
              HasSubstr("meet 5000 N s/m"));
}

TEST(FitHandsTest, WhoeverAllowsWhatIsUnprovenIsWarned) {
  const auto performer = performerOf(wall(20000.0), {}, true);
  EXPECT_THAT(fitHands(*performer, {}, 2, {}).warnings, IsEmpty()) << "it was said at load";
  EXPECT_THAT(fitHands(*performer, key(1.0), 2, {}).warnings,
              ElementsAre(HasSubstr("it will buzz or jump")));
}

/// A spring and a damper, N/m and N s/m, that answer a slice `extra` ticks later than they must.
struct Loop {
  double stiffness = 0.0;
  double damping = 0.0;
  int extra = 0;
  bool interpolated = false;  // coupling: smooth
};

/// What answers the positions of a slice, tick by tick.
std::function<double(double, double)> answerOf(const Loop& loop) {
  if (!loop.interpolated) {
    return [loop](double x, double v) { return -loop.stiffness * x - loop.damping * v; };
  }
  const physics::InterpolationResponse answer = physics::interpolationResponse(kHandRates.ratio);
  const auto last = std::make_shared<std::vector<double>>(answer.spring.size());  // of all copies
  return [loop, answer, last](double x, double) {
    std::vector<double>& late = *last;
    std::rotate(late.begin(), late.end() - 1, late.end());
    late.front() = x;
    double force = 0.0;
    for (std::size_t i = 0; i < late.size(); ++i) {
      force -= (loop.stiffness * answer.spring[i] +
                loop.damping * kHandRates.gesturalHz() * answer.damper[i]) *
               late[i];
    }
    return force;
  };
}

/// Whether the virtual device comes to rest when its hand has been knocked a little, or is let go.
bool isStable(const Loop& loop, double hand_stiffness) {
  tgr::VirtualDriverConfig device = test::plainDevice();
  device.extra_delay_ticks = loop.extra;
  device.slice.hand_stiffness = hand_stiffness;
  test::WallLoop played(device, test::openChain(), 3000.0);
  const auto answer = answerOf(loop);
  played.engage();
  played.run(0.3, [](double, double) { return 0.0; });
  played.aimAt(1e-4);
  played.run(3.0 / 3000.0, answer);
  played.aimAt(0.0);
  const double early = played.peakSpeed(0.1, answer);
  played.run(0.3, answer);
  const double late = played.peakSpeed(0.1, answer);
  // What is set off soon swings between the limits of force.
  return late < early && late < 0.01 && played.chain().fault() == tgr::FaultReason::kNone;
}

/// Of the virtual device with its hand.
physics::HandLoop loopOf(int extra) {
  physics::DeviceTraits device;
  device.damping = 7.0;
  device.mass = 0.4;
  device.delay_ticks = 1.0 + extra;
  return {device, 1.0 / 3000.0, kHandRates.ratio};
}

TEST(PlayedLoopTest, OfAVirtualDeviceIsStableBelowTheLimitOfSpringsAndDampersTogether) {
  for (const int extra : {0, 1, 2}) {
    const physics::HandLoop loop = loopOf(extra);
    for (const double spring : {0.0, 0.3, 0.9}) {
      for (const double damper : {0.01, 0.1, 0.5, 0.9}) {
        const double stiffness = spring * loop.stiffnessLimit();
        const double damping = damper * loop.dampingLimit();
        const double share = loop.share(stiffness, damping) / 0.95;
        for (const double hand : {10.0, 500.0, 5000.0}) {
          EXPECT_TRUE(isStable({stiffness / share, damping / share, extra}, hand))
              << extra << ": " << stiffness / share << " N/m, " << damping / share << " N s/m, "
              << hand;
        }
      }
    }
  }
}

TEST(PlayedLoopTest, OfAVirtualDeviceThatIsSeenToGlideIsQuietBelowTheLimitAndTremblesAbove) {
  for (const int extra : {0, 1, 2}) {
    const physics::HandLoop loop = loopOf(extra);
    const double spring = loop.stiffnessLimit(1.0);
    const double damper = loop.dampingLimit(1.0);
    EXPECT_TRUE(isStable({0.9 * spring, 0.0, extra, true}, 10.0)) << extra << ": " << spring;
    EXPECT_FALSE(isStable({1.1 * spring, 0.0, extra, true}, 10.0)) << extra << ": " << spring;
    EXPECT_TRUE(isStable({0.0, 0.9 * damper, extra, true}, 500.0)) << extra << ": " << damper;
    EXPECT_FALSE(isStable({0.0, 1.2 * damper, extra, true}, 500.0)) << extra << ": " << damper;
  }
}

TEST(PlayedLoopTest, OfAVirtualDeviceIsSetOffByDampersAboveTheLimit) {
  for (const int extra : {0, 1, 2}) {
    const double limit = loopOf(extra).dampingLimit();
    EXPECT_FALSE(isStable({0.0, 1.1 * limit, extra}, 500.0)) << extra << ": " << limit;
    EXPECT_FALSE(isStable({0.3 * loopOf(extra).stiffnessLimit(), 1.2 * limit, extra}, 500.0));
  }
  for (const double damping : {1200.0, 2000.0, 5000.0}) {
    EXPECT_FALSE(isStable({0.0, damping, 0}, 500.0)) << damping;
  }
}

}  // namespace
}  // namespace ergotic::station
