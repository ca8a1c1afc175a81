// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety_chain.hpp"
#include "support/realtime_scope.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using Slices = std::array<double, kMaxSlices>;
constexpr int kTicks = 10000;

/// The ticks of a whole loop: exchange, validate, limit.
template <class Rig>
void expectRealtimeTicks(Rig& rig) {
  SafetyConfig config;
  config.max_missing = 1000;
  Driver& driver = rig.driver();
  driver.open(1000.0);
  SafetyChain chain(config, driver.slices(), 1e-3);
  Slices forces{};
  Slices positions{};
  test::expectRealtime([&] {
    for (int n = 0; n < kTicks; ++n) {
      const std::uint32_t flags = driver.exchange(forces.data(), positions.data());
      chain.validate(positions.data(), flags, 0);
      chain.engage();
      forces.fill(n % 100 == 99 ? std::numeric_limits<double>::quiet_NaN() : -200.0 * positions[0]);
      chain.limit(forces.data());
      if (n % 1000 == 999) {
        driver.makeSafe();
      }
      rig.elapse();
    }
  });
}

TEST(TgrRealtimeTest, InProcessDriverAndChainAreRealtime) {
  test::InProcessRig rig;
  ASSERT_TRUE(rig.driver().setTarget(0, 0.01));
  expectRealtimeTicks(rig);
}

TEST(TgrRealtimeTest, SharedMemoryDriverAndItsDeviceAreRealtime) {
  const test::ScratchFile gesture("0,0,0\n1,0,0.02\n5,0,-0.02\n");
  test::SharedMemoryRig rig(gesture.path());
  expectRealtimeTicks(rig);
}

TEST(TgrRealtimeTest, DriversInsideOthersAreRealtime) {
  test::CombinedRig combined;
  expectRealtimeTicks(combined);
  test::CalibratedRig calibrated;
  expectRealtimeTicks(calibrated);
  const auto expectRealtimeFault = [](InjectedFault kind) {
    const auto faulty = makeFaultyDriver(test::makePlainVirtual(3));
    faulty->open(1000.0);
    faulty->inject({kind, -1, 20, 1e-6});
    const Slices forces{};
    Slices positions{};
    test::expectRealtime([&] {
      for (int n = 0; n < 30; ++n) {
        faulty->exchange(forces.data(), positions.data());
      }
    });
  };
  for (int kind = 0; kind <= static_cast<int>(InjectedFault::kNoise); ++kind) {
    SCOPED_TRACE(kind);
    expectRealtimeFault(static_cast<InjectedFault>(kind));
  }
}

TEST(TgrRealtimeTest, ReplayOfACsvIsRealtime) {
  const test::ScratchFile file("tick,x0\n0,0.01\n1,0.02\n2,0.03\n");
  const auto driver = makeReplayDriver(readPositionsCsv(file.path()));
  driver->open(1000.0);
  const double force = 1.0;
  double x = 0.0;
  test::expectRealtime([&] {
    for (int n = 0; n < 10; ++n) {
      driver->exchange(&force, &x);
    }
  });
}

}  // namespace
}  // namespace ergotic::tgr
