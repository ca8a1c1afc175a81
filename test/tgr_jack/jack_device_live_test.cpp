// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_device.hpp"

#include "support/realtime_scope.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::kJackPeriod;
using test::kJackRate;

/// One slice, with a block that the test fills and reads.
class Played {
 public:
  explicit Played(const JackDeviceConfig& config) : device(config) {
    device.audioStarted(kJackRate, kJackPeriod);
    block_.nframes = kJackPeriod;
    block_.inputs = inputs_;
    block_.outputs = outputs_;
    block_.input_channels = 2;
    block_.output_channels = 1;
  }
  void play(float force, float heartbeat = 0.0F) {
    std::fill_n(force_, kJackPeriod, force);
    std::fill_n(heartbeat_, kJackPeriod, heartbeat);
    device.process(block_);
    block_.start.frames += kJackPeriod;
  }
  /// Force of the newest record, -1 if there is none.
  double newest() {
    ForceRecord record;
    record.force_n = -1.0;
    while (device.pollForce(record)) {
    }
    return record.force_n;
  }

  JackDevice device;
  float position[kJackPeriod]{};

 private:
  float force_[kJackPeriod]{};
  float heartbeat_[kJackPeriod]{};
  const float* inputs_[2] = {force_, heartbeat_};
  float* outputs_[1] = {position};
  rt::Period block_;
};

TEST(JackDeviceTest, MovesAFreeMassByItsForceFrameByFrame) {
  JackDeviceConfig config = test::jackDevice(1);
  VirtualSliceConfig& slice = config.bank.slice;
  slice.damping = slice.hand_damping = slice.hand_stiffness = slice.hand_mass = 0.0;
  Played played(config);
  played.play(0.05F);
  for (std::size_t n = 0; n < kJackPeriod; ++n) {  // x = F t^2 / 2 m, exact for the midpoint rule
    const double t = static_cast<double>(n) / kJackRate;
    const double x = 0.5 * 0.05 * 200.0 / slice.mass * t * t;
    EXPECT_NEAR(static_cast<double>(played.position[n]) * 0.05, x, 1e-7 * x + 1e-18);
  }
}

TEST(JackDeviceTest, GivesPositionsAsLateAsItsConvertersAre) {
  JackDeviceConfig config = test::jackDevice(1);
  Played direct(config);
  config.latency_frames = 10;
  Played late(config);
  direct.play(0.1F);
  late.play(0.1F);
  for (std::size_t n = 0; n < kJackPeriod; ++n) {
    EXPECT_EQ(late.position[n], n < 10 ? 0.0F : direct.position[n - 10]) << n;
  }
  EXPECT_EQ(direct.device.declaredFrames(64), 64);
  EXPECT_EQ(late.device.declaredFrames(64), 74);
}

TEST(JackDeviceTest, FeelsWhateverComesWithoutAWatchdog) {
  Played played(test::jackDevice(1));
  for (int n = 0; n < 1000; ++n) {
    played.play(0.1F);
  }
  EXPECT_NEAR(played.newest(), 20.0, 1e-5);
  played.device.audioStopped();
  EXPECT_EQ(played.newest(), 0.0) << "no server, no force";
}

TEST(JackDeviceTest, FeelsNothingWhenTheHeartbeatStandsStill) {
  JackDeviceConfig config = test::jackDevice(1);
  config.watchdog_s = 0.010;  // 480 frames, seven blocks and a half
  Played played(config);
  played.play(0.1F, 0.0F);
  EXPECT_EQ(played.newest(), -1.0) << "no heartbeat yet";
  for (int n = 0; n < 20; ++n) {
    played.play(0.1F, n % 2 == 0 ? 0.5F : -0.5F);
  }
  EXPECT_NEAR(played.newest(), 20.0, 1e-5);
  for (int n = 0; n < 6; ++n) {
    played.play(0.1F, -0.5F);  // a block that is repeated, as by a stalled driver
  }
  EXPECT_EQ(played.newest(), -1.0);
  played.play(0.1F, -0.5F);
  EXPECT_EQ(played.newest(), 0.0);
}

TEST(JackDeviceTest, WritesEveryChangeOfForce) {
  Played played(test::jackDevice(1));
  played.play(0.25F);
  played.play(0.25F);
  played.play(0.5F);
  std::ostringstream log;
  drainForces(played.device, log);
  EXPECT_EQ(log.str(), "0,0,50\n0,0,100\n");
}

TEST(JackDeviceTest, RefusesNumbersOutOfRange) {
  const auto refuses = [](auto change) {
    JackDeviceConfig config = test::jackDevice(1);
    change(config);
    EXPECT_THROW(JackDevice{config}, Exception);
  };
  refuses([](JackDeviceConfig& c) { c.metres_per_unit = 0.0; });
  refuses([](JackDeviceConfig& c) { c.newtons_per_unit = 2000.0; });
  refuses([](JackDeviceConfig& c) { c.latency_frames = -1; });
  refuses([](JackDeviceConfig& c) { c.watchdog_s = 11.0; });
  refuses([](JackDeviceConfig& c) { c.bank.slices = 0; });
  refuses([](JackDeviceConfig& c) { c.bank.slice.volts.emplace(); });
  refuses([](JackDeviceConfig& c) { c.bank.extra_delay_ticks = 1; });
  const test::ScratchFile positions("tick,x0\n0,0.01\n");
  refuses([&](JackDeviceConfig& c) { c.bank.gesture_file = positions.path(); });
}

TEST(JackDeviceTest, PlaysABlockInRealTime) {
  Played played(test::jackDevice(1));
  test::expectRealtime([&] {
    for (int n = 0; n < 100; ++n) {
      played.play(static_cast<float>(n % 7) / 10.0F);
    }
  });
}

}  // namespace
}  // namespace ergotic::tgr
