// SPDX-License-Identifier: BSD-3-Clause

#include "tgr/drivers/jack/jack_driver.hpp"

#include <yaml-cpp/yaml.h>

#include <optional>
#include <thread>

#include "support/test.hpp"
#include "tgr/drivers/jack/jack_settings.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::eventually;
using test::JackServer;
using test::kJackRate;
using test::TickCounter;
using Names = std::vector<std::string>;

std::string openError(JackDriver& driver, double tick_rate_hz) {
  return complaintOf<DeviceError>([&] { driver.open(tick_rate_hz); });
}

TEST(JackDriverTest, SaysWhatIsNotThere) {
  JackServer server("absent", test::serverSettings(kJackRate, 64));
  JackDriverConfig config = test::jackDriver(server);
  config.wait_s = 0.3;
  JackDriver driver(config);
  EXPECT_NE(openError(driver, 3000.0).find("no JACK server `" + server.name()), std::string::npos);
  server.start();
  config.wait_s = 1.0;
  JackDriver later(config);
  EXPECT_NE(openError(later, 3000.0).find("no port `device:position_1`"), std::string::npos);
}

TEST(JackDriverTest, RefusesATickThatDoesNotDivideThePeriodAndTakesOneThatDoes) {
  JackServer server("period", test::serverSettings(kJackRate, 64));
  server.start();
  const test::JackDeviceClient device(server, test::jackDevice());
  JackDriver driver(test::jackDriver(server));
  EXPECT_NE(openError(driver, 4000.0).find("period is 64 frames, a tick is 12"), std::string::npos);
  EXPECT_NE(openError(driver, 3100.0).find("no multiple of the 3100 Hz"), std::string::npos);
  EXPECT_EQ(openError(driver, 3000.0), "");
  EXPECT_EQ(driver.roundTripFrames(), 64);
  EXPECT_EQ(driver.extraDelayTicks(), 4);
}

TEST(JackDriverTest, FindsTheSoundCardsPortsByTheirNumbers) {
  JackServer server("physical", test::serverSettings(kJackRate, 128));
  server.start();
  JackDriverConfig config = test::jackDriver(server, 1);
  config.position_ports = {"physical 2"};
  config.force_ports = {"physical 2"};
  JackDriver driver(config);
  driver.open(6000.0);
  EXPECT_EQ(server.tool("jack_lsp -c system:playback_2 | grep -q '   ergotic_tgr:force_1'"), 0);
  EXPECT_EQ(server.tool("jack_lsp -c system:capture_2 | grep -q '   ergotic_tgr:position_1'"), 0);
  EXPECT_EQ(driver.roundTripFrames(), 2 * 128) << "one period each way on a synchronous server";
  EXPECT_EQ(driver.extraDelayTicks(), 32);
}

TEST(JackDriverTest, CountsOnTheRoundTripThatWasMeasured) {
  JackServer server("override", test::serverSettings(kJackRate, 64));
  server.start();
  const test::JackDeviceClient device(server, test::jackDevice());
  JackDriverConfig config = test::jackDriver(server);
  config.round_trip_frames = 211;
  JackDriver driver(config);
  driver.open(3000.0);
  EXPECT_EQ(driver.roundTripFrames(), 211);
  EXPECT_EQ(driver.extraDelayTicks(), 14);
  driver.close();
  config.round_trip_frames = 63;
  JackDriver impossible(config);
  EXPECT_NE(openError(impossible, 3000.0)
                .find("63 frames by round_trip_frames, allowed: at least "
                      "the period, 64"),
            std::string::npos);
}

TEST(JackDriverTest, KnowsTheRoundTripOfADeviceThatAppearsWhileItWaits) {
  JackServer server("late", test::serverSettings(kJackRate, 64));
  server.start();
  JackDeviceConfig config = test::jackDevice();
  config.latency_frames = 100;
  for (int i = 0; i < 8; ++i) {
    JackDriver driver(test::jackDriver(server));
    std::optional<test::JackDeviceClient> device;
    std::thread later([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(40 + i));
      device.emplace(server, config);
    });
    const std::string error = openError(driver, 3000.0);
    later.join();
    ASSERT_EQ(error, "") << "time " << i;
    ASSERT_EQ(driver.roundTripFrames(), 64 + 100) << "time " << i;
  }
}

