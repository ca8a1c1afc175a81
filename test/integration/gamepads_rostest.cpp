// SPDX-License-Identifier: BSD-3-Clause
// A station whose gamepad is a pipe (test/piped_pads).
#include <ergotic/Parameters.h>
#include <ergotic/PlayMap.h>
#include <ergotic/Status.h>
#include <linux/input-event-codes.h>
#include <ros/ros.h>

#include "gamepads/pad_folder.hpp"
#include "integration/gesture_record.hpp"
#include "integration/station_services.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

const char kTwoKeys[] = R"(ergotic: 1
name: two keys
parameters:
  firmness: {value: 100, range: [50, 200]}
sections:
  keys: {rate: gestural}
mats:
  'key_{k}': {for: {k: 0..1}, type: slice, section: keys}
  ground: {type: ground, section: keys}
lias:
  'spring_{k}': {for: {k: 0..1}, type: spring_damper, between: ['key_{k}', ground], stiffness: $firmness, damping: 1}
ports:
  'key_{k}': {for: {k: 0..1}, mat: 'key_{k}', slice: =k}
)";

class GamepadsTest : public ::testing::Test {
 protected:
  GamepadsTest() {
    node_.setParam("/station/model", kTwoKeys);
    node_.setParam("/station/jack", "none");
    allowStalls(node_);
    station_ = startStation({{"LD_PRELOAD", PIPED_PADS}, {"ERGOTIC_PADS", folder_.devices()}});
  }
  void SetUp() override {
    ASSERT_TRUE(eventually([this] { return status_.latest().model == "two keys"; }))
        << status_.latest().message;
    ASSERT_TRUE(eventually([this] { return gesture_.count() > 0; }));
  }
  bool isAt(std::size_t slice, double low, double high) const {
    return eventually([&] {
      const double now = gesture_.from(gesture_.newest()).back().positions[slice];
      return now > low && now < high;
    });
  }

  PadFolder folder_;
  ::ros::NodeHandle node_;
  Listener<Status> status_{node_, "/station/status"};
  Listener<Parameters> parameters_{node_, "/station/model_parameters"};
  GestureRecord gesture_{node_};
  std::unique_ptr<ChildProcess> station_;
};

TEST_F(GamepadsTest, ItPlaysWhatIsUsualOrWhatTheMapSaysAndLetsGoWhenItIsUnplugged) {
  int pad = folder_.plug("event5");
  ASSERT_TRUE(PadFolder::send(pad, EV_KEY, BTN_SOUTH, 1));
  EXPECT_TRUE(isAt(0, 0.015, 0.025)) << "the button is the first key";
  ASSERT_TRUE(PadFolder::send(pad, EV_ABS, ABS_X, -100));
  EXPECT_TRUE(isAt(1, -0.025, -0.015)) << "the stick moves the second hand";
  folder_.unplug("event5", pad);
  EXPECT_TRUE(isAt(0, -0.005, 0.005)) << "its note has ended";

  PlayMap map;
  map.request.map = "gamepad:\n  - {axis: left_y, parameter: firmness}\n";
  ASSERT_TRUE(::ros::service::call("/station/play_map", map));
  ASSERT_TRUE(map.response.success) << map.response.message;
  pad = folder_.plug("event6");
  ASSERT_TRUE(PadFolder::send(pad, EV_ABS, ABS_Y, -100));
  EXPECT_TRUE(eventually([this] {
    const Parameters latest = parameters_.latest();
    return latest.values.size() == 1 && latest.values[0] == 200.0;
  }));
  folder_.unplug("event6", pad);
}

}  // namespace
}  // namespace ergotic::test
