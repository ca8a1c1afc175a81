// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <iostream>
#include <thread>

#include <sys/wait.h>

#include "ergotic/rt/clock.hpp"
#include "integration/pushed_station.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr std::int64_t kLimitNs = 10'000'000;

/// One station under 15 N, one signal, and what the device felt.
class SignalTest : public ::testing::TestWithParam<int> {
 protected:
  struct Try {
    std::int64_t signal_ns = 0;
    int exit_status = 0;
    std::vector<ForceRecord> forces;
  };

  static Try attempt(int signal) {
    PushedStation station;  // the watchdog of its device would take two seconds
    Try done;
    EXPECT_TRUE(station.isPushed()) << station.status().state_text;
    done.signal_ns = rt::monotonicNs();
    station.process().signal(signal);
    done.exit_status = station.process().wait(10.0).value_or(-1);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    done.forces = station.feltToTheEnd();
    return done;
  }
};

/// When force was zero for good. \pre there was force
std::int64_t releaseTime(const std::vector<ForceRecord>& forces) {
  return forces.back().force_n == 0.0 ? forces.back().time_ns : Trials::kNever;
}

void expectUsualStatus(int signal, int status) {
  if (signal == SIGINT) {  // roscpp ends the program by itself
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  } else {
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
  }
}

TEST_P(SignalTest, ReleasesFifteenNewtonsInTime) {
  const ReferenceThreads reference;
  Trials trials(reference);
  while (trials.goOn()) {
    const Try done = attempt(GetParam());
    ASSERT_FALSE(done.forces.empty());
    expectUsualStatus(GetParam(), done.exit_status);
    const std::int64_t released_ns = releaseTime(done.forces);
    ASSERT_NE(released_ns, Trials::kNever) << "force was never released";
    std::cout << "force gone after " << static_cast<double>(released_ns - done.signal_ns) * 1e-6
              << " ms\n";
    trials.judgeThat(forceAt(done.forces, done.signal_ns) < -0.95 * kForceN,
                     mutedBefore(done.signal_ns), "all of the force");
    trials.judge({done.signal_ns, done.signal_ns + kLimitNs}, released_ns, "its release");
  }
}

// ROS ends the first of two nodes with one name. The device is busy until that has closed it.
TEST(TwoStationsTest, TheSecondOfANameGetsTheDeviceOfTheFirst) {
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  const std::int64_t second_ns = rt::monotonicNs();
  const auto second = startStation();
  ASSERT_TRUE(station.process().wait(PushedStation::kLongS).has_value()) << "the first plays on";
  EXPECT_TRUE(station.wasFreeSince(second_ns));
  EXPECT_TRUE(station.isPushed()) << station.status().message;
}

std::string nameOf(const ::testing::TestParamInfo<int>& tested) {
  return std::string("Sig") + sigabbrev_np(tested.param);
}
INSTANTIATE_TEST_SUITE_P(Every,
                         SignalTest,
                         ::testing::Values(SIGTERM, SIGINT, SIGHUP, SIGKILL, SIGSEGV, SIGABRT),
                         &nameOf);

}  // namespace
}  // namespace ergotic::test
