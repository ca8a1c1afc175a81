// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the force behind a sound card when the process that drives it ends or hangs. The
// server does not wait for its clients, as most do not.
#include <signal.h>

#include <sys/wait.h>

#include "ergotic/tgr/safety/guardian.hpp"
#include "support/test.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::eventually;

constexpr double kForceUnits = 0.075;  // 15 N

/// Gives the same force with every tick.
class Pusher final : public test::TickCounter {
 public:
  using TickCounter::TickCounter;

 private:
  void computeForces(std::int64_t /*tick*/) noexcept override { forces_[0] = kForceUnits; }
};

class JackGuardianTest : public ::testing::TestWithParam<int> {
 protected:
  JackGuardianTest() {
    server_.start();
    child_ = ::fork();  // while this process has no threads
    if (child_ == 0) {
      pushForEver();
    }
    device_.emplace(server_, test::jackDevice(1));
  }
  ~JackGuardianTest() override {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }

  [[noreturn]] void pushForEver() const {
    JackDriver driver(test::jackDriver(server_, 1));
    driver.open(3000.0);
    Guardian guardian(driver.guards(), {0.04, 0});
    Pusher pusher(driver);
    driver.clock()->start(pusher);
    while (true) {
      guardian.beat();
      rt::sleepUntilNs(rt::monotonicNs() + 5'000'000);
    }
  }
  double felt() {
    ForceRecord record;
    while (device_->device.pollForce(record)) {
      felt_ = record.force_n;
      felt_ns_ = record.time_ns;
    }
    return felt_;
  }

  test::JackServer server_{"guardian", {48000, 64, 2, false, 200}};
  pid_t child_ = -1;
  std::optional<test::JackDeviceClient> device_;
  double felt_ = 0.0;
  std::int64_t felt_ns_ = 0;
};

TEST_P(JackGuardianTest, CutsTheWiresOfAProcessThatEndsOrHangs) {
  ASSERT_TRUE(eventually([this] { return felt() > 14.9; })) << felt();
  const std::int64_t from_ns = rt::monotonicNs();
  ::kill(child_, GetParam());
  EXPECT_TRUE(eventually([this] { return felt() == 0.0; })) << felt();
  const double took_s = 1e-9 * static_cast<double>(felt_ns_ - from_ns);
  RecordProperty("took_ms", std::to_string(1e3 * took_s));
  EXPECT_LT(took_s, 1.0);
}

std::string nameOf(const ::testing::TestParamInfo<int>& tested) {
  return std::string("Sig") + sigabbrev_np(tested.param);
}
INSTANTIATE_TEST_SUITE_P(Every,
                         JackGuardianTest,
                         ::testing::Values(SIGSTOP, SIGKILL, SIGSEGV),
                         &nameOf);

}  // namespace
}  // namespace ergotic::tgr