TEST(JackDriverTest, DoesNotCountOnADeviceThatIsFasterThanAPeriod) {
  JackServer server("instant", test::serverSettings(kJackRate, 64));
  server.start();
  JackDevice device(test::jackDevice());
  audio::JackConfig instant = device.jackConfig("device", server.name());
  instant.terminal = audio::JackTerminal{};
  const audio::JackHost host(instant, device);
  JackDriverConfig config = test::jackDriver(server);
  config.wait_s = 2.0;
  JackDriver driver(config);
  EXPECT_NE(openError(driver, 3000.0)
                .find("the round trip is 0 frames by JACK, allowed: at least the period, 64"),
            std::string::npos);
}

/// Sees all that a driver sends, sample by sample.
class ForceProbe : public rt::AudioProcessor {
 public:
  explicit ForceProbe(std::uint32_t ratio) : ratio_(ratio) {}
  void audioStarted(double, std::uint32_t) override {}
  void audioStopped() noexcept override {}
  void xrun() noexcept override {}
  void process(const rt::Period& block) noexcept override {
    const float* force = block.inputs[0];
    const bool jump = block.start.frames != next_frame_;
    next_frame_ = block.start.frames + block.nframes;
    for (std::uint32_t i = 0; i < block.nframes; i += ratio_) {
      for (std::uint32_t r = 1; r < ratio_; ++r) {
        torn += force[i + r] == force[i] ? 0 : 1;
      }
      const bool next = force[i] == std::fmod(last_ + 1.0F / 1024.0F, 1.0F);
      if (last_ != 0.0F && force[i] != 0.0F) {
        wrong += next || jump || jumped_before_ ? 0 : 1;
        right += next ? 1 : 0;
      }
      last_ = force[i];
    }
    jumped_before_ = jump;
    is_zero = std::all_of(force, force + block.nframes, [](float f) { return f == 0.0F; });
    ++blocks;
    last_nonzero = is_zero ? last_nonzero.load() : blocks.load();
  }
  std::atomic<std::int64_t> blocks{0};
  std::atomic<std::int64_t> last_nonzero{0};  ///< number of the block
  std::atomic<std::int64_t> torn{0};          ///< samples that are not those of their tick
  std::atomic<std::int64_t> wrong{0};         ///< ticks that do not follow the one before
  std::atomic<std::int64_t> right{0};
  std::atomic<bool> is_zero{true};

 private:
  std::uint32_t ratio_;
  std::int64_t next_frame_ = 0;
  bool jumped_before_ = false;  // the driver may have met it a block later
  float last_ = 0.0F;
};

/// Force n is n/1024, exact in a float.
class CountingTarget : public TickCounter {
 public:
  using TickCounter::TickCounter;

 protected:
  void computeForces(std::int64_t tick) noexcept override {
    forces_.fill(static_cast<double>(tick % 1024) / 1024.0);
  }
};

class JackForcesTest : public ::testing::Test {
 protected:
  JackForcesTest() {
    server_.start();
    device_.emplace(JackDevice(test::jackDevice()).jackConfig("device", server_.name()), probe_);
    driver_.open(kJackRate / 16.0);
    driver_.clock()->start(target_);
  }
  ~JackForcesTest() override { driver_.clock()->stop(); }

  JackServer server_{"forces", test::serverSettings(kJackRate, 64)};
  ForceProbe probe_{16};
  std::optional<audio::JackHost> device_;
  JackDriver driver_{test::jackDriver(server_)};
  CountingTarget target_{driver_};
};

TEST_F(JackForcesTest, ReachTheDeviceSampleBySample) {
  ASSERT_TRUE(eventually([&] { return probe_.right > 3000; }));
  EXPECT_EQ(probe_.torn, 0);
  EXPECT_EQ(probe_.wrong, 0);
  EXPECT_EQ(target_.lost, 0);
}

