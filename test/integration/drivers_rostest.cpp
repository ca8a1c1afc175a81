// SPDX-License-Identifier: BSD-3-Clause
// Drivers that are plugins, each under a station of its own: they play, lose their device, and play
// again when they have it back.

#include <csignal>
#include <iostream>
#include <map>
#include <optional>
#include <regex>
#include <thread>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/Calibrate.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "ergotic/rt/clock.hpp"
#include "integration/station_services.hpp"
#include "support/jack_server.hpp"
#include "support/places.hpp"
#include "support/reference_threads.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

using Environment = std::map<std::string, std::string>;

constexpr int kAudioHz = 48000;
constexpr int kTickHz = 3000;
constexpr double kHandStiffness = 500.0;  // N/m, of both virtual devices
constexpr double kDryFriction = 0.1;      // N, of both as well
constexpr double kTargetM = 0.015;        // far from the ends of the sensors, also if it overshoots
constexpr double kLongS = 60.0;           // a busy machine is slow
constexpr std::int64_t kMissedNs = 600'000;  // a little less than two ticks

/// Force on a hand that wants to be at kTargetM behind a wall.
constexpr double forceBehind(double wall) {
  return -wall * kTargetM * kHandStiffness / (kHandStiffness + wall);
}

/// How strong that is at least when the hand rests: dry friction may hold it before it is there.
constexpr double leastForceBehind(double wall) {
  return -forceBehind(wall) - kDryFriction * wall / (kHandStiffness + wall);
}

/// A wall whose surface is where the hand rests.
std::string wallOf(double stiffness) {
  std::ostringstream text;
  text << R"(ergotic: 1
name: wall
sections:
  hand: {rate: gestural}
mats:
  key: {type: slice, section: hand}
  ground: {type: ground, section: hand, at: [0, 0]}
lias:
  wall: {type: spring_damper, between: [key, ground], damping: 0.5, stiffness: )"
       << stiffness << R"(}
ports:
  key: {mat: key, slice: 0}
)";
  return text.str();
}

/// A hand that presses for a quarter of a second, every second. From outside each time: a wall that
/// appears where the hand already is may not push it away, for it never got the energy.
std::string pressesOfAHand() {
  constexpr int kPresses = 300;
  std::ostringstream rows;
  for (int n = 0; n < kPresses; ++n) {
    rows << n << ",0,0\n"
         << n + 0.2 << ",0,0\n"
         << n + 0.5 << ",0," << kTargetM << '\n'
         << n + 0.75 << ",0," << kTargetM << '\n';
  }
  return rows.str();
}

/// A station in a process of its own, and all that it tells.
class StationProcess {
 public:
  StationProcess(const std::string& device,
                 double wall,
                 const std::string& jack,
                 const Environment& environment) {
    node_.setParam("/station/model", wallOf(wall));
    node_.setParam("/station/device", device);
    node_.setParam("/station/jack", jack);
    node_.setParam("/station/jack_wait", kLongS);
    node_.setParam("/station/audio_rate", kAudioHz);
    node_.setParam("/station/gestural_rate", kTickHz);
    node_.setParam("/station/ramp", 0.1);
    node_.setParam("/station/max_stall", 1.0);
    node_.setParam("/station/max_stalls", 1'000'000);
    process_ = startStation(environment);
  }
  ~StationProcess() {
    process_->signal(SIGTERM);
    EXPECT_TRUE(process_->wait(kLongS)) << "the station does not end";
  }
  StationProcess(const StationProcess&) = delete;
  StationProcess& operator=(const StationProcess&) = delete;

  Status status() const { return status_.latest(); }
  bool becomes(std::uint8_t state) const {
    return eventually([&] { return status_.count() > 0 && status().state == state; }, kLongS);
  }

