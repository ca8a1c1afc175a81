// SPDX-License-Identifier: BSD-3-Clause
// What goes wrong around a station, and is nothing to it: 15 N stay where they are. And faults of
// its whole process, made by itself.
#include <fcntl.h>
#include <sndfile.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/InjectFault.h>
#include <ergotic/ModelState.h>
#include <ergotic/Status.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <visualization_msgs/MarkerArray.h>

#include "clock_shift/clock_shift.hpp"
#include "ergotic/rt/clock.hpp"
#include "integration/pushed_station.hpp"
#include "support/reference_threads.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr double kHourS = 3600.0;
constexpr std::int64_t kUnheardNs = 100'000'000;

/// The wall clock of a program that has the library preloaded.
class WallClock {
 public:
  WallClock() : file_(std::string(sizeof(Shift), '\0')) {
    const int file = open(file_.path().c_str(), O_RDWR | O_CLOEXEC);
    void* const page = mmap(nullptr, sizeof(Shift), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (page == MAP_FAILED) {
      throw std::runtime_error("no memory to shift a clock with");
    }
    shift_ = static_cast<Shift*>(page);
  }
  ~WallClock() { munmap(shift_, sizeof(Shift)); }
  WallClock(const WallClock&) = delete;
  WallClock& operator=(const WallClock&) = delete;

  std::map<std::string, std::string> environment() const {
    return {{"LD_PRELOAD", CLOCK_SHIFT}, {kClockShiftFile, file_.path()}};
  }
  void shift(double seconds) { *shift_ = static_cast<std::int64_t>(1e9 * seconds); }

 private:
  using Shift = std::atomic<std::int64_t>;
  const ScratchFile file_;
  Shift* shift_;
};

/// Whether more come than there were before, which tell the shifted time.
template <class Message>
bool comeAt(double shift_s, const Listener<Message>& listener, std::size_t before) {
  return eventually([&] {
    const double ahead_s = (listener.latest().header.stamp - ::ros::Time::now()).toSec();
    return listener.count() > before + 1 && std::abs(ahead_s - shift_s) < 0.1 * kHourS;
  });
}

/// Tells a station eight times as often as it needs that somebody is there.
class HeldSwitch {
 public:
  explicit HeldSwitch(::ros::NodeHandle& node)
      : topic_(node.advertise<std_msgs::Bool>("/station/presence", 10)),
        timer_(node.createWallTimer(::ros::WallDuration(0.025), [this](const auto& /*event*/) {
          std_msgs::Bool held;
          held.data = 1U;
          topic_.publish(held);
        })) {}

 private:
  ::ros::Publisher topic_;
  ::ros::WallTimer timer_;
};

class ClockTest : public ::testing::Test {
 protected:
  /// That all tell the time of a clock that is shifted.
  void expectTimes(double shift_s) const {
    const std::size_t statuses = status_.count();
    const std::size_t joints = joints_.count();
    const std::size_t motions = motion_.count();
    const std::size_t diagnostics = diagnostics_.count();
    EXPECT_TRUE(comeAt(shift_s, status_, statuses));
    EXPECT_TRUE(comeAt(shift_s, joints_, joints));
    EXPECT_TRUE(comeAt(shift_s, motion_, motions));
    EXPECT_TRUE(comeAt(shift_s, diagnostics_, diagnostics));
  }

  ::ros::NodeHandle node_;
  const Listener<Status> status_{node_, "/station/status"};
  const Listener<sensor_msgs::JointState> joints_{node_, "/station/joint_states"};
  const Listener<ModelState> motion_{node_, "/station/model_state"};
  const Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{node_, "/diagnostics"};
};

// An hour ahead, an hour behind, and back.
TEST_F(ClockTest, IsNothingToAStationWhenItJumpsByAnHour) {
  node_.setParam("/station/presence", "topic");
  const HeldSwitch presence(node_);
  const ReferenceThreads reference(ReferenceThreads::Rank::kOrdinary);
  WallClock clock;
  PushedStation station(clock.environment());
  EXPECT_TRUE(::ros::service::waitForService("/station/engage", 30000));
  EXPECT_TRUE(eventually([] { return call("engage").success != 0U; })) << "it hears the switch";
  EXPECT_TRUE(station.isPushed());
  Trials trials(reference);
  for (double shift_s = kHourS; trials.goOn();
       shift_s = shift_s > 0.0 ? -kHourS : shift_s + kHourS) {
    const std::int64_t from_ns = rt::monotonicNs();
    clock.shift(shift_s);
    expectTimes(shift_s);
    EXPECT_TRUE(station.ticksOn());
    const Status status = station.status();
    // A machine that stands still may keep the switch from being heard.
    if (trials.judgeThat(status.state == Status::PLAYING, {from_ns, rt::monotonicNs(), kUnheardNs},
                         "playing, but `" + status.state_text + "`,") ==
        Trials::Verdict::kExcused) {
      EXPECT_EQ(status.fault, Status::FAULT_PRESENCE) << status.state_text;
      EXPECT_TRUE(call("recover").success);
      EXPECT_TRUE(call("engage").success);
    }
    EXPECT_TRUE(station.isPushed());
  }
  node_.deleteParam("/station/presence");
}

/// A station that takes two seconds for each picture, whose presence switch is held.
class DisplayTest : public ::testing::Test {
 protected:
  DisplayTest() {
    node_.setParam("/station/presence", "topic");
    station_ = std::make_unique<PushedStation>(
        std::map<std::string, std::string>{{"LD_PRELOAD", SLOW_DISPLAY}});
    node_.deleteParam("/station/presence");
  }
  /// Of an ordinary answer, a few milliseconds on a machine that has nothing else to do.
  void ask(const std::string& service, Trials& trials) {
    constexpr std::int64_t kLimitNs = 300'000'000;
    const std::int64_t from_ns = rt::monotonicNs();
    const auto answer = call(service);
    trials.judge({from_ns, from_ns + kLimitNs, kUnheardNs}, rt::monotonicNs(), service);
    EXPECT_TRUE(answer.success) << service << ": " << answer.message;
  }

