// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety_chain.hpp"
#include "support/alloc_count.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using Slices = std::array<double, kMaxSlices>;
constexpr int kTicks = 10000;

/// Heap calls of the ticks of a whole loop: exchange, validate, limit.
template <class Rig>
std::int64_t heapCalls(Rig& rig) {
  SafetyConfig config;
  config.max_missing = 1000;
  Driver& driver = rig.driver();
  driver.open(1000.0);
  SafetyChain chain(config, driver.slices(), 1e-3);
  Slices forces{};
  Slices positions{};
  const test::AllocationScope scope;
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
  return scope.calls();
}

class TgrNoAllocTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::AllocationScope::isAvailable()) {
      GTEST_SKIP() << "the sanitizer has its own heap";
    }
  }
};

TEST_F(TgrNoAllocTest, CountsWhatIsAllocated) {
  const test::AllocationScope scope;
  const test::InProcessRig rig;
  EXPECT_GT(scope.calls(), 0);
}

TEST_F(TgrNoAllocTest, InProcessDriverAndChainAllocateNothing) {
  test::InProcessRig rig;
  ASSERT_TRUE(rig.driver().setTarget(0, 0.01));
  EXPECT_EQ(heapCalls(rig), 0);
}

TEST_F(TgrNoAllocTest, SharedMemoryDriverAndItsDeviceAllocateNothing) {
  const test::ScratchFile gesture("0,0,0\n1,0,0.02\n5,0,-0.02\n");
  test::SharedMemoryRig rig(gesture.path());
  EXPECT_EQ(heapCalls(rig), 0);
}

TEST_F(TgrNoAllocTest, DriversInsideOthersAllocateNothing) {
  test::CombinedRig combined;
  EXPECT_EQ(heapCalls(combined), 0);
  test::CalibratedRig calibrated;
  EXPECT_EQ(heapCalls(calibrated), 0);
  const auto heapCallsOf = [](InjectedFault kind) {
    const auto faulty = makeFaultyDriver(test::makePlainVirtual(3));
    faulty->open(1000.0);
    faulty->inject({kind, -1, 20, 1e-6});
    const Slices forces{};
    Slices positions{};
    const test::AllocationScope scope;
    for (int n = 0; n < 30; ++n) {
      faulty->exchange(forces.data(), positions.data());
    }
    return scope.calls();
  };
  for (int kind = 0; kind <= static_cast<int>(InjectedFault::kNoise); ++kind) {
    EXPECT_EQ(heapCallsOf(static_cast<InjectedFault>(kind)), 0) << kind;
  }
}

TEST_F(TgrNoAllocTest, ReplayOfACsvAllocatesNothing) {
  const test::ScratchFile file("tick,x0\n0,0.01\n1,0.02\n2,0.03\n");
  const auto driver = makeReplayDriver(readPositionsCsv(file.path()));
  driver->open(1000.0);
  const double force = 1.0;
  double x = 0.0;
  const test::AllocationScope scope;
  for (int n = 0; n < 10; ++n) {
    driver->exchange(&force, &x);
  }
  EXPECT_EQ(scope.calls(), 0);
}

}  // namespace
}  // namespace ergotic::tgr