  /// That a hand meets the wall with this force from now on.
  void expectForce(double force) const {
    const std::size_t from = gesture_.count();
    ASSERT_TRUE(eventually([&] { return strongest(from) < 0.95 * force; }, kLongS))
        << strongest(from) << " N, " << status().state_text;
  }
  /// That a hand which presses from now on meets the wall with this force, or more while it swings.
  /// A stall mutes the force, and the hand then swings farther: such a press does not tell how far.
  void expectPresses(double force) const {
    Trials trials(reference_);
    while (trials.goOn()) {
      const std::int64_t from_ns = rt::monotonicNs();
      const std::size_t from = gesture_.count();
      expectForce(force);
      const double most = strongest(from);
      trials.judgeThat(most > 1.5 * force, {from_ns, rt::monotonicNs(), kMissedNs},
                       std::to_string(most) + " N, and no more,");
      ASSERT_TRUE(
          eventually([&] { return strongest(gesture_.count() - 1) > 0.05 * force; }, kLongS))
          << "it is not released";
    }
  }
  /// Whether from now on a second of ticks is without force.
  bool isWithoutForce() const {
    const std::size_t from = gesture_.count() + 1;  // one may be under way
    std::int64_t ticks = 0;
    const bool enough = eventually(
        [&] {
          const auto blocks = gesture_.messages();
          ticks = 0;
          for (std::size_t i = from; i < blocks.size(); ++i) {
            ticks += blocks[i].ticks;
          }
          return ticks >= kTickHz;
        },
        kLongS);
    return enough && strongest(from) == 0.0;
  }
  void expectDiagnosticsError() const { test::expectDiagnosticsError(diagnostics_, status_); }
  /// The newest number in the diagnostics under this name; not a number if there is none.
  double diagnosed(const std::string& name) const {
    for (const auto& status : diagnostics_.latest().status) {
      for (const auto& entry : status.values) {
        if (entry.key == name) {
          return std::stod(entry.value);
        }
      }
    }
    return std::nan("");
  }
  /// From a fault, with the device back, to force. \param force  as `expectPresses`
  void expectComesBack(double force) const {
    constexpr std::int64_t kLimitNs = 1'000'000'000;
    const std::int64_t asked_ns = rt::monotonicNs();
    std_srvs::Trigger::Response answer = call("recover");
    const std::int64_t answered_ns = rt::monotonicNs();
    ASSERT_TRUE(answer.success) << answer.message;
    std::cout << "recovered in " << 1e-9 * static_cast<double>(answered_ns - asked_ns) << " s\n";
    Trials trials(reference_);
    trials.next();
    trials.judge({asked_ns, asked_ns + kLimitNs, kLimitNs / 2}, answered_ns, "the recovery");
    EXPECT_TRUE(becomes(Status::READY));
    EXPECT_TRUE(isWithoutForce()) << "force came back by itself";
    answer = call("engage");
    ASSERT_TRUE(answer.success) << answer.message;
    expectPresses(force);
  }

 private:
  /// Most negative force of slice 0 in the blocks from this one on.
  double strongest(std::size_t from) const {
    double least = 0.0;
    const auto blocks = gesture_.messages();
    for (std::size_t n = from; n < blocks.size(); ++n) {
      for (std::uint32_t i = 0; i < blocks[n].ticks; ++i) {
        least = std::min(least,
                         static_cast<double>(blocks[n].forces[std::size_t{i} * blocks[n].slices]));
      }
    }
    return least;
  }

  const ReferenceThreads reference_;
  ::ros::NodeHandle node_;
  Listener<Status> status_{node_, "/station/status"};
  Listener<GestureBlock> gesture_{node_, "/station/gesture"};
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{node_, "/diagnostics"};
  std::unique_ptr<ChildProcess> process_;
};

// The board falls out of its slot after so many ticks, in which the station has to have played.
constexpr int kPluggedInS = 6;
constexpr int kUnpluggedS = 2;
constexpr double kBoardWall = 1000.0;  // N/m

/// The board of the example, as if its slices had answered their pushes.
std::string checkedBoard() {
  const std::string gain = "volts_per_newton: 0.05";
  return std::regex_replace(textOf(repository("config/comedi.yaml")), std::regex(gain),
                            gain + ", checked: 0.0002");
}

