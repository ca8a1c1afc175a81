// SPDX-License-Identifier: BSD-3-Clause
// A virtual hand pushes into a virtual wall through the safety chain. The figures of docs/safety.md
// are from here.

#include "support/test.hpp"
#include "tgr/wall_loop.hpp"

namespace ergotic::tgr {
namespace {

using test::openChain;
using test::plainDevice;
using test::stiffnessLimit;
using test::Wall;
using test::WallLoop;

constexpr double kRestS = 0.5;

/// Is a hand inside the wall brought to rest, when it was knocked a little? So little that it never
/// leaves the wall and meets no limit of the chain.
bool isStable(const Wall& wall, double rate_hz) {
  WallLoop loop(plainDevice(), openChain(), rate_hz);
  const double depth_m = -0.01;
  const auto inside = [&](double x, double v) {
    return -wall.stiffness * (x - depth_m) - wall.damping * v;
  };
  loop.engage();
  loop.aimAt(depth_m);
  loop.run(3.0, [](double, double) { return 0.0; });  // at rest to less than a micrometre
  loop.aimAt(depth_m + 0.001);
  loop.run(2.0 / rate_hz, inside);
  loop.aimAt(depth_m);
  const double early = loop.peakSpeed(0.1, inside);
  loop.run(0.3, inside);
  const double late = loop.peakSpeed(0.1, inside);
  const bool was_small = early < 0.02 && loop.chain().fault() == FaultReason::kNone;
  return was_small && late < early;
}

/// The stiffest wall that is stable, N/m, to 0.1 %.
double stiffestWall(double rate_hz, double damping) {
  double low = 0.0;
  double high = stiffnessLimit(rate_hz) * 20.0;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (isStable({middle, damping, 0.0}, rate_hz) ? low : high) = middle;
  }
  return low;
}

class VirtualWallTest : public ::testing::TestWithParam<double> {};

TEST_P(VirtualWallTest, IsStableUpToTheFormula) {
  const double rate_hz = GetParam();
  const double found = stiffestWall(rate_hz, 0.0);
  EXPECT_NEAR(found / stiffnessLimit(rate_hz), 1.0, 0.07) << found << " N/m";
  RecordProperty("stiffness", std::to_string(found));
}

INSTANTIATE_TEST_SUITE_P(Rates, VirtualWallTest, ::testing::Values(1000.0, 3000.0, 10000.0));

/// Two seconds of pushing.
struct Push {
  double given_out_j = 0.0;
  double residual_m_per_s = 0.0;
  SliceReading reading;
  FaultReason fault = FaultReason::kNone;
};

/// \param safety  its ramp is 0.1 s
Push push(double rate_hz, double times_limit, const SafetyConfig& safety) {
  WallLoop loop(plainDevice(), safety, rate_hz);
  const Wall wall{times_limit * stiffnessLimit(rate_hz), 0.0, 0.0};
  loop.aimAt(0.002);
  loop.run(kRestS, wall);
  loop.engage();
  loop.run(0.2, wall);
  loop.startMeter();
  for (int i = 1; i <= 100; ++i) {  // down to 10 mm inside in 0.1 s
    loop.aimAt(0.002 - 0.012 * i / 100.0);
    loop.run(0.001, wall);
  }
  loop.run(1.8, wall);
  const double residual = loop.peakSpeed(0.1, wall);
  return {-loop.leastEnergy(), residual, loop.chain().reading(0), loop.chain().fault()};
}

SafetyConfig quickDefaults() {
  SafetyConfig config;
  config.ramp_s = 0.1;
  return config;
}

struct Case {
  double rate_hz;
  double times_limit;
  double most_j;  ///< to be given out, in docs/safety.md
};

class ClampedWallTest : public ::testing::TestWithParam<Case> {};

TEST_P(ClampedWallTest, GivesOutLittleEnergy) {
  const Case& c = GetParam();
  const Push clamped = push(c.rate_hz, c.times_limit, quickDefaults());
  EXPECT_EQ(clamped.fault, FaultReason::kNone);
  EXPECT_LT(clamped.given_out_j, c.most_j);
  if (c.times_limit > 1.0) {
    const Push open = push(c.rate_hz, c.times_limit, openChain());
    EXPECT_GT(open.given_out_j, 100.0 * clamped.given_out_j) << "without the clamp";
    EXPECT_LT(clamped.residual_m_per_s, 0.25 * open.residual_m_per_s);
    EXPECT_GT(clamped.reading.clamped_ticks, 0);
  }
}

TEST_P(ClampedWallTest, GivesOutLittleEnergyWithThePassivityControllerToo) {
  const Case& c = GetParam();
  SafetyConfig config = quickDefaults();
  config.passivity_controller = true;
  const Push push_in = push(c.rate_hz, c.times_limit, config);
  EXPECT_EQ(push_in.fault, FaultReason::kNone);
  EXPECT_LT(push_in.given_out_j, c.most_j);
}

TEST_P(ClampedWallTest, GivesOutNoMoreWhenTheSliceDampsItself) {
  const Case& c = GetParam();
  for (const double share : {0.5, 1.0}) {  // a station relies on half
    SafetyConfig config = quickDefaults();
    config.slice_damping = share * 2.0;
    const Push push_in = push(c.rate_hz, c.times_limit, config);
    EXPECT_EQ(push_in.fault, FaultReason::kNone);
    EXPECT_LT(push_in.given_out_j, c.most_j) << share;
  }
}

/// A device that hardly damps itself, and of which nobody declared that it does.
TEST(ClampTest, HoldsASliceOfUnknownDamping) {
  const double rate_hz = 3000.0;
  VirtualDriverConfig device = plainDevice();
  device.slice.damping = 0.1;
  device.slice.hand_damping = 0.3;
  WallLoop loop(device, quickDefaults(), rate_hz);
  const Wall wall{1900.0, 0.0, 0.0};
  loop.aimAt(0.002);
  loop.run(kRestS, wall);
  loop.engage();
  loop.run(0.2, wall);
  loop.startMeter();
  loop.aimAt(-0.02);
  loop.run(4.0, wall);
  EXPECT_LT(-loop.leastEnergy(), 0.001);
  EXPECT_GT(loop.chain().reading(0).clamped_ticks, 0);
}

INSTANTIATE_TEST_SUITE_P(Walls,
                         ClampedWallTest,
                         ::testing::Values(Case{1000.0, 0.5, 0.00005},
                                           Case{1000.0, 1.2, 0.0008},
                                           Case{3000.0, 1.2, 0.00019},
                                           Case{3000.0, 4.0, 0.0017},
                                           Case{10000.0, 2.0, 0.0002}));

/// What the port says of itself is what the device measures.
TEST(ClampTest, KnowsWhatThePortGaveOut) {
  SafetyConfig config = openChain();
  config.energy_cap_j = 10.0;
  config.energy_supply_w = 0.0;
  const Push pushed = push(3000.0, 1.2, config);
  EXPECT_GT(pushed.given_out_j, 0.0);
  EXPECT_NEAR(-pushed.reading.least_energy_j, pushed.given_out_j, 1e-12);
}

TEST(ClampTest, MakesUpForNoMoreThanTheCapWhenMuchWasDissipatedBefore) {
  for (const Case& c : {Case{1000.0, 1.2, 0.0}, Case{3000.0, 4.0, 0.0}, Case{10000.0, 2.0, 0.0}}) {
    const SafetyConfig config = quickDefaults();
    WallLoop loop(plainDevice(), config, c.rate_hz);
    const Wall wall{c.times_limit * stiffnessLimit(c.rate_hz), 0.0, 0.0};
    const auto damper = [](double, double v) { return -20.0 * v; };
    loop.engage();
    for (int i = 0; i < 20; ++i) {
      loop.aimAt(i % 2 == 0 ? 0.015 : 0.002);
      loop.run(0.1, damper);
    }
    loop.run(0.5, damper);
    EXPECT_NEAR(loop.chain().reading(0).energy_j, config.energy_cap_j, 1e-3);
    loop.startMeter();
    loop.aimAt(-0.01);
    EXPECT_LT(loop.peakSpeed(2.0, wall), 0.5) << "the hand";
    EXPECT_LT(-loop.leastEnergy(), config.energy_cap_j + 0.001);
  }
}

/// As `push`, at 3 kHz and 1.2 times the limit, through a clamp and a slew limit that also slows
/// the fall of a force. \return energy given out, J
double givenOutWithASlowFall(bool clamp_is_last) {
  const double rate_hz = 3000.0;
  const double step_n = 500.0 / rate_hz;
  const Wall wall{1.2 * stiffnessLimit(rate_hz), 0.0, 0.0};
  const auto driver = makeVirtualDriver(plainDevice());
  driver->open(rate_hz);
  PortEnergy port({10.0, 0.0, 0.0, 1.0 / rate_hz, 1});
  double last_x = 0.0;
  for (int n = 0; n < 6600; ++n) {
    driver->setTarget(0, std::max(-0.01, 0.002 - 0.012 * n / 300.0));
    double x = 0.0;
    const double last = port.issued();
    driver->exchange(&last, &x);
    const double dx = x - last_x;
    last_x = x;
    port.moved(dx, 1);
    const auto clamped = [&](double f) { return EnergyClamp::limited(f, dx, port.predicted(dx)); };
    const auto slewed = [&](double f) { return std::clamp(f, last - step_n, last + step_n); };
    const double wanted = std::min(wall(x, 0.0), 20.0);
    port.follow(wanted);
    port.issue(clamp_is_last ? clamped(slewed(wanted)) : slewed(clamped(wanted)));
  }
  return -port.least();
}

TEST(ClampTest, IsLastBecauseAnythingThatSlowsTheFallOfForceAfterItGivesOutEnergy) {
  EXPECT_GT(givenOutWithASlowFall(false), 100.0 * givenOutWithASlowFall(true));
  EXPECT_LT(givenOutWithASlowFall(true), 0.00028);
  EXPECT_GT(givenOutWithASlowFall(false), 0.05);
}

/// Push to 15 mm and out again, three times. \return largest cut of the force, N
double largestCut(double stiffness, double rate_hz, double slice_damping) {
  SafetyConfig config = quickDefaults();
  config.slice_damping = slice_damping;
  config.energy_supply_w = 0.0;
  VirtualDriverConfig device = plainDevice();
  device.slice.hand_stiffness = 1000.0;
  WallLoop loop(device, config, rate_hz);
  const Wall wall{stiffness, 0.0, 0.0};
  loop.aimAt(0.002);
  loop.run(kRestS, wall);
  loop.engage();
  loop.run(0.2, wall);
  double cut = 0.0;
  for (int i = 0; i < 600; ++i) {
    loop.aimAt(0.002 + 0.0085 * (std::cos(M_PI * i / 100.0) - 1.0));
    for (int n = 0; n < static_cast<int>(0.005 * rate_hz); ++n) {
      const double last = loop.force();
      loop.tick(wall);
      const double wanted = std::min({wall(loop.position(), loop.velocity()), config.force_limit_n,
                                      last + config.slew_n_per_s / rate_hz});
      cut = std::max(cut, wanted - loop.force());
    }
  }
  return cut;
}

TEST(ClampTest, CostsNothingBelowThePassivityLimitOfTheSliceAlone) {
  for (const double rate_hz : {1000.0, 3000.0, 10000.0}) {
    const double passive = 2.0 * 2.0 * rate_hz / 3.0;
    EXPECT_LT(largestCut(0.95 * passive, rate_hz, 2.0), 1e-9) << rate_hz;
    EXPECT_LT(largestCut(0.1 * passive, rate_hz, 2.0), 1e-9) << rate_hz;
    EXPECT_LT(largestCut(0.45 * passive, rate_hz, 1.0), 1e-9) << rate_hz << ", half of it known";
  }
  EXPECT_GT(largestCut(4000.0, 3000.0, 0.0), 1.0) << "without credit for the slice's damping";
}

TEST(HardContactTest, IsLimitedAndNoFault) {
  for (const double rate_hz : {1000.0, 3150.0, 10000.0}) {
    VirtualDriverConfig device = plainDevice();
    device.slice.damping = 0.0;
    device.slice.hand_damping = 0.0;
    WallLoop loop(device, quickDefaults(), rate_hz);
    const Wall wall{5000.0, 0.0, 0.0};
    loop.aimAt(0.029);
    loop.run(0.2, wall);
    loop.engage();
    loop.run(0.3, wall);
    loop.aimAt(-0.015);  // 1 m/s and more at the wall
    const double hit_m_per_s = loop.peakSpeed(0.3, wall);
    EXPECT_GT(hit_m_per_s, 1.0);
    EXPECT_GT(loop.chain().reading(0).peak_raw_force_n, 20.0);
    EXPECT_EQ(loop.chain().fault(), FaultReason::kNone) << rate_hz;
  }
}

/// With ERGOTIC_WALL_CHART=FILE: the stiffest stable walls over their damping, for
/// lab/scripts/plot_wall_stability.
TEST(WallChartTest, DampingOfTheWallMakesStifferWallsStable) {
  const char* path = std::getenv("ERGOTIC_WALL_CHART");
  std::ofstream chart;
  if (path != nullptr) {
    chart.open(path);
    chart << "rate_hz,damping,stiffness\n";
  }
  for (const double rate_hz : {1000.0, 3000.0, 10000.0}) {
    double last = 0.0;
    for (const double damping : {0.0, 10.0, 20.0, 30.0, 40.0, 50.0}) {
      const double stiffness = stiffestWall(rate_hz, damping);
      EXPECT_GT(stiffness, last) << rate_hz << " Hz, " << damping << " N s/m";
      last = stiffness;
      chart << rate_hz << ',' << damping << ',' << stiffness << '\n';
    }
  }
}

}  // namespace
}  // namespace ergotic::tgr