TEST_F(JackForcesTest, AreZeroFromTheNextBlockOnWhenMadeSafe) {
  ASSERT_TRUE(eventually([&] { return probe_.right > 100; }));
  driver_.makeSafe();
  // One block may be under way to the device, one is what JACK's loop holds back.
  const std::int64_t last_allowed = probe_.blocks + 2;
  ASSERT_TRUE(eventually([&] { return probe_.blocks > last_allowed + 200; }));
  EXPECT_LE(probe_.last_nonzero, last_allowed);
  const std::int64_t safe_blocks = probe_.blocks;
  driver_.rearm();
  EXPECT_TRUE(eventually([&] { return probe_.last_nonzero > safe_blocks; }));
}

TEST_F(JackForcesTest, AreZeroWithoutTicks) {
  ASSERT_TRUE(eventually([&] { return probe_.right > 100; }));
  driver_.clock()->stop();
  const std::int64_t ticks = target_.ticks;
  const std::int64_t last_allowed = probe_.blocks + 2;
  ASSERT_TRUE(eventually([&] { return probe_.blocks > last_allowed + 100; }));
  EXPECT_LE(probe_.last_nonzero, last_allowed);
  EXPECT_EQ(target_.ticks, ticks);
}

TEST_F(JackForcesTest, AreZeroWhileAnotherSourceIsAtTheSamePort) {
  ASSERT_TRUE(eventually([&] { return probe_.right > 100; }));
  ASSERT_EQ(server_.tool("jack_connect system:capture_1 device:force_1"), 0);
  ASSERT_TRUE(eventually([&] { return target_.lost > 100 && probe_.is_zero; }));
  EXPECT_THAT(driver_.status().message, HasSubstr("connected with `system:capture_1` too"));
  ASSERT_EQ(server_.tool("jack_disconnect system:capture_1 device:force_1"), 0);
  driver_.reconnect();
  const std::int64_t well = target_.well;
  EXPECT_TRUE(eventually([&] { return target_.well > well + 100 && !probe_.is_zero; }));
}

TEST_F(JackForcesTest, ComeBackWithTheDevice) {
  ASSERT_TRUE(eventually([&] { return target_.well > 100; }));
  const audio::JackConfig config =
      JackDevice(test::jackDevice()).jackConfig("device", server_.name());
  device_.reset();
  ASSERT_TRUE(eventually([&] { return target_.lost > 100; }));
  const std::int64_t blocks = probe_.blocks;
  device_.emplace(config, probe_);
  driver_.reconnect();
  EXPECT_TRUE(eventually([&] { return probe_.last_nonzero > blocks; }));
}

TEST_F(JackForcesTest, OutliveAServerThatIsKilledAndRestarted) {
  ASSERT_TRUE(eventually([&] { return target_.well > 100; }));
  const std::int64_t missed_before = target_.missed_ticks;
  const std::int64_t killed_ns = rt::monotonicNs();
  server_.kill();
  ASSERT_TRUE(eventually([&] { return !driver_.status().running; }));
  const std::int64_t ticks = target_.ticks;
  const double back_s = 1e-9 * static_cast<double>(rt::monotonicNs() - killed_ns);
  server_.start();
  ASSERT_TRUE(eventually([&] { return target_.ticks > ticks + 100; }));
  driver_.reconnect();
  const std::int64_t well = target_.well;
  EXPECT_TRUE(eventually([&] { return target_.well > well + 100 && !probe_.is_zero; }));
  EXPECT_GE(target_.missed_ticks - missed_before, std::llround(0.9 * back_s * kJackRate / 16.0))
      << "the time without a server";
  EXPECT_EQ(driver_.extraDelayTicks(), 4);
}

