// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <filesystem>
#include <future>
#include <random>

#include <ergotic/Calibrate.h>
#include <ergotic/ConfigureEndEffectors.h>
#include <ergotic/EndEffectors.h>
#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/HandTargets.h>
#include <ergotic/InjectFault.h>
#include <ergotic/LoadModel.h>
#include <ergotic/Status.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include "integration/hands_scenes.hpp"
#include "integration/station_services.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

class HandsTest : public ::testing::Test {
 protected:
  struct World {
    World() {
      node.setParam("/station/model", kModel);
      node.setParam("/station/device", kDevices);
      node.setParam("/station/jack", "none");
      node.setParam("/station/ramp", 0.1);
      node.setParam("/station/max_load", 100.0);  // what takes long to load need not play
      allowStalls(node);
      station = startStation();
    }

    ::ros::NodeHandle node;
    Listener<Status> status{node, "/station/status"};
    Listener<Event> events{node, "/station/events"};
    Listener<GestureBlock> gesture{node, "/station/gesture"};
    Listener<sensor_msgs::JointState> joints{node, "/station/joint_states"};
    Listener<tf2_msgs::TFMessage> frames{node, "/tf"};
    Listener<visualization_msgs::MarkerArray> markers{node, "/station/markers"};
    ::ros::Publisher hand = node.advertise<HandTargets>("/station/hand_targets", 10);
    ::ros::Publisher end_effectors = node.advertise<EndEffectors>("/station/end_effectors", 1);
    std::unique_ptr<ChildProcess> station;
  };

  void SetUp() override {
    if (world_ == nullptr) {
      world_ = std::make_unique<World>();
    }
    ASSERT_TRUE(eventually([] { return world_->status.latest().model == "two hands"; }))
        << world_->status.latest().message;
    ASSERT_TRUE(eventually([] { return world_->hand.getNumSubscribers() > 0; }));
  }
  static void TearDownTestSuite() { world_.reset(); }

  static bool stateBecomes(std::uint8_t state) {
    return eventually([state] { return world_->status.latest().state == state; });
  }
  static Calibrate::Response calibrate(const Calibrate::Request& request) {
    Calibrate calibrate;
    calibrate.request = request;
    EXPECT_TRUE(::ros::service::call("/station/calibrate", calibrate));
    return calibrate.response;
  }
  static Calibrate::Response calibrate(std::uint8_t action, std::uint32_t slice = 0) {
    Calibrate::Request request;
    request.action = action;
    request.slice = slice;
    return calibrate(request);
  }
  static Calibrate::Response sampleAt(double position) {
    Calibrate::Request request;
    request.action = Calibrate::Request::SAMPLE;
    request.position = position;
    return calibrate(request);
  }
  static void moveHand(std::uint32_t slice, double target) {
    test::moveHand(world_->hand, slice, target);
  }
  static ConfigureEndEffectors::Response configure(const std::vector<EndEffector>& list) {
    ConfigureEndEffectors configure;
    configure.request.end_effectors = list;
    EXPECT_TRUE(::ros::service::call("/station/configure_end_effectors", configure));
    return configure.response;
  }
  static EndEffector bow() {
    EndEffector bow;
    bow.name = "bow";
    bow.type = EndEffector::BOW;
    bow.slices = {2, 3};
    bow.ports = {"right", "press"};
    bow.pose.position.y = 0.1;
    return bow;
  }
  void calibrateSlice(std::uint32_t slice, const std::string& file);

  static std::unique_ptr<World> world_;
};
std::unique_ptr<HandsTest::World> HandsTest::world_;

