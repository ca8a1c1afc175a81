// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/capture.hpp"

#include <unistd.h>

#include <cstdio>
#include <future>
#include <thread>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/clock.hpp"
#include "support/jack_server.hpp"
#include "support/period_probe.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::audio {
namespace {

using test::eventually;
using test::JackServer;
using test::PeriodProbe;

class CaptureTest : public testing::Test {
 protected:
  CaptureTest() {
    config_.path = testing::TempDir() + "ergotic_capture_" + std::to_string(getpid()) + ".wav";
    config_.server = server_.name();
    config_.wait_s = 30.0;
    sender_config_.name = "sender";
    sender_config_.server = server_.name();
    sender_config_.outputs = 3;
  }
  ~CaptureTest() override { std::remove(config_.path.c_str()); }

  /// Frames whose value is not what was sent at that frame time.
  std::int64_t wrongFrames(const CaptureReport& report, const std::vector<int>& channels) const {
    const std::vector<double> samples = WavReader(config_.path).readAll();
    const auto width = channels.size();
    EXPECT_EQ(static_cast<std::int64_t>(samples.size() / width), report.frames);
    std::int64_t different = 0;
    for (std::size_t i = 0; i < samples.size() / width; ++i) {
      const std::int64_t frame = report.first_jack_frame + static_cast<std::int64_t>(i);
      bool same = true;
      for (std::size_t c = 0; c < width; ++c) {
        const float sent = test::counterRamp(frame, channels[c]);
        same = same && samples[i * width + c] == static_cast<double>(sent);
      }
      different += same ? 0 : 1;
    }
    return different;
  }

  JackServer server_{"capture"};
  CaptureConfig config_;
  JackConfig sender_config_;
  PeriodProbe probe_;
  std::atomic<bool> stop_{false};
};

TEST_F(CaptureTest, EverySampleArrivesAtItsFrameTime) {
  server_.start();
  JackHost sender(sender_config_, probe_);
  config_.ports = {"sender:out_3", "sender:out_1"};
  config_.seconds = 1.0;
  const test::ReferenceThreads reference;
  test::Trials trials(reference);
  while (trials.goOn()) {
    const std::int64_t from_ns = rt::monotonicNs();
    const CaptureReport report = capture(config_, stop_);
    EXPECT_EQ(report.frames, 44100);
    EXPECT_EQ(report.sample_rate_hz, 44100.0);
    EXPECT_EQ(report.dropped, 0);
    EXPECT_EQ(report.message, "");
    const std::int64_t wrong = wrongFrames(report, {2, 0});
    trials.judgeThat(wrong == 0 && report.lost == 0, {from_ns, rt::monotonicNs()},
                     "a whole recording (" + std::to_string(wrong) + " frames are wrong, " +
                         std::to_string(report.lost) + " lost)");
  }
}

TEST_F(CaptureTest, WaitsForPortsThatMatchAndRecordsThemInOrder) {
  config_.match = "^sender:out_";
  config_.seconds = 0.5;
  std::vector<std::string> names;
  auto recording = std::async(std::launch::async, [&] {
    return capture(config_, stop_, [&](const std::vector<std::string>& found) { names = found; });
  });
  server_.start();
  JackHost sender(sender_config_, probe_);
  const CaptureReport report = recording.get();
  EXPECT_EQ(names, (std::vector<std::string>{"sender:out_1", "sender:out_2", "sender:out_3"}));
  EXPECT_EQ(report.message, "");
  EXPECT_EQ(report.frames, 22050);
  EXPECT_EQ(WavReader(config_.path).channels(), 3);
}

TEST_F(CaptureTest, EndsOnRequestWithAWholeFile) {
  server_.start();
  JackHost sender(sender_config_, probe_);
  config_.ports = {"sender:out_1"};
  std::atomic<bool> recording{false};
  auto recorder = std::async(std::launch::async, [&] {
    return capture(config_, stop_, [&](const std::vector<std::string>&) { recording = true; });
  });
  EXPECT_TRUE(eventually([&] { return recording.load(); }));
  const std::int64_t blocks = probe_.counts.periods;
  EXPECT_TRUE(eventually([&] { return probe_.counts.periods > blocks + 50; }));
  stop_ = true;
  const CaptureReport report = recorder.get();
  EXPECT_GE(report.frames, 40 * 256);
  EXPECT_EQ(WavReader(config_.path).frames(), report.frames);
  EXPECT_EQ(report.message, "");
}

TEST_F(CaptureTest, KeepsWhatItHasWhenTheServerIsKilled) {
  server_.start();
  config_.ports = {"system:capture_1"};
  std::atomic<bool> recording{false};
  auto recorder = std::async(std::launch::async, [&] {
    return capture(config_, stop_, [&](const std::vector<std::string>&) { recording = true; });
  });
  EXPECT_TRUE(eventually([&] { return recording.load(); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  server_.kill();
  const CaptureReport report = recorder.get();
  EXPECT_THAT(report.message, HasSubstr("went away"));
  EXPECT_GT(report.frames, 0);
  EXPECT_EQ(WavReader(config_.path).frames(), report.frames);
}

TEST_F(CaptureTest, EndsWhereWhatItRecordsGoesAway) {
  server_.start();
  auto sender = std::make_unique<JackHost>(sender_config_, probe_);
  config_.ports = {"sender:out_1"};
  config_.seconds = 60.0;
  std::atomic<bool> recording{false};
  auto recorder = std::async(std::launch::async, [&] {
    return capture(config_, stop_, [&](const std::vector<std::string>&) { recording = true; });
  });
  EXPECT_TRUE(eventually([&] { return recording.load(); }));
  sender.reset();
  const CaptureReport report = recorder.get();
  EXPECT_EQ(report.message, "`sender:out_1` went away");
  EXPECT_LT(report.frames, 44100 * 30);
  EXPECT_EQ(WavReader(config_.path).frames(), report.frames);
}

TEST_F(CaptureTest, SaysWhatItWaitedForInVain) {
  config_.wait_s = 0.3;
  EXPECT_THROW(capture(config_, stop_), Exception);  // no ports named
  config_.ports = {"nobody:out_1"};
  EXPECT_THAT(complaintOf<DeviceError>([&] { capture(config_, stop_); }),
              HasSubstr("no JACK server"));
  server_.start();
  EXPECT_THAT(complaintOf<DeviceError>([&] { capture(config_, stop_); }),
              HasSubstr("nobody:out_1"));
}

}  // namespace
}  // namespace ergotic::audio
