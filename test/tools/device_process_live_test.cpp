// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/device_process.hpp"

#include <thread>

#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::tools {
namespace {

struct Device {
  std::vector<tgr::ForceRecord> waiting;
  std::int64_t dropped = 0;

  bool pollForce(tgr::ForceRecord& record) {
    if (waiting.empty()) {
      return false;
    }
    record = waiting.front();
    waiting.erase(waiting.begin());
    return true;
  }
  std::int64_t droppedRecords() const { return dropped; }
};

TEST(ForceLogTest, HoldsEveryRecordAfterItsHeader) {
  const test::ScratchFile file;
  ForceLog log(file.path());
  EXPECT_EQ(file.text(), "time_ns,slice,force_n\n");
  Device device{{{1, 0, 0.5}, {2, 3, -0.1}}};
  log.drain(device);
  const std::string first = "time_ns,slice,force_n\n1,0,0.5\n2,3,-0.10000000000000001\n";
  EXPECT_EQ(file.text(), first);
  device.waiting = {{4, 0, 0.0}};
  log.finish(device);
  EXPECT_EQ(file.text(), first + "4,0,0\n");
}

TEST(ForceLogTest, SaysThatItCannotHoldAll) {
  EXPECT_THROW(ForceLog("/nowhere/forces.csv"), Exception);
  EXPECT_THROW(ForceLog("/dev/full"), Exception);
  const test::ScratchFile file;
  ForceLog log(file.path());
  Device device{{}, 7};
  EXPECT_THAT(complaintOf([&] { log.finish(device); }),
              file.path() + ": incomplete, 7 records dropped");
}

TEST(ForceLogTest, ForgetsWhatNobodyAskedFor) {
  ForceLog log("");
  Device device{{{1, 0, 0.5}}, 7};
  EXPECT_NO_THROW(log.finish(device));
  EXPECT_TRUE(device.waiting.empty()) << "or its ring would run full";
}

TEST(WarnOfValuesTest, SaysThatADeviceProcessSetsNoParameters) {
  const test::ScratchFile file("0,0,0\n1,$loss,2\n2,$loss,3\n");
  testing::internal::CaptureStderr();
  warnOfValues("virtual_tgr", file.path());
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              StartsWith("virtual_tgr: warning: " + file.path() +
                         ": 2 rows set parameters of a scene, the first in line 2. "));
  testing::internal::CaptureStderr();
  warnOfValues("virtual_tgr", "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// In a thread of its own: signals are blocked thread by thread.
template <class Action>
void inAThread(const Action& action) {
  std::thread(action).join();
}

TEST(SignalsTest, AttendUntilOneComes) {
  inAThread([] {
    const Signals signals;
    for (const int signal : {SIGINT, SIGTERM}) {
      int calls = 0;
      signals.attend(0.0, [&] {
        pthread_kill(pthread_self(), ++calls == 3 ? signal : 0);
        return true;
      });
      EXPECT_EQ(calls, 3);
    }
  });
}

TEST(SignalsTest, AttendAsLongAsTheyAreToldTo) {
  inAThread([] {
    const Signals signals;
    int calls = 0;
    signals.attend(0.0, [&] { return ++calls < 5; });
    EXPECT_EQ(calls, 5);
    signals.attend(0.03, [&] { return ++calls > 0; });
    EXPECT_GT(calls, 5);
  });
}

}  // namespace
}  // namespace ergotic::tools
