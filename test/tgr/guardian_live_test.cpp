// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the force of a device when the process that drives it ends or hangs. The device
// is one whose own watchdog would take ten seconds.
#include "ergotic/tgr/safety/guardian.hpp"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <thread>

#include <sys/mman.h>
#include <sys/wait.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/tgr/combined_driver.hpp"
#include "ergotic/tgr/faulty_driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/period_probe.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_device.hpp"

namespace ergotic::tgr {
namespace {

using test::eventually;

constexpr double kForceN = 15.0;
constexpr double kSilenceS = 0.04;
constexpr double kLongSilenceS = 2.0;

class GuardianTest : public ::testing::Test {
 protected:
  GuardianTest() : name_("/ergotic_guardian_" + std::to_string(getpid())) {
    driver_.shared_memory = name_;
    driver_.slices = 1;
    device_.shared_memory = name_;
    device_.bank.slices = 1;
    device_.watchdog_s = 10.0;
  }
  ~GuardianTest() override { end(); }

  /// A device, and a process that pushes with it: forked while this one has no threads.
  void push() {
    made_.emplace(device_);
    child_ = ::fork();
    if (child_ == 0) {
      pushForEver();
    }
    mechanics_ = std::thread([this] { made_->run(stop_); });
    ASSERT_TRUE(eventually([this] { return felt() == kForceN; }));
  }
  void end() {
    stop_ = true;
    if (mechanics_.joinable()) {
      mechanics_.join();
    }
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
      child_ = -1;
    }
  }
  double felt() {
    ForceRecord record;
    while (made_->pollForce(record)) {
      felt_ = record.force_n;
      felt_ns_ = record.time_ns;
    }
    return felt_;
  }
  /// Signals the process. \return seconds until force was gone
  double timeToZero(int signal) {
    const std::int64_t from_ns = rt::monotonicNs();
    ::kill(child_, signal);
    EXPECT_TRUE(eventually([this] { return felt() == 0.0; }));
    return 1e-9 * static_cast<double>(felt_ns_ - from_ns);
  }

  [[noreturn]] void pushForEver() const {
    if (slow_to_die_) {  // as one that writes a large core file
      ::signal(SIGSEGV, [](int) { ::sleep(30); });
    }
    const auto driver = makeVirtualDriver(driver_);
    driver->open(1000.0);
    Guardian guardian(driver->guards(), {slow_to_die_ ? kLongSilenceS : kSilenceS, 0});
    double position = 0.0;
    for (std::int64_t due_ns = rt::monotonicNs();; due_ns += 1'000'000) {
      guardian.beat();
      driver->exchange(&kForceN, &position);
      rt::sleepUntilNs(due_ns);
    }
  }