TEST(JackSettingsTest, TakesPhysicalPortsInTheirOrderUnlessToldOthers) {
  const JackDriverConfig config = readJackSettings(YAML::Load("{slices: 2}"), "s.yaml");
  EXPECT_EQ(config.position_ports, (Names{"physical 1", "physical 2"}));
  EXPECT_EQ(config.force_ports, (Names{"physical 1", "physical 2"}));
  EXPECT_EQ(config.heartbeat_port, "");
  EXPECT_EQ(config.client, "ergotic_tgr");
  EXPECT_EQ(config.volts_per_unit, 1.0);
  EXPECT_EQ(JackDriver(config).damping(), kSupposedDamping);
  EXPECT_EQ(JackDriver(config).declaredDamping(), 0.0);
  EXPECT_EQ(config.round_trip_frames, 0);
}

TEST(JackSettingsTest, ReadsAllOfThem) {
  const JackDriverConfig config = readJackSettings(
      YAML::Load("client: hand\nserver: second\nslices: 2\nposition_ports: {physical: 3}\n"
                 "force_ports: [5, \"card:out 1\"]\nheartbeat_port: 8\nvolts_per_unit: 10\n"
                 "damping: 3.5\nround_trip_frames: 211\nwait_s: 0.5\n"),
      "s.yaml");
  EXPECT_EQ(config.client, "hand");
  EXPECT_EQ(config.server, "second");
  EXPECT_EQ(config.position_ports, (Names{"physical 3", "physical 4"}));
  EXPECT_EQ(config.force_ports, (Names{"physical 5", "card:out 1"}));
  EXPECT_EQ(config.heartbeat_port, "physical 8");
  EXPECT_EQ(config.volts_per_unit, 10.0);
  EXPECT_EQ(config.damping, 3.5);
  EXPECT_EQ(JackDriver(config).damping(), 3.5);
  EXPECT_EQ(JackDriver(config).declaredDamping(), 3.5);
  EXPECT_EQ(config.round_trip_frames, 211);
  EXPECT_EQ(config.wait_s, 0.5);
}

TEST(JackSettingsTest, SaysWhereASettingIsWrongAndWhatIsAllowed) {
  const auto errorOf = [](const std::string& text) {
    return complaintOf<TextError>([&] { JackFactory().make(YAML::Load(text), "s.yaml"); });
  };
  EXPECT_EQ(errorOf("{slices: 2}"), "") << "it is accepted";
  EXPECT_THAT(errorOf("{}"), HasSubstr("slices"));
  EXPECT_EQ(errorOf("slices: 2\nports: 3").substr(0, 18), "s.yaml:2:1: error:");
  EXPECT_EQ(errorOf("slices: 65").substr(0, 18), "s.yaml:1:9: error:");
  EXPECT_EQ(
      errorOf("slices: 2\nforce_ports: [1]"),
      "s.yaml:2:14: error: force_ports is a list of 1, allowed: a list of one port for each of "
      "the 2 slices, or {physical: N}");
  EXPECT_EQ(errorOf("slices: 2\nforce_ports: [1, 1]"),
            "s.yaml:2:18: error: force_ports: `physical 1` comes twice, allowed: each port once");
  EXPECT_EQ(errorOf("slices: 2\nforce_ports: [1, 0]").substr(0, 19), "s.yaml:2:18: error:");
  EXPECT_EQ(errorOf("slices: 1\nposition_ports: [left]"),
            "s.yaml:2:18: error: port of position_ports is `left`, allowed: a JACK port, as "
            "`system:capture_1`, or the number of a physical port, from 1 on");
  EXPECT_EQ(errorOf("slices: 1\nheartbeat_port: 1"),
            "s.yaml:2:17: error: heartbeat_port is `physical 1`, one of force_ports, allowed: any "
            "other port");
  EXPECT_EQ(errorOf("slices: 1\nvolts_per_unit: 0").substr(0, 19), "s.yaml:2:17: error:");
  EXPECT_EQ(errorOf("slices: 1\nround_trip_frames: 1.5").substr(0, 19), "s.yaml:2:20: error:");
}

}  // namespace
}  // namespace ergotic::tgr
