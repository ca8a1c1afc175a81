// SPDX-License-Identifier: BSD-3-Clause
// How long a force takes to answer a position, and what that means for a stiff wall.

#include "ergotic/rt/clock.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"
#include "tgr/drivers/jack/step_meter.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::eventually;
using test::JackServer;
using test::kJackRate;
using test::TickCounter;

/// Every force is the position of its slice, in volts.
class EchoTarget : public TickCounter {
 public:
  using TickCounter::TickCounter;

 protected:
  void computeForces(std::int64_t /*tick*/) noexcept override { forces_ = positions_; }
};

/// Steps through the whole loop, from the first one on that is answered as it should, until
/// `wanted` of them were not disturbed.
StepSummary measured(StepMeter& meter, int wanted) {
  std::vector<StepAnswer> answers;
  eventually([&] {
    StepAnswer answer;
    while (meter.poll(answer)) {
      if (!answers.empty() || (answer.answered && !answer.disturbed)) {
        answers.push_back(answer);
      }
    }
    return summaryOf(answers).answered >= wanted;
  });
  return summaryOf(answers);
}

struct Loop {
  int period;
  int ratio;
  int latency;  ///< of the converters
  bool declared;
};

class JackRoundTripTest : public ::testing::TestWithParam<Loop> {};

TEST_P(JackRoundTripTest, IsTheOneThatIsDeclaredToTheFrame) {
  const Loop loop = GetParam();
  JackServer server("round_trip", test::serverSettings(kJackRate, loop.period));
  server.start();
  // The meter in place of a device, with its ports and its converters.
  JackDeviceConfig config = test::jackDevice();
  config.latency_frames = loop.latency;
  config.declares_latency = loop.declared;
  StepMeterConfig steps;
  steps.channel = 1;
  steps.latency_frames = loop.latency;
  steps.rest_frames = 480;
  StepMeter meter(steps);
  const audio::JackHost device(JackDevice(config).jackConfig("device", server.name()), meter);
  JackDriver driver(test::jackDriver(server));
  driver.open(static_cast<double>(kJackRate) / loop.ratio);
  EchoTarget echo(driver);
  const test::ReferenceThreads reference;
  const std::int64_t from_ns = rt::monotonicNs();
  driver.clock()->start(echo);
  const StepSummary summary = measured(meter, 2 * loop.period);  // at all phases of ticks
  driver.clock()->stop();
  test::Trials trials(reference);
  for (int step = 0; step < summary.answered + summary.disturbed; ++step) {
    trials.next();
    trials.judgeThat(step >= summary.disturbed,
                     {from_ns, rt::monotonicNs(), test::ReferenceThreads::kMinNs},
                     "an answer without blocks left out");
  }
  trials.expectNineOfTen();
  ASSERT_GE(summary.answered, 2 * loop.period);
  EXPECT_EQ(summary.unanswered, 0);
  const auto measured_frames = static_cast<int>(summary.most_frames) - loop.ratio;
  EXPECT_EQ(summary.fewest_frames, measured_frames + 1);
  EXPECT_EQ(measured_frames, loop.period + loop.latency);
  const int told = driver.roundTripFrames();
  EXPECT_EQ(told, measured_frames - (loop.declared ? 0 : loop.latency));
  EXPECT_EQ(driver.extraDelayTicks(), (told + loop.ratio - 1) / loop.ratio);
}

INSTANTIATE_TEST_SUITE_P(Loops,
                         JackRoundTripTest,
                         ::testing::Values(Loop{64, 16, 0, true},
                                           Loop{64, 4, 37, true},
                                           Loop{96, 48, 0, true},
                                           Loop{128, 1, 0, true},
                                           Loop{64, 32, 21, false}),
                         [](const auto& tested) {
                           const Loop& loop = tested.param;
                           return std::to_string(loop.period) + "_frames_of_" +
                                  std::to_string(loop.ratio) + "_late_by_" +
                                  std::to_string(loop.latency);
                         });

/// A spring about 0, pushed for a while at first.
class WallTarget : public TickCounter {
 public:
  static constexpr std::int64_t kPushTicks = 300;
  WallTarget(Driver& driver, double volts_per_volt, std::int64_t length)
      : TickCounter(driver), gain_(volts_per_volt), length_(length) {}