TEST_F(HandsTest, ShowsAllDevicesAndWhichSlicesAreNotCalibrated) {
  ASSERT_TRUE(stateBecomes(Status::UNCALIBRATED));
  const Status status = world_->status.latest();
  EXPECT_EQ(status.devices, (std::vector<std::string>{"virtual", "virtual"}));
  EXPECT_EQ(status.slices, 5U);
  EXPECT_EQ(status.uncalibrated, (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(HandsTest, DoesNotEngageASliceThatIsNotCalibrated) {
  const auto refused = call("engage");
  EXPECT_FALSE(refused.success);
  EXPECT_THAT(refused.message, HasSubstr("calibrate"));
}

TEST_F(HandsTest, InjectsNoFaultsUnlessItMay) {
  InjectFault inject;
  inject.request.kind = "frozen";
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", inject));
  EXPECT_FALSE(inject.response.success);
  EXPECT_THAT(inject.response.message, HasSubstr("allow_fault_injection"));
}

TEST_F(HandsTest, RefusesStepsOfACalibrationThatDoNotFollow) {
  EXPECT_FALSE(sampleAt(0.0).success) << "nothing was begun";
  EXPECT_FALSE(calibrate(Calibrate::Request::BEGIN, 4).success) << "it speaks metres";
  EXPECT_FALSE(calibrate(Calibrate::Request::BEGIN, 5).success) << "it does not exist";
  ASSERT_TRUE(calibrate(Calibrate::Request::BEGIN, 0).success);
  EXPECT_FALSE(calibrate(Calibrate::Request::BEGIN, 1).success) << "one at a time";
  EXPECT_FALSE(sampleAt(NAN).success);
  EXPECT_FALSE(calibrate(Calibrate::Request::FINISH).success) << "no sample yet";
  ASSERT_TRUE(calibrate(Calibrate::Request::ABORT).success);
  EXPECT_FALSE(calibrate(Calibrate::Request::FINISH).success) << "nothing was begun";
}

/// The operator pushes the slice to known places.
void HandsTest::calibrateSlice(std::uint32_t slice, const std::string& file) {
  ASSERT_TRUE(calibrate(Calibrate::Request::BEGIN, slice).success);
  for (const double place : {-0.02, 0.0, 0.02}) {
    moveHand(slice, place);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    const auto sample = sampleAt(place);
    ASSERT_TRUE(sample.success) << sample.message;
    EXPECT_NEAR(sample.volts, kRestVolts + place / kMetresPerVolt, 0.15);
  }
  Calibrate::Request finish;
  finish.action = Calibrate::Request::FINISH;
  finish.max_residual = 0.001;  // dry friction keeps a hand from its place
  finish.file = file;
  const auto fitted = calibrate(finish);
  ASSERT_TRUE(fitted.success) << fitted.message;
  EXPECT_NEAR(fitted.gain, kMetresPerVolt, 0.02 * std::abs(kMetresPerVolt));
  EXPECT_NEAR(fitted.rest, kRestVolts, 0.1);
  EXPECT_LT(fitted.residual, 0.001);
  moveHand(slice, 0.0);
}

TEST_F(HandsTest, IsGuidedThroughACalibrationThatTakesEffectAndIsWritten) {
  const std::string name = "ergotic_hands_" + std::to_string(getpid()) + ".yaml";
  const char* const ros_home = std::getenv("ROS_HOME");
  const auto file =
      std::filesystem::path(ros_home != nullptr ? ros_home
                                                : std::string(std::getenv("HOME")) + "/.ros") /
      "ergotic" / name;
  calibrateSlice(1, "");
  if (HasFatalFailure()) {
    return;
  }
  EXPECT_TRUE(eventually(
      [] { return world_->status.latest().uncalibrated == std::vector<std::uint32_t>{0}; }));
  calibrateSlice(0, name);
  if (HasFatalFailure()) {
    return;
  }
  EXPECT_TRUE(eventually([] { return world_->status.latest().uncalibrated.empty(); }));
  EXPECT_TRUE(stateBecomes(Status::READY));
  EXPECT_THAT(textOf(file), HasSubstr("metres_per_volt: -0.00"));
  std::filesystem::remove(file);
}

TEST_F(HandsTest, EngagesWhenEachCalibratedSliceHasAnsweredAPush) {
  ASSERT_TRUE(stateBecomes(Status::READY));
  EXPECT_THAT(call("engage").message, HasSubstr("slice 0 was not checked"));
  EXPECT_THAT(calibrate(Calibrate::Request::CHECK, 2).message, HasSubstr("speaks metres"));
  ASSERT_TRUE(call("emergency_stop").success);
  EXPECT_THAT(calibrate(Calibrate::Request::CHECK, 0).message, HasSubstr("recover first"));
  ASSERT_TRUE(eventually([] { return call("recover").success != 0U; }));

  std::this_thread::sleep_for(std::chrono::milliseconds(700));  // until the hand is at rest
  const auto first = calibrate(Calibrate::Request::CHECK, 0);
  EXPECT_TRUE(first.success) << first.message;
  EXPECT_THAT(call("engage").message, HasSubstr("slice 1 was not checked"));
  auto ended =
      std::async(std::launch::async, [] { return calibrate(Calibrate::Request::CHECK, 1); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ASSERT_TRUE(call("stop").success);
  EXPECT_THAT(ended.get().message, HasSubstr("force was taken away"));
  const auto second = calibrate(Calibrate::Request::CHECK, 1);
  EXPECT_TRUE(second.success) << second.message;
  ASSERT_TRUE(call("engage").success);
  EXPECT_THAT(calibrate(Calibrate::Request::CHECK, 0).message, HasSubstr("stop first"));
  ASSERT_TRUE(call("stop").success);
}

TEST_F(HandsTest, LetsOneHandFeelTheOtherThroughTheModel) {
  // The ports still glide to where the hands are.
  ASSERT_TRUE(eventually([this] { return call("engage").success; }));
  ASSERT_TRUE(stateBecomes(Status::PLAYING));
  moveHand(2, 0.015);
  EXPECT_TRUE(eventually([] {
    const auto joints = world_->joints.latest();
    return joints.effort.size() == 5 && joints.effort[0] > 0.5 && joints.effort[2] < -0.5;
  }));
  EXPECT_TRUE(eventually([] { return world_->joints.latest().position[0] > 0.001; }));
  moveHand(2, 0.0);
}

// So soon after `engage` that no state has told of it.
TEST_F(HandsTest, TakesAwayAForceThatWasJustAskedForToCalibrate) {
  ASSERT_TRUE(call("stop").success);
  ASSERT_TRUE(stateBecomes(Status::READY));
  const std::size_t before = world_->events.count();
  ASSERT_TRUE(call("engage").success);
  const auto begun = calibrate(Calibrate::Request::BEGIN, 0);
  if (begun.success) {
    EXPECT_TRUE(eventually([before] {
      const auto events = world_->events.messages();
      return std::any_of(events.begin() + static_cast<std::ptrdiff_t>(before), events.end(),
                         [](const Event& event) { return event.type == Event::STOPPED; });
    }));
    EXPECT_TRUE(stateBecomes(Status::READY));
    EXPECT_FALSE(call("engage").success) << "a slice is being calibrated";
    EXPECT_TRUE(calibrate(Calibrate::Request::ABORT).success);
  } else {
    EXPECT_THAT(begun.message, HasSubstr("stop first"));
    EXPECT_TRUE(call("stop").success);
  }
}

// So soon after `stop` that no state has told of it.
TEST_F(HandsTest, CalibratesRightAfterAnAnsweredStop) {
  constexpr int kTimes = 20;
  for (int i = 0; i < kTimes; ++i) {
    ASSERT_TRUE(call("engage").success);
    ASSERT_TRUE(stateBecomes(Status::PLAYING));
    ASSERT_TRUE(call("stop").success);
    const auto begun = calibrate(Calibrate::Request::BEGIN, 0);
    ASSERT_TRUE(begun.success) << begun.message;
    ASSERT_TRUE(calibrate(Calibrate::Request::ABORT).success);
  }
}

TEST_F(HandsTest, PutsOtherEndEffectorsInPlaceWithForceAtZero) {
  const auto answer = configure({bow()});
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(stateBecomes(Status::READY));
  ASSERT_TRUE(eventually([] { return world_->status.latest().end_effectors.size() == 1; }));
  EXPECT_EQ(world_->status.latest().end_effectors.front().name, "bow");
  EXPECT_TRUE(eventually([] {
    const auto seen = world_->frames.messages();
    return std::any_of(seen.begin(), seen.end(), [](const tf2_msgs::TFMessage& message) {
      return message.transforms.front().child_frame_id == "bow" &&
             message.transforms.front().header.frame_id == "tgr_base";
    });
  }));
  EXPECT_TRUE(eventually([] {
    const auto seen = world_->markers.messages();
    return std::any_of(seen.begin(), seen.end(), [](const auto& array) {
      return !array.markers.empty() && array.markers.front().header.frame_id == "bow";
    });
  }));
  EXPECT_TRUE(eventually([] { return call("engage").success != 0U; }));
}

TEST_F(HandsTest, KeepsItsEndEffectorsWhenOthersAreWrong) {
  EndEffector wrong = bow();
  wrong.name = "wrong";
  wrong.ports = {"right", "nowhere"};
  const auto answer = configure({wrong});
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.message, HasSubstr(": error: "));
  EXPECT_THAT(answer.message, HasSubstr("nowhere"));
  wrong = bow();
  wrong.type = 77;
  EXPECT_FALSE(configure({wrong}).success);
  wrong = bow();
  wrong.lever = NAN;
  EXPECT_FALSE(configure({wrong}).success);
  EXPECT_EQ(world_->status.latest().end_effectors.front().name, "bow");
  EXPECT_TRUE(stateBecomes(Status::PLAYING)) << "force stays as it was";
}

TEST_F(HandsTest, TakesEndEffectorsFromATopicToo) {
  ASSERT_TRUE(eventually([] { return world_->end_effectors.getNumSubscribers() > 0; }));
  EndEffectors other;
  other.end_effectors = {bow()};
  other.end_effectors.front().name = "other_bow";
  other.end_effectors.front().angle = 0.3;
  world_->end_effectors.publish(other);
  EXPECT_TRUE(
      eventually([] { return world_->status.latest().end_effectors.front().name == "other_bow"; }));
}

// 6 times the link between the hands, of which each feels twice, is well; 6 times the wall is not.
TEST_F(HandsTest, JudgesAModelWithTheEndEffectorsThatCameWhileItWasLoaded) {
  LoadModel load;
  load.request.model = kWalled;
  auto loading = std::async(std::launch::async,
                            [&load] { return ::ros::service::call("/station/load_model", load); });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EndEffector key;
  key.name = "key";
  key.type = EndEffector::KEY;
  key.slices = {2};
  key.ports = {"right"};
  key.force_scale = 6.0;
  const auto configured = configure({key});
  EXPECT_TRUE(configured.success) << configured.message;
  ASSERT_TRUE(loading.get());
  EXPECT_FALSE(load.response.success);
  EXPECT_THAT(load.response.message, HasSubstr("'key' renders up to 9000 N/m"));
  EXPECT_EQ(world_->status.latest().model, "two hands");
  ASSERT_TRUE(configure({bow()}).success);
  EXPECT_TRUE(eventually([] { return call("engage").success != 0U; }));
}

// The rest of the thousand is played without ROS, by the tests of the station.
TEST_F(HandsTest, StaysCalmWhileItIsConfiguredAtRandom) {
  constexpr int kTimes = 40;
  constexpr double kSlewNPerS = 5000.0;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.5, 2.0);
  const std::int64_t before = world_->status.latest().ticks;
  for (int i = 0; i < kTimes; ++i) {
    EndEffector next = bow();
    next.lever = uniform(random);
    next.angle = uniform(random) - 1.0;
    next.position_scale = uniform(random) + 0.5;
    std::shuffle(next.slices.begin(), next.slices.end(), random);
    moveHand(2, 0.01 * uniform(random));
    const auto answer = i % 5 == 4 ? configure({}) : configure({next});
    ASSERT_TRUE(answer.success) << answer.message;
    ASSERT_TRUE(eventually([] { return call("engage").success != 0U; }));
  }
  ASSERT_TRUE(stateBecomes(Status::PLAYING));
  EXPECT_GT(world_->status.latest().ticks, before);

  const auto blocks = world_->gesture.messages();
  const double most = kSlewNPerS / blocks.front().tick_rate_hz + 1e-4;
  std::vector<float> last(blocks.front().slices, 0.0F);
  for (const GestureBlock& block : blocks) {
    for (std::size_t i = 0; i < block.forces.size(); ++i) {
      const auto slice = i % block.slices;
      ASSERT_LE(std::abs(block.forces[i]) - std::abs(last[slice]), most)
          << "slice " << slice << " in the block of tick " << block.first_tick;
      last[slice] = block.forces[i];
    }
  }
}

}  // namespace
}  // namespace ergotic::test