  const std::string name_;
  bool slow_to_die_ = false;
  VirtualDriverConfig driver_;
  VirtualDeviceConfig device_;
  std::optional<VirtualDevice> made_;
  std::atomic<bool> stop_{false};
  std::thread mechanics_;
  pid_t child_ = -1;
  double felt_ = 0.0;
  std::int64_t felt_ns_ = 0;
};

class Ended : public GuardianTest, public ::testing::WithParamInterface<int> {};

TEST_P(Ended, TakesTheForceOffWhateverEndsItsProcess) {
  push();
  EXPECT_LT(timeToZero(GetParam()), 1.0) << "not by the device's own watchdog";
}

std::string nameOf(const ::testing::TestParamInfo<int>& tested) {
  return std::string("Sig") + sigabbrev_np(tested.param);
}
INSTANTIATE_TEST_SUITE_P(
    GuardianTest,
    Ended,
    ::testing::Values(SIGKILL, SIGSEGV, SIGABRT, SIGBUS, SIGTERM, SIGQUIT, SIGXCPU),
    &nameOf);

TEST_F(GuardianTest, TakesTheForceOffAtOnceThoughItsProcessTakesLongToDie) {
  slow_to_die_ = true;
  push();
  EXPECT_LT(timeToZero(SIGSEGV), 1.0) << "not because it is silent";
}

TEST_F(GuardianTest, TakesTheForceOffWhenItsProcessHangs) {
  push();
  EXPECT_LT(timeToZero(SIGSTOP), 1.0);
  ::kill(child_, SIGCONT);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(felt(), 0.0) << "latched until somebody re-arms";
}

TEST_F(GuardianTest, LeavesTheDeviceAloneWhenItIsToldToGo) {
  made_.emplace(device_);
  mechanics_ = std::thread([this] { made_->run(stop_); });
  const auto driver = makeVirtualDriver(driver_);
  driver->open(1000.0);
  double position = 0.0;
  {
    Guardian guardian(driver->guards(), {kSilenceS, 0});
    EXPECT_TRUE(guardian.isWatching());
  }
  EXPECT_EQ(driver->exchange(&kForceN, &position) & kMadeSafe, 0U);
}

TEST_F(GuardianTest, HoldsADeviceThroughWhateverStandsInFrontOfIt) {
  made_.emplace(device_);
  std::vector<std::unique_ptr<Driver>> drivers;
  drivers.push_back(makeVirtualDriver(driver_));
  drivers.push_back(makeVirtualDriver({}));  // which ends with its process
  const auto driver = makeFaultyDriver(combine(std::move(drivers)));
  driver->open(1000.0);
  const std::vector<Guard> guards = driver->guards();
  ASSERT_EQ(guards.size(), 1U);
  EXPECT_THAT(guards[0].words, ElementsAre("shared_memory", name_, testing::_));
  driver->close();
  driver->open(1000.0);
  EXPECT_FALSE(driver->guards() == guards) << "it was opened anew";
}

TEST_F(GuardianTest, IsSeenToBeGone) {
  Guardian guardian({}, {kSilenceS, 0});
  ASSERT_TRUE(guardian.isWatching());
  ::kill(guardian.pid(), SIGKILL);
  EXPECT_TRUE(eventually([&] { return !guardian.isWatching(); }));
  guardian.beat();  // no signal of a broken pipe
}

TEST_F(GuardianTest, IsEndedIfItDoesNotLook) {
  Guardian guardian({}, {kSilenceS, 0});
  for (int n = 0; n < 8; ++n) {
    EXPECT_TRUE(guardian.isWatching());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ::kill(guardian.pid(), SIGSTOP);
  EXPECT_TRUE(eventually([&] { return !guardian.isWatching(); }));
}

TEST_F(GuardianTest, HoldsTheOtherDevicesThoughTheMemoryOfOneIsCutOff) {
  VirtualDeviceConfig second = device_;
  second.shared_memory += "_second";
  made_.emplace(device_);
  VirtualDevice other(second);
  VirtualDriverConfig of_second = driver_;
  of_second.shared_memory = second.shared_memory;
  std::vector<std::unique_ptr<Driver>> drivers;
  drivers.push_back(makeVirtualDriver(driver_));
  drivers.push_back(makeVirtualDriver(of_second));
  drivers[0]->open(1000.0);
  drivers[1]->open(1000.0);
  const std::vector<Guard> guards = {drivers[0]->guards().at(0), drivers[1]->guards().at(0)};
  double position = 0.0;
  {
    Guardian guardian(guards, {kSilenceS, 0});
    const pid_t child = ::fork();  // for ours must not touch what is cut off
    if (child == 0) {
      ::_exit(::truncate(("/dev/shm" + name_).c_str(), 0));
    }
    ::waitpid(child, nullptr, 0);
    ::kill(guardian.pid(), SIGUSR1);
    EXPECT_TRUE(
        eventually([&] { return (drivers[1]->exchange(&kForceN, &position) & kMadeSafe) != 0U; }));
    EXPECT_TRUE(guardian.isWatching());
  }
  ASSERT_EQ(::truncate(("/dev/shm" + name_).c_str(), 65536), 0);  // to be given back
}

TEST_F(GuardianTest, TellsADeviceFromTheOneBeforeItThatWasOpenedAsOften) {
  made_.emplace(device_);
  auto driver = makeVirtualDriver(driver_);
  driver->open(1000.0);
  const std::vector<Guard> first = driver->guards();
  driver.reset();
  made_.reset();
  made_.emplace(device_);
  driver = makeVirtualDriver(driver_);
  driver->open(1000.0);
  EXPECT_FALSE(driver->guards() == first);
}

TEST_F(GuardianTest, HoldsNoOtherDeviceThatTookTheName) {
  made_.emplace(device_);
  const auto driver = makeVirtualDriver(driver_);
  driver->open(1000.0);
  const std::vector<Guard> guards = driver->guards();
  EXPECT_NO_THROW(Guardian(guards, {kSilenceS, 0}));
  ::shm_unlink(name_.c_str());
  const VirtualDevice other(device_);
  EXPECT_THAT(complaintOf<DeviceError>([&] {
                Guardian(guards, {kSilenceS, 0});
              }),
              HasSubstr("it is another one by now"));
}

TEST_F(GuardianTest, HearsNoTerminal) {
  Guardian guardian({}, {kSilenceS, 0});
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    ::kill(guardian.pid(), signal);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(guardian.isWatching());
  EXPECT_NE(::getsid(guardian.pid()), ::getsid(0));
}

TEST_F(GuardianTest, SaysWhatItCannotHold) {
  const std::vector<Guard> nowhere = {{{"shared_memory", "/no_such_device", "1"}}};
  EXPECT_THAT(complaintOf<DeviceError>([&] { Guardian(nowhere, {}); }),
              HasSubstr("/no_such_device"));
  const std::vector<Guard> unknown = {{{"teapot", "x"}}};
  EXPECT_THAT(complaintOf<DeviceError>([&] { Guardian(unknown, {}); }), HasSubstr("teapot"));
}

/// A station tries again every two seconds.
TEST_F(GuardianTest, LeavesNothingOpenThatCouldNotBegin) {
  const auto files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  const std::vector<Guard> too_many(100'000, {{std::string(100, 'x')}});  // for a command line
  const auto before = files();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NE(complaintOf<DeviceError>([&] { Guardian(too_many, {}); }), "");
  }
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace ergotic::tgr