  ::ros::NodeHandle node_;
  const HeldSwitch presence_{node_};
  const Listener<visualization_msgs::MarkerArray> pictures_{node_, "/station/markers"};
  const Listener<GestureBlock> gesture_{node_, "/station/gesture"};
  std::unique_ptr<PushedStation> station_;
};

TEST_F(DisplayTest, LetsNothingWaitForAPicture) {
  constexpr int kRounds = 5;
  constexpr double kPictureS = 2.0;
  constexpr double kMinBlocksPerS = 25.0;
  ASSERT_TRUE(eventually([&] { return pictures_.count() > 2; }, PushedStation::kLongS));
  const std::size_t drawn_before = pictures_.count();
  const std::size_t told_before = gesture_.count();
  const std::int64_t began_ns = rt::monotonicNs();
  const ReferenceThreads reference(ReferenceThreads::Rank::kOrdinary);
  Trials trials(reference);
  while (trials.goOn()) {
    const std::int64_t from_ns = rt::monotonicNs();
    for (int n = 0; n < kRounds; ++n) {
      ask("engage", trials);
      EXPECT_TRUE(eventually([&] { return station_->force() < -1.0; }));
      ask("stop", trials);
      EXPECT_TRUE(eventually([&] { return station_->force() == 0.0; }));
      ask("recover", trials);
    }
    const Status status = station_->status();
    trials.judgeThat(status.fault == Status::FAULT_NONE, {from_ns, rt::monotonicNs(), kUnheardNs},
                     "without a fault, but `" + status.state_text + "`,");
  }
  const double took_s = 1e-9 * static_cast<double>(rt::monotonicNs() - began_ns);
  EXPECT_GT(static_cast<double>(gesture_.count() - told_before), kMinBlocksPerS * took_s);
  EXPECT_LE(static_cast<double>(pictures_.count() - drawn_before), 2.0 + took_s / kPictureS)
      << "they do not take as long as they should";
}

/// Frames of a WAV file, 0 if there is none.
std::int64_t framesIn(const std::string& path) {
  SF_INFO info{};
  SNDFILE* const file = sf_open(path.c_str(), SFM_READ, &info);
  sf_close(file);
  return info.frames;
}

// A file that may not become larger refuses what is written to it, as a full disk does. (On a disk
// that is nearly full the recorder stops by itself.)
TEST(DiskTest, IsNothingToAStationWhenItIsFull) {
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  const std::string take = (station.folder() / "take").string();
  ChildProcess recorder({"/bin/bash", "-c",
                         "trap '' XFSZ; ulimit -c 0 -f 4096; "
                         "exec /usr/lib/rosbag/record --all --chunksize=64 -O " +
                             take + ".bag"});
  const auto status = recorder.wait(PushedStation::kLongS);
  ASSERT_TRUE(status.has_value()) << "the recorder found room";
  EXPECT_NE(*status, 0);
  EXPECT_TRUE(station.ticksOn());
  EXPECT_EQ(station.status().state, Status::PLAYING) << station.status().state_text;
  EXPECT_TRUE(station.isPushed());

  const std::string unfinished = take + ".bag.active";
  ASSERT_EQ(std::system(("/usr/bin/rosbag reindex --quiet " + unfinished).c_str()), 0);
  std::filesystem::rename(unfinished, take + ".bag");
  const Outcome rendered = run("render", "--gesture " + take + ".bag --out " + take + ".wav");
  EXPECT_EQ(rendered.code, 0) << rendered.text;
  EXPECT_GT(framesIn(take + ".wav"), 44100) << "a second at the least";
}

/// A clock of a recording that is played, and begins anew.
TEST(SimulatedTimeTest, IsNothingToTheTicks) {
  ::ros::NodeHandle node;
  node.setParam("/use_sim_time", true);
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  node.deleteParam("/use_sim_time");  // it was read
  ::ros::Publisher clock = node.advertise<rosgraph_msgs::Clock>("/clock", 1);
  ASSERT_TRUE(eventually([&] { return clock.getNumSubscribers() > 0; }));
  for (const double now_s : {1e5, 0.001, 1e5, 0.0}) {
    rosgraph_msgs::Clock message;
    message.clock.fromSec(now_s);
    clock.publish(message);
    EXPECT_TRUE(station.ticksOn()) << "at " << now_s << " s";
  }
  EXPECT_TRUE(station.isPushed()) << station.status().state_text;
}

class ProcessFaultTest : public ::testing::Test {
 protected:
  ProcessFaultTest() { node_.setParam("/station/allow_fault_injection", true); }
  ~ProcessFaultTest() override { node_.deleteParam("/station/allow_fault_injection"); }