TEST(ComediStationTest, PlaysUntilItsBoardIsGoneAndAgainWhenItIsBack) {
  const ScratchFile gesture(pressesOfAHand());
  const StationProcess station(
      checkedBoard(), kBoardWall, "none",
      {{"LD_PRELOAD", COMEDI_STANDIN},
       {"COMEDI_STANDIN_RATE_HZ", std::to_string(kTickHz)},
       {"COMEDI_STANDIN_GESTURE", gesture.path()},
       {"COMEDI_STANDIN_FAULTS", "unplug:0:" + std::to_string(kPluggedInS * kTickHz) +
                                     ":1:" + std::to_string(kUnpluggedS)}});
  ASSERT_TRUE(station.becomes(Status::READY)) << station.status().message;
  EXPECT_EQ(station.status().devices, std::vector<std::string>{"comedi"});
  EXPECT_EQ(station.status().delay_ticks, 1.0);
  EXPECT_EQ(station.status().gestural_rate, kTickHz);

  ASSERT_TRUE(call("engage").success);
  station.expectForce(forceBehind(kBoardWall));

  ASSERT_TRUE(station.becomes(Status::FAULT));
  const std::int64_t told_ns = rt::monotonicNs();
  EXPECT_EQ(station.status().fault, Status::FAULT_DEVICE_LOST) << station.status().state_text;
  station.expectDiagnosticsError();
  EXPECT_TRUE(station.isWithoutForce());
  rt::sleepUntilNs(told_ns + kUnpluggedS * std::int64_t{1'000'000'000});
  station.expectComesBack(forceBehind(kBoardWall));
}

// A period so long that the watchdog has to be told, and a wall that is soft enough for it.
constexpr int kPeriod = 512;
constexpr double kCardWall = 100.0;  // N/m

const char kCard[] = R"(devices:
  - driver: jack
    settings:
      slices: 1
      position_ports: ["jack_tgr:position_1"]
      force_ports: ["jack_tgr:force_1"]
      heartbeat_port: "jack_tgr:heartbeat"
      volts_per_unit: 10
      wait_s: 3
    calibration:
      - {metres_per_volt: 0.005, volts_per_newton: 0.05, checked: 0.00025}
)";

class JackStationTest : public ::testing::Test {
 protected:
  JackStationTest() {
    server_.start();
    plugIn();
  }
  void plugIn() {
    device_.emplace(std::vector<std::string>{toolPath("jack_tgr"), "--server", server_.name(),
                                             "--slices", "1", "--gesture", gesture_.path(),
                                             "--watchdog-ms", "500"});
  }
  bool deviceIsThere() const {
    return eventually(
        [this] { return server_.tool("jack_lsp jack_tgr:heartbeat | grep -q .") == 0; });
  }

  // A client that is killed holds up the graph for ten of these timeouts.
  JackServer server_{"drivers", {kAudioHz, kPeriod, 2, true, 1000}};
  const ScratchFile gesture_{pressesOfAHand()};
  std::optional<ChildProcess> device_;
};

TEST_F(JackStationTest, PlaysUntilItsCardIsGoneAndAgainWhenItIsBack) {
  const StationProcess station(kCard, kCardWall, "auto", {{"JACK_DEFAULT_SERVER", server_.name()}});
  ASSERT_TRUE(station.becomes(Status::READY)) << station.status().message;
  EXPECT_EQ(station.status().devices, std::vector<std::string>{"jack"});
  EXPECT_EQ(station.status().delay_ticks, 1.0 + kPeriod * kTickHz / kAudioHz);
  EXPECT_TRUE(eventually([&] { return station.status().audio_running != 0U; }));
  EXPECT_TRUE(eventually([&] {
    return station.status().message.find("watchdog is 0.02 s, which is raised to 0.032 s") !=
           std::string::npos;
  })) << station.status().message;

  ASSERT_TRUE(call("engage").success);
  station.expectForce(forceBehind(kCardWall));

  device_->signal(SIGKILL);
  ASSERT_TRUE(station.becomes(Status::FAULT));
  EXPECT_TRUE(station.status().fault == Status::FAULT_DEVICE_LOST ||
              station.status().fault == Status::FAULT_WATCHDOG ||
              station.status().fault == Status::FAULT_STALL)  // JACK waits for the dead client
      << station.status().state_text;
  station.expectDiagnosticsError();
  EXPECT_TRUE(station.isWithoutForce());
  const auto refused = call("recover");
  EXPECT_FALSE(refused.success) << "there is no device";
  EXPECT_THAT(refused.message, HasSubstr("jack_tgr"));

  plugIn();
  ASSERT_TRUE(deviceIsThere()) << "the device does not start";
  station.expectComesBack(forceBehind(kCardWall));
}

TEST_F(JackStationTest, SaysThatItsServerIsGoneThoughNothingTicks) {
  const StationProcess station(kCard, kCardWall, "auto", {{"JACK_DEFAULT_SERVER", server_.name()}});
  ASSERT_TRUE(station.becomes(Status::READY)) << station.status().message;
  ASSERT_TRUE(call("engage").success);
  station.expectForce(forceBehind(kCardWall));
  // So far the hand may still move, and the newest status lags behind: without ticks it stays so.
  const auto asked_for = [&station] {
    return station.diagnosed("peak force that the model asked for (N)");
  };
  EXPECT_TRUE(eventually([&] { return asked_for() >= leastForceBehind(kCardWall); }, kLongS))
      << asked_for() << " N";

  server_.kill();
  ASSERT_TRUE(station.becomes(Status::FAULT));
  EXPECT_EQ(station.status().fault, Status::FAULT_WATCHDOG) << station.status().state_text;
  station.expectDiagnosticsError();
  EXPECT_TRUE(eventually([&] { return station.diagnosed("watchdog: times it acted") >= 1.0; }));
  EXPECT_GE(station.diagnosed("watchdog: silence when it acted last (s)"), 0.03);  // of 0.032
  EXPECT_GE(station.diagnosed("stalls of the whole machine"), 0.0);
  EXPECT_GE(station.diagnosed("longest of these (s)"), 0.0);
  EXPECT_GE(asked_for(), leastForceBehind(kCardWall));
  EXPECT_FALSE(call("recover").success) << "there is no server";

  server_.start();
  ASSERT_TRUE(deviceIsThere()) << "the device does not come back";
  station.expectComesBack(forceBehind(kCardWall));
}

/// A virtual device of which 0.05 V are a newton upwards, and what its calibration says of that.
std::string deviceBelievedToHave(double volts_per_newton, double full_scale) {
  std::ostringstream text;
  text << R"(devices:
  - driver: virtual
    settings: {slices: 1, volts: {metres_per_volt: 0.005, volts_per_newton: 0.05}}
    calibration:
      - {metres_per_volt: 0.005, volts_per_newton: )"
       << volts_per_newton << ", full_scale_newtons: " << full_scale << "}\n";
  return text.str();
}

struct Belief {
  double volts_per_newton = 0.0;
  double full_scale = 0.0;
  const char* complaint = "";
};

Calibrate::Response check() {
  Calibrate calibrate;
  calibrate.request.action = Calibrate::Request::CHECK;
  EXPECT_TRUE(::ros::service::call("/station/calibrate", calibrate));
  return calibrate.response;
}

class WrongGainTest : public ::testing::TestWithParam<Belief> {};

// Ten times too much would be 167 N in place of 15; the wrong sign pulls the hand into the wall.
TEST_P(WrongGainTest, LetsNoForceOut) {
  const Belief belief = GetParam();
  const StationProcess station(deviceBelievedToHave(belief.volts_per_newton, belief.full_scale),
                               kBoardWall, "none", {});
  ASSERT_TRUE(station.becomes(Status::READY)) << station.status().message;
  EXPECT_THAT(call("engage").message, HasSubstr("slice 0 was not checked"));
  const auto checked = check();
  EXPECT_FALSE(checked.success);
  EXPECT_THAT(checked.message, HasSubstr(belief.complaint));
  EXPECT_FALSE(call("engage").success);
  EXPECT_TRUE(station.isWithoutForce());
  EXPECT_EQ(station.status().state, Status::READY) << station.status().state_text;
}

INSTANTIATE_TEST_SUITE_P(Beliefs,
                         WrongGainTest,
                         ::testing::Values(Belief{0.5, 20.0, "volts_per_newton is wrong"},
                                           Belief{0.01, 1000.0, "volts_per_newton is wrong"},
                                           Belief{-0.05, 200.0, "the sign of volts_per_newton"},
                                           Belief{0.05, 0.0, "full_scale_newtons of slice 0"}));

}  // namespace
}  // namespace ergotic::test
