// SPDX-License-Identifier: BSD-3-Clause
// A whole station whose ticks, positions and forces go through JACK.

#include "ergotic/station/device_source.hpp"
#include "ergotic/tgr/calibration.hpp"
#include "support/scratch_file.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using station::Command;
using station::Event;
using station::FaultReason;
using station::ForceState;
using test::eventually;

constexpr double kModelStiffness = 100.0;  // N/m
constexpr double kHandTarget = 0.01;       // m

class JackStationTest : public ::testing::Test {
 protected:
  JackStationTest() {
    server_.start();
    JackDeviceConfig config = test::jackDevice(1);
    config.bank.gesture_file = gesture_.path();
    config.watchdog_s = 0.05;
    device_.emplace(server_, config);
    auto raw = std::make_unique<JackDriver>(driverConfig());
    station::StationConfig station = test::Bench::quickConfig();
    station.rates = {48000.0, 16};
    test::SpringInstrument::Setting spring;
    spring.stiffness = kModelStiffness;
    spring.audio_hz = station.rates.audio_hz;
    spring.ratio = station.rates.ratio;
    station_ = std::make_unique<station::Station>(
        station, makeCalibratedDriver(std::move(raw), {{calibration(config)}}),
        test::makeSpring(spring));
    source_ = std::make_unique<station::DeviceSource>(*station_, nullptr);
    source_->start(false);
  }

  JackDriverConfig driverConfig() const {
    JackDriverConfig config = test::jackDriver(server_, 1);
    config.heartbeat_port = "device:heartbeat";
    config.volts_per_unit = 10.0;
    return config;
  }
  /// What a calibration of the virtual device would find.
  static SliceCalibration calibration(const JackDeviceConfig& device) {
    SliceCalibration slice;
    slice.is_calibrated = true;
    slice.metres_per_volt = device.metres_per_unit / 10.0;
    slice.volts_per_newton = 10.0 / device.newtons_per_unit;
    return slice;
  }

  void command(Command::Type type) {
    Command made;
    made.type = type;
    ASSERT_TRUE(station_->submit(made));
  }
  /// Newest state; drains what else the station tells.
  ForceState state() {
    Event event;
    while (station_->poll(event)) {
    }
    station::GestureTick tick;
    while (station_->pollGestures(&tick, 1) > 0) {
    }
    if (const station::Snapshot* snapshot = station_->snapshot()) {
      state_ = snapshot->state;
      fault_ = snapshot->fault;
      ticks_ = snapshot->counters.ticks;
    }
    return state_;
  }
  /// Force that the device feels.
  double felt() {
    ForceRecord record;
    while (device_->device.pollForce(record)) {
      felt_ = record.force_n;
    }
    return felt_;
  }

  test::JackServer server_{"station", test::serverSettings(48000, 64)};
  test::ScratchFile gesture_{"0,0," + std::to_string(kHandTarget) + "\n"};
  std::optional<test::JackDeviceClient> device_;
  std::unique_ptr<station::Station> station_;
  std::unique_ptr<station::DeviceSource> source_;
  ForceState state_ = ForceState::kDisconnected;
  FaultReason fault_ = FaultReason::kNone;
  std::int64_t ticks_ = 0;
  double felt_ = 0.0;
};

TEST_F(JackStationTest, PushesBackAsTheModelSaysAndNotWhenMadeSafe) {
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kReady; }));
  EXPECT_EQ(felt(), 0.0);
  command(Command::Type::kEngage);
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kPlaying; }));
  // The hand's spring against the model's.
  const double hand = VirtualSliceConfig{}.hand_stiffness;
  const double force = -kModelStiffness * kHandTarget * hand / (hand + kModelStiffness);
  EXPECT_TRUE(eventually([&] { return std::abs(felt() - force) < 0.01 * std::abs(force); }))
      << felt();
  station_->makeSafe();
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kFault && felt() == 0.0; }));
  EXPECT_EQ(fault_, FaultReason::kMadeSafe);
  source_->stop();
  EXPECT_EQ(felt(), 0.0);
}

TEST_F(JackStationTest, IsWithoutForceAfterAServerWasKilledUntilItIsRecovered) {
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kReady; }));
  command(Command::Type::kEngage);
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kPlaying && felt() < -0.5; }));
  server_.kill();
  ASSERT_TRUE(eventually([&] { return felt() == 0.0; }));
  const std::int64_t ticks = ticks_;
  server_.start();
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kFault && ticks_ > ticks + 1000; }));
  EXPECT_TRUE(fault_ == FaultReason::kStall || fault_ == FaultReason::kDeviceLost ||
              fault_ == FaultReason::kJump)
      << toString(fault_);
  station_->driver().reconnect();
  EXPECT_EQ(felt(), 0.0) << "a server alone brings no force back";
  command(Command::Type::kRecover);
  ASSERT_TRUE(eventually([&] { return state() == ForceState::kReady; }));
  command(Command::Type::kEngage);
  EXPECT_TRUE(eventually([&] { return state() == ForceState::kPlaying && felt() < -0.5; }));
}

}  // namespace
}  // namespace ergotic::tgr