  /// \return nothing if the service did not answer
  static std::optional<InjectFault::Response> inject(const std::string& kind, double amount = 0.0) {
    InjectFault inject;
    inject.request.kind = kind;
    inject.request.amount = amount;
    const bool answered = ::ros::service::call("/station/inject_fault", inject);
    return answered ? std::optional(inject.response) : std::nullopt;
  }

 private:
  ::ros::NodeHandle node_;
};

TEST_F(ProcessFaultTest, StopsTheProcessForAsLongAsAsked) {
  constexpr double kStoppedS = 0.3;  // of the second that this station may stand still
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  const std::int64_t caught_up = station.status().catch_up_ticks;
  const auto answer = inject("stopped", kStoppedS);
  ASSERT_TRUE(answer && answer->success) << (answer ? answer->message : "no answer");
  EXPECT_TRUE(station.ticksOn());
  EXPECT_GE(station.status().catch_up_ticks - caught_up,
            static_cast<std::int64_t>(0.9 * kStoppedS * station.status().gestural_rate));
  EXPECT_TRUE(station.isPushed()) << station.status().state_text;
}

TEST_F(ProcessFaultTest, SaysWhatItCannotDo) {
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  for (const double amount : {0.0, 10.1, -1.0, std::nan("")}) {
    const auto refused = inject("stopped", amount);
    ASSERT_TRUE(refused && !refused->success) << amount;
    EXPECT_THAT(refused->message, HasSubstr("allowed: 0.001...10"));
  }
  const auto silent = inject("jack_lost");
  ASSERT_TRUE(silent && !silent->success);
  EXPECT_THAT(silent->message, HasSubstr("jack is none"));
  EXPECT_TRUE(station.isPushed()) << station.status().state_text;
}

// Events come in the order in which they were told: none can come later than that of the last
// fault.
TEST_F(ProcessFaultTest, TellsOnlyOfFaultsThatItMakes) {
  constexpr std::int64_t kTicks = 7;
  ::ros::NodeHandle node;
  const Listener<Event> events(node, "/station/events");
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  const auto jump = [](std::int32_t slice, std::int64_t ticks, double amount) {
    InjectFault inject;
    inject.request.kind = "jump";
    inject.request.slice = slice;
    inject.request.ticks = ticks;
    inject.request.amount = amount;
    EXPECT_TRUE(::ros::service::call("/station/inject_fault", inject));
    return inject.response;
  };
  const auto told = [&events] {
    std::vector<std::int64_t> ticks;
    for (const Event& event : events.messages()) {
      if (event.type == Event::INJECTED) {
        ticks.push_back(std::llround(event.value));
      }
    }
    return ticks;
  };
  constexpr std::int64_t kProbeTicks = 2;
  ASSERT_TRUE(eventually([&] {  // as soon as this listener is heard of
    EXPECT_TRUE(jump(0, kProbeTicks, 0.0).success);
    return !told().empty();
  }));
  EXPECT_EQ(jump(99, 1, 0.0).message, "slice of the fault: 99 , allowed -1...11");
  EXPECT_EQ(jump(0, 1, 1.1).message, "amount of jump: 1.1 m, allowed -1...1");
  EXPECT_EQ(jump(0, -1, 0.0).message, "ticks is -1, allowed: 0...1000000");
  const auto made = jump(0, kTicks, 0.0);
  ASSERT_TRUE(made.success) << made.message;
  EXPECT_TRUE(eventually([&] { return told().back() == kTicks; }));
  const auto all = told();
  EXPECT_EQ(std::count(all.begin(), all.end(), kProbeTicks) + 1,
            static_cast<std::ptrdiff_t>(all.size()))
      << "and the last one";
}

TEST_F(ProcessFaultTest, KillsTheProcess) {
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  EXPECT_FALSE(inject("killed")) << "nobody is left to answer";
  const auto status = station.process().wait(PushedStation::kLongS);
  ASSERT_TRUE(status.has_value());
  EXPECT_TRUE(WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL) << *status;
  EXPECT_TRUE(eventually([&] { return station.force() == 0.0; })) << "by the device's watchdog";
}

}  // namespace
}  // namespace ergotic::test