  bool isOver() const { return ticks >= kPushTicks + length_; }
  /// Largest position after the push, in its first and last fifth, V.
  std::atomic<double> early{0.0};
  std::atomic<double> late{0.0};

 protected:
  void computeForces(std::int64_t tick) noexcept override {
    const double x = positions_[0];
    constexpr double kPush = 2e-3;  // full scale
    forces_[0] = -gain_ * x + (tick < kPushTicks ? kPush : 0.0);
    const std::int64_t since = tick - kPushTicks;
    std::atomic<double>& peak = 5 * since < length_ ? early : late;
    if (since >= 0 && (5 * since < length_ || 5 * since > 4 * length_)) {
      peak = std::max(peak.load(), std::abs(x));
    }
  }

 private:
  double gain_;
  std::int64_t length_;
};

/// A slice of 0.3 kg and 20 N s/m behind a sound card.
class JackWallTest : public ::testing::Test {
 protected:
  static constexpr int kPeriod = 64;
  static constexpr int kRatio = 16;
  static constexpr double kTickS = static_cast<double>(kRatio) / kJackRate;

  JackWallTest() {
    config_.metres_per_unit = 0.1;
    config_.newtons_per_unit = 200.0;
    VirtualSliceConfig& slice = config_.bank.slice;
    slice.mass = 0.3;
    slice.damping = 20.0;
    slice.stop = 0.1;
    slice.hand_mass = 0.0;
    slice.hand_stiffness = 0.0;
    slice.hand_damping = 0.0;
    server_.start();
  }

  /// Stiffness at which m x'' + b x' + K x(t - delay) = 0 begins to ring.
  double limit(double delay_s) const {
    const VirtualSliceConfig& slice = config_.bank.slice;
    double w = 0.0;  // m w^2 = K cos(w delay), b w = K sin(w delay)
    for (int n = 0; n < 100; ++n) {
      const double k =
          w == 0.0 ? slice.damping / delay_s : slice.damping * w / std::sin(w * delay_s);
      w = std::sqrt(k * std::cos(w * delay_s) / slice.mass);
    }
    return slice.damping * w / std::sin(w * delay_s);
  }

  /// How much larger the motion is a second after the push than it was at its end.
  double growth(double stiffness) {
    const test::JackDeviceClient device(server_, config_);
    JackDriver driver(test::jackDriver(server_));
    driver.open(1.0 / kTickS);
    extra_delay_ = driver.extraDelayTicks();
    const double gain = stiffness * config_.metres_per_unit / config_.newtons_per_unit;
    WallTarget wall(driver, gain, std::llround(1.0 / kTickS));
    driver.clock()->start(wall);
    EXPECT_TRUE(eventually([&] { return wall.isOver(); }));
    driver.clock()->stop();
    EXPECT_GT(wall.early, 1e-4);
    RecordProperty("growth_at_" + std::to_string(std::lround(stiffness)) + "_N_per_m",
                   std::to_string(wall.late / wall.early));
    return wall.late / wall.early;
  }

  JackDeviceConfig config_ = test::jackDevice();
  JackServer server_{"wall", test::serverSettings(kJackRate, kPeriod)};
  int extra_delay_ = 0;
};

TEST_F(JackWallTest, RingsAboveTheStiffnessThatItsDelayAllowsAndNotBelow) {
  // Hold of the force, the station's tick, the round trip, less what the mean is fresher.
  const double delay_s = (0.5 * kRatio + kRatio + kPeriod - 0.5 * (kRatio - 1)) / kJackRate;
  const double true_limit = limit(delay_s);
  EXPECT_LT(growth(0.9 * true_limit), 0.5);
  EXPECT_GT(growth(1.1 * true_limit), 2.0);
  // What stations count on: the whole ticks that the driver declares.
  const double d = 1.0 + extra_delay_;
  const double passive = 2.0 * config_.bank.slice.damping / ((1.0 + 2.0 * d) * kTickS);
  EXPECT_LT(growth(passive), 1.0);
  EXPECT_GT(passive, 0.85 * true_limit) << "nor is the declared delay too long";
}

}  // namespace
}  // namespace ergotic::tgr
