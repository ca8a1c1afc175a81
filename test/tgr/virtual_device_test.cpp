// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_device.hpp"

#include <unistd.h>

#include <csignal>

#include <sys/wait.h>

#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::ThreeSlices;

SharedTraits traits(int slices) {
  SharedTraits result;
  result.slices = slices;
  result.step_rate_hz = 1000.0;
  return result;
}

TEST(VirtualDeviceTest, RecordsEveryChangeOfForceWithItsTime) {
  test::SharedMemoryRig rig;
  rig.driver().open(1000.0);
  ThreeSlices x{};
  const std::int64_t start = rig.now();
  for (const ThreeSlices& forces :
       {ThreeSlices{1.0, 0.0, 0.0}, ThreeSlices{1.0, 0.0, -0.1}, ThreeSlices{}}) {
    rig.driver().exchange(forces.data(), x.data());
    rig.elapse();
    rig.elapse();
  }
  std::ostringstream log;
  drainForces(rig.device(), log);
  const auto at = [&](int step) { return std::to_string(start + step * rig.kStepNs); };
  EXPECT_EQ(log.str(), at(1) + ",0,1\n" + at(3) + ",2,-0.10000000000000001\n" + at(5) + ",0,0\n" +
                           at(5) + ",2,0\n");
  EXPECT_EQ(rig.device().droppedRecords(), 0);
}

TEST(VirtualDeviceTest, StartsTheGestureWhenADriverOpens) {
  const test::ScratchFile gesture("0,0,0\n1,0,0.05\n");
  test::SharedMemoryRig rig(gesture.path());
  for (int n = 0; n < 3000; ++n) {
    rig.elapse();  // nobody is there: this gesture is lost
  }
  rig.driver().open(1000.0);
  const ThreeSlices forces{};
  ThreeSlices x{};
  for (int n = 0; n < 1001; ++n) {
    rig.driver().exchange(forces.data(), x.data());
    rig.elapse();
    if (n == 600) {
      EXPECT_NEAR(x[0], 0.03, 0.001);
    }
  }
}

TEST(VirtualDeviceTest, RefusesANameThatALivingDeviceHas) {
  const test::SharedMemoryRig rig;
  EXPECT_THROW(SharedSegment::create(rig.name(), traits(3)), DeviceError);
  EXPECT_NO_THROW(SharedSegment::attach(rig.name()));
}

TEST(VirtualDeviceTest, TakesTheNameOfADeviceThatWasKilled) {
  const std::string name = test::freshSegmentName();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const SharedSegment segment = SharedSegment::create(name, traits(3));
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(SharedSegment::attach(name)->traits.slices, 3) << "the killed device left its memory";
  const SharedSegment segment = SharedSegment::create(name, traits(5));
  EXPECT_EQ(SharedSegment::attach(name)->traits.slices, 5);
}

TEST(VirtualDeviceTest, TakesItsNameAwayWhenItEnds) {
  const std::string name = test::freshSegmentName();
  { const SharedSegment segment = SharedSegment::create(name, traits(3)); }
  EXPECT_THROW(SharedSegment::attach(name), DeviceError);
}

TEST(VirtualDeviceTest, IsNotMistakenForOtherMemory) {
  const std::string name = test::freshSegmentName();
  {
    const SharedSegment segment = SharedSegment::create(name, traits(3));
    segment->version = SharedDevice::kVersion + 1;
    EXPECT_THROW(SharedSegment::attach(name), DeviceError);
    segment->version = SharedDevice::kVersion;
    segment->size = 1;
    EXPECT_THROW(SharedSegment::attach(name), DeviceError);
    segment->size = sizeof(SharedDevice);
    segment->magic = 0;
    EXPECT_THROW(SharedSegment::attach(name), DeviceError);
  }
  for (const char* bad : {"", "/", "a/b", "/a/b"}) {
    EXPECT_THROW(SharedSegment::create(bad, traits(3)), DeviceError) << bad;
  }
}

TEST(VirtualDeviceTest, RefusesSettingsOutsideTheirRange) {
  VirtualDeviceConfig config;
  config.shared_memory = test::freshSegmentName();
  config.rate_hz = 50.0;
  EXPECT_THROW(VirtualDevice{config}, Exception);
  config.rate_hz = 4000.0;
  config.watchdog_s = 0.0;
  EXPECT_THROW(VirtualDevice{config}, Exception);
  config.watchdog_s = 0.01;
  config.bank.extra_delay_ticks = 1;
  EXPECT_THROW(VirtualDevice{config}, Exception);
  config.bank.extra_delay_ticks = 0;
  const test::ScratchFile positions("tick,x0\n0,0.01\n");
  config.bank.gesture_file = positions.path();
  EXPECT_THROW(VirtualDevice{config}, Exception) << "at which rate?";
  config.bank.gesture_rate = 1000.0;
  EXPECT_NO_THROW(VirtualDevice{config});
}

}  // namespace
}  // namespace ergotic::tgr
