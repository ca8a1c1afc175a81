// SPDX-License-Identifier: BSD-3-Clause
// Gamepads that come and go, as pipes in a folder of the test.
#include "gamepads/gamepad_watch.hpp"

#include <mutex>
#include <system_error>

#include <linux/input-event-codes.h>

#include "gamepads/pad_folder.hpp"
#include "support/period_probe.hpp"
#include "support/test.hpp"

namespace ergotic::gamepads {
namespace {

using test::eventually;
using test::PadFolder;
using test::PipePad;

class GamepadWatchTest : public ::testing::Test {
 protected:
  GamepadWatchTest() {
    watch_ = std::make_unique<GamepadWatch>(
        GamepadListener{[this](int pad, const tgr::GamepadMove& move) {
                          note(std::to_string(pad) + (move.is_button ? " button " : " axis ") +
                               std::to_string(move.number) + " " +
                               std::to_string(std::lround(100.0 * move.value)));
                        },
                        [this](int pad) { note(std::to_string(pad) + " is unplugged"); },
                        [this](const std::string& news) { note(news); },
                        [this](const std::string& why) { note("refused: " + why); }},
        [this](const std::string& path) { return open(path); },
        GamepadPlaces{folder_.devices(), folder_.classes()}, 20'000'000);
  }
  ~GamepadWatchTest() override { watch_.reset(); }

  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    heard_.push_back(what);
  }
  std::vector<std::string> heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  bool isHeard(const std::string& what, int times = 1) {
    const auto all = heard();
    return std::count(all.begin(), all.end(), what) == times;
  }
  std::unique_ptr<PadDevice> open(const std::string& path) {
    if (const int error = refuses_; error != 0) {
      throw std::system_error(error, std::generic_category());
    }
    ++opened_;
    return std::make_unique<PipePad>(path);
  }

  int plug(const std::string& event, const char* keys = PadFolder::kPadKeys) {
    return folder_.plug(event, keys);
  }
  void unplug(const std::string& event, int pipe) { folder_.unplug(event, pipe); }
  static void send(int pipe, int type, int code, int value) {
    EXPECT_TRUE(PadFolder::send(pipe, type, code, value));
  }

  PadFolder folder_;
  std::atomic<int> refuses_{0};
  std::atomic<int> opened_{0};
  std::mutex mutex_;
  std::vector<std::string> heard_;
  std::unique_ptr<GamepadWatch> watch_;
};

TEST_F(GamepadWatchTest, AGamepadPlaysWheneverItIsPlugged) {
  for (int life = 1; life <= 2; ++life) {
    const int pipe = plug("event3");
    ASSERT_TRUE(eventually([&] { return isHeard("the gamepad piped pad plays", life); }));
    send(pipe, EV_KEY, BTN_EAST, 1);
    send(pipe, EV_ABS, ABS_X, -100);
    EXPECT_TRUE(eventually([&] { return isHeard("0 button 1 100", life); }));
    EXPECT_TRUE(eventually([&] { return isHeard("0 axis 0 -100", life); }));
    unplug("event3", pipe);
    EXPECT_TRUE(eventually([&] { return isHeard("0 is unplugged", life); }));
    EXPECT_TRUE(eventually(
        [&] { return isHeard("the gamepad piped pad is gone, and lets go of everything", life); }));
  }
}

TEST_F(GamepadWatchTest, TwoGamepadsAreToldApartAndNumbersAreGivenAgain) {
  const int first = plug("event3");
  ASSERT_TRUE(eventually([&] { return opened_ == 1; }));
  const int second = plug("event4");
  ASSERT_TRUE(eventually([&] { return opened_ == 2; }));
  send(second, EV_KEY, BTN_SOUTH, 1);
  EXPECT_TRUE(eventually([&] { return isHeard("1 button 0 100"); }));
  unplug("event3", first);
  EXPECT_TRUE(eventually([&] { return isHeard("0 is unplugged"); }));
  send(second, EV_KEY, BTN_SOUTH, 0);
  EXPECT_TRUE(eventually([&] { return isHeard("1 button 0 0"); }));
  const int third = plug("event9");
  ASSERT_TRUE(eventually([&] { return opened_ == 3; }));
  send(third, EV_KEY, BTN_SOUTH, 1);
  EXPECT_TRUE(eventually([&] { return isHeard("0 button 0 100"); }));
  unplug("event4", second);
  unplug("event9", third);
}

TEST_F(GamepadWatchTest, WhatIsNoGamepadIsNotOpened) {
  const int mouse = plug("event0", PadFolder::kMouseKeys);
  const int pad = plug("event1");
  ASSERT_TRUE(eventually([&] { return opened_ == 1; }));
  EXPECT_TRUE(isHeard("the gamepad piped pad plays"));
  unplug("event0", mouse);
  unplug("event1", pad);
}

TEST_F(GamepadWatchTest, ARefusalIsToldOnceAndTheGamepadPlaysWhenItMay) {
  refuses_ = EACCES;
  const int pipe = plug("event3");
  const auto is_refusal = [](const std::string& news) {
    return news.find("refused: the gamepad pad of event3 does not play: ") == 0 &&
           news.find("Permission denied; add yourself to the group `input`") != std::string::npos;
  };
  const auto refusals = [&] {
    const auto all = heard();
    return std::count_if(all.begin(), all.end(), is_refusal);
  };
  ASSERT_TRUE(eventually([&] { return refusals() == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // for ten more looks
  EXPECT_EQ(refusals(), 1);
  refuses_ = 0;
  EXPECT_TRUE(eventually([&] { return isHeard("the gamepad piped pad plays"); }));
  unplug("event3", pipe);
}

TEST_F(GamepadWatchTest, ItEndsAtOnceWhileAGamepadIsThere) {
  const int pipe = plug("event3");
  ASSERT_TRUE(eventually([&] { return opened_ == 1; }));
  watch_.reset();
  unplug("event3", pipe);
}

TEST(GamepadPlacesTest, AMachineWithoutDevicesHasNoGamepads) {
  std::atomic<int> opened{0};
  const auto open = [&](const std::string& path) {
    ++opened;
    return openByEvdev(path);
  };
  const GamepadWatch watch(GamepadListener{}, open, {"/nowhere", "/nowhere"}, 1'000'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(opened, 0);
}

}  // namespace
}  // namespace ergotic::gamepads
