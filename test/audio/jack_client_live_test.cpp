// SPDX-License-Identifier: BSD-3-Clause

#include "ergotic/audio/jack_client.hpp"

#include <atomic>
#include <future>
#include <thread>

#include <jack/jack.h>
#include <jack/midiport.h>

#include "audio/gate.hpp"
#include "audio/jack_library.hpp"
#include "audio/jack_session.hpp"
#include "support/jack_server.hpp"
#include "support/period_probe.hpp"
#include "support/test.hpp"

namespace ergotic::audio {
namespace {

using test::eventually;
using test::JackServer;
using test::PeriodProbe;

TEST(JackLibraryTest, ACallThatComesBackIsWaitedFor) {
  bool called = false;
  EXPECT_TRUE(jack_library::callPatiently([&called] { called = true; }));
  EXPECT_TRUE(called);
  EXPECT_FALSE(jack_library::isStuck());
}

TEST(JackLibraryTest, ACallThatHangsBlocksNobodyAndNoClientIsOpenedMeanwhile) {
  auto release = std::make_shared<std::promise<void>>();
  EXPECT_FALSE(jack_library::callPatiently([release] { release->get_future().wait(); }));
  EXPECT_TRUE(jack_library::isStuck());
  EXPECT_THAT(complaintOf<DeviceError>(
                  [&] { const JackSession session("", "stuck", std::make_shared<Semaphore>()); }),
              HasSubstr("has not come back"));
  release->set_value();
  EXPECT_TRUE(test::eventually([] { return !jack_library::isStuck(); }));
}

JackConfig configFor(const JackServer& server) {
  JackConfig config;
  config.server = server.name();
  config.inputs = 2;
  config.outputs = 3;
  return config;
}

bool blocksFlow(const PeriodProbe& probe, std::int64_t more) {
  const std::int64_t before = probe.counts.periods;
  return eventually([&] { return probe.counts.periods >= before + more; });
}

void expectOrderlyBlocks(const PeriodProbe& probe) {
  EXPECT_EQ(probe.counts.stray, 0);
  EXPECT_EQ(probe.counts.wrong_size, 0);
  EXPECT_EQ(probe.counts.bad_times, 0);
  EXPECT_EQ(probe.counts.denormals, 0);
  // A jump is a cycle that JACK lost; it must have said so.
  EXPECT_LE(probe.counts.jumps, probe.counts.xruns);
}

class JackHostTest : public testing::Test {
 protected:
  bool isConnected(const std::string& out, const std::string& sink) {
    return server_.tool("jack_lsp -c " + sink + " | grep -q '   " + out + "$'") == 0;
  }

  JackServer server_{"host"};
  PeriodProbe probe_;
  JackConfig config_ = configFor(server_);
};

TEST_F(JackHostTest, BlocksArriveOneAfterTheOther) {
  server_.start();
  {
    JackHost host(config_, probe_);
    ASSERT_TRUE(blocksFlow(probe_, 300)) << host.status().message;
    ASSERT_TRUE(eventually([&] { return host.status().running; }));
    const JackStatus status = host.status();
    EXPECT_EQ(status.sample_rate_hz, 44100.0);
    EXPECT_EQ(status.period_frames, 256U);
    EXPECT_EQ(status.client, "ergotic");
    EXPECT_EQ(status.starts, 1);
    EXPECT_EQ(status.message, "");
  }
  EXPECT_EQ(probe_.sample_rate, 44100.0);
  EXPECT_EQ(probe_.counts.starts, 1);
  EXPECT_EQ(probe_.counts.stops, 1);
  expectOrderlyBlocks(probe_);
}

TEST_F(JackHostTest, SaysThatThereIsNoServerAndFindsOneThatAppears) {
  JackHost host(config_, probe_);
  ASSERT_TRUE(eventually([&] { return !host.status().message.empty(); }));
  EXPECT_FALSE(host.status().running);
  EXPECT_THAT(host.status().message, HasSubstr("no JACK server `" + server_.name()));
  EXPECT_EQ(probe_.counts.starts, 0);
  server_.start();
  EXPECT_TRUE(blocksFlow(probe_, 50));
  EXPECT_TRUE(eventually([&] { return host.status().running && host.status().message.empty(); }));
}

TEST_F(JackHostTest, OutlivesAServerThatIsKilledAndRunsWithTheNext) {
  server_.start();
  JackHost host(config_, probe_);
  for (int life = 1; life <= 3; ++life) {
    ASSERT_TRUE(eventually([&] { return probe_.counts.starts == life; })) << host.status().message;
    ASSERT_TRUE(blocksFlow(probe_, 50));
    server_.kill();
    ASSERT_TRUE(eventually([&] { return probe_.counts.stops == life; }));
    const std::int64_t blocks = probe_.counts.periods;
    ASSERT_TRUE(eventually([&] { return !host.status().running; }));
    EXPECT_NE(host.status().message, "");
    EXPECT_EQ(probe_.counts.periods, blocks);
    server_.start();
  }
  EXPECT_TRUE(eventually([&] { return host.status().running && host.status().starts == 4; }));
  EXPECT_TRUE(blocksFlow(probe_, 50));
  expectOrderlyBlocks(probe_);
}

TEST_F(JackHostTest, SaysThatAStoppedServerStandsStill) {
  server_.start();
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 50));
  ASSERT_TRUE(eventually([&] { return host.status().running; }));
  server_.freeze();
  EXPECT_TRUE(eventually([&] { return !host.status().running; }));
  EXPECT_THAT(host.status().message, HasSubstr("stands still"));
  server_.thaw();
  EXPECT_TRUE(eventually([&] { return host.status().running && host.status().message.empty(); }));
}

TEST_F(JackHostTest, BeginsAnewWhenTheServerEndsInGoodOrder) {
  server_.start();
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 50));
  server_.stop();
  ASSERT_TRUE(eventually([&] { return probe_.counts.stops == 1; }));
  server_.start();
  EXPECT_TRUE(eventually([&] { return probe_.counts.starts == 2; })) << host.status().message;
  EXPECT_TRUE(blocksFlow(probe_, 50));
}

TEST_F(JackHostTest, BeginsAnewWhenItIsDropped) {
  server_.start();
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 50));
  host.drop();
  ASSERT_TRUE(eventually([&] { return probe_.counts.stops == 1; }));
  host.look();
  EXPECT_TRUE(eventually([&] { return probe_.counts.starts == 2; })) << host.status().message;
  EXPECT_TRUE(blocksFlow(probe_, 50));
  EXPECT_EQ(host.status().message, "");
  expectOrderlyBlocks(probe_);
}

TEST_F(JackHostTest, BeginsAnewWithTheNewPeriod) {
  server_.start();
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 50));
  ASSERT_EQ(server_.tool("jack_bufsize 512"), 0);
  ASSERT_TRUE(eventually([&] { return probe_.counts.starts == 2; }));
  EXPECT_TRUE(blocksFlow(probe_, 50));
  EXPECT_EQ(probe_.period, 512U);
  EXPECT_EQ(probe_.counts.stops, 1);
  EXPECT_TRUE(eventually([&] { return host.status().period_frames == 512U; }));
  expectOrderlyBlocks(probe_);
}

TEST_F(JackHostTest, StopsWhileTheServerFreewheels) {
  server_.start();
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 50));
  ASSERT_EQ(server_.tool("jack_freewheel y"), 0);
  ASSERT_TRUE(eventually([&] { return host.status().freewheeling; }));
  EXPECT_TRUE(eventually([&] { return probe_.counts.stops == 1; }));
  EXPECT_THAT(host.status().message, HasSubstr("freewheel"));
  ASSERT_EQ(server_.tool("jack_freewheel n"), 0);
  EXPECT_TRUE(eventually([&] { return probe_.counts.starts == 2; }));
  EXPECT_TRUE(blocksFlow(probe_, 50));
  EXPECT_TRUE(eventually([&] { return host.status().running; }));
  EXPECT_EQ(probe_.counts.stray, 0);
}

TEST_F(JackHostTest, KeepsTheReasonOfAProcessorThatRefusesAndTriesAgain) {
  server_.start();
  probe_.refuse = true;
  JackHost host(config_, probe_);
  ASSERT_TRUE(eventually([&] { return host.status().message == "the probe wants no audio"; }));
  EXPECT_FALSE(host.status().running);
  EXPECT_NE(server_.tool("jack_lsp | grep -q ergotic:"), 0);  // the client is gone
  probe_.refuse = false;
  EXPECT_TRUE(blocksFlow(probe_, 50));
  EXPECT_EQ(probe_.counts.stops, 0);
}

TEST_F(JackHostTest, ConnectsToPlaybackOnlyIfAskedAndTakesNothingAway) {
  server_.start();
  PeriodProbe first_probe;
  PeriodProbe second_probe;
  JackHost quiet(config_, first_probe);
  ASSERT_TRUE(blocksFlow(first_probe, 10));
  EXPECT_NE(server_.tool("jack_lsp -c | grep -q '   ergotic:out_'"), 0);
  ASSERT_EQ(server_.tool("jack_connect ergotic:out_3 system:playback_1"), 0);
  config_.connect = true;
  JackHost loud(config_, second_probe);
  ASSERT_TRUE(blocksFlow(second_probe, 10));
  EXPECT_TRUE(eventually([&] { return isConnected("ergotic-01:out_2", "system:playback_2"); }));
  EXPECT_TRUE(isConnected("ergotic-01:out_1", "system:playback_1"));
  EXPECT_TRUE(isConnected("ergotic:out_3", "system:playback_1"));
}

TEST_F(JackHostTest, ConnectsNothingToWhatAnotherHostIsWiredTo) {
  server_.start();
  PeriodProbe device_probe;
  PeriodProbe sound_probe;
  JackConfig wired = config_;
  wired.name = "device";
  wired.inputs = 0;
  wired.outputs = 1;
  wired.output_peers = {"physical 2"};
  const JackHost device(wired, device_probe);
  ASSERT_TRUE(eventually([&] { return device.status().wired; })) << device.status().message;
  config_.connect = true;
  const JackHost sound(config_, sound_probe);
  ASSERT_TRUE(eventually([&] { return isConnected("ergotic:out_1", "system:playback_1"); }));
  ASSERT_TRUE(eventually([&] { return sound.status().running; }));  // its outputs are connected
  EXPECT_FALSE(isConnected("ergotic:out_2", "system:playback_2"));
  EXPECT_TRUE(isConnected("device:out_1", "system:playback_2"));
}

TEST_F(JackHostTest, MendsAWireAndSaysWhenItIsShared) {
  server_.start();
  config_.input_names = {"left", "right"};
  config_.input_peers = {"system:capture_2", "physical 1"};
  const JackHost host(config_, probe_);
  ASSERT_TRUE(eventually([&] { return host.status().wired; })) << host.status().message;
  EXPECT_EQ(host.status().input_latency_frames, 256U) << "of the dummy card";
  ASSERT_EQ(server_.tool("jack_disconnect system:capture_2 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] {
    return server_.tool("jack_lsp -c system:capture_2 | grep -q '   ergotic:left$'") == 0;
  }));
  ASSERT_EQ(server_.tool("jack_connect system:capture_1 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] { return !host.status().wired; }));
  EXPECT_THAT(host.status().message,
              HasSubstr("`ergotic:left` is wired to `system:capture_2` alone, but "
                        "connected with `system:capture_1` too"));
  ASSERT_EQ(server_.tool("jack_disconnect system:capture_1 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] { return host.status().wired && host.status().message.empty(); }));
}

/// A client with a MIDI output `out`, as long as it lives.
class MidiPort {
 public:
  MidiPort(const JackServer& server, const char* name, unsigned long flags)
      : client_(jack_client_open(name,
                                 static_cast<jack_options_t>(JackNoStartServer | JackServerName),
                                 nullptr,
                                 server.name().c_str())) {
    jack_set_process_callback(
        client_, [](jack_nframes_t, void*) { return 0; }, nullptr);
    jack_activate(client_);
    jack_port_register(client_, "out", JACK_DEFAULT_MIDI_TYPE, JackPortIsOutput | flags, 0);
  }
  ~MidiPort() { jack_client_close(client_); }
  MidiPort(const MidiPort&) = delete;
  MidiPort& operator=(const MidiPort&) = delete;

 private:
  jack_client_t* client_;
};

TEST_F(JackHostTest, ConnectsMidiHardwareWheneverItAppears) {
  server_.start();
  config_.midi = true;
  config_.midi_connect = kPhysicalMidi;
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 10));
  const auto is_connected = [&] {
    host.look();
    return isConnected("ergotic:midi_in", "piano:out");
  };
  const auto is_looked_at = [&](int times) {
    const std::int64_t looks = host.status().looks;
    return eventually([&] {
      host.look();
      return host.status().looks > looks + times;
    });
  };
  const MidiPort program(server_, "program", 0);
  for (int life = 0; life < 2; ++life) {
    ASSERT_TRUE(is_looked_at(1)) << "without it";
    const MidiPort piano(server_, "piano", JackPortIsPhysical);
    EXPECT_TRUE(eventually(is_connected)) << life;
    EXPECT_FALSE(isConnected("ergotic:midi_in", "program:out"));
    if (life == 0) {  // what is disconnected by hand stays so, for three looks
      ASSERT_EQ(server_.tool("jack_disconnect piano:out ergotic:midi_in"), 0);
      ASSERT_TRUE(is_looked_at(3));
      EXPECT_FALSE(is_connected());
    }
  }
}

TEST_F(JackHostTest, ConnectsMidiByName) {
  server_.start();
  config_.midi = true;
  config_.midi_connect = "PROGRAM";
  JackHost host(config_, probe_);
  const MidiPort piano(server_, "piano", JackPortIsPhysical);
  const MidiPort program(server_, "a_program_2", 0);
  EXPECT_TRUE(eventually([&] {
    host.look();
    return isConnected("ergotic:midi_in", "a_program_2:out");
  }));
  EXPECT_FALSE(isConnected("ergotic:midi_in", "piano:out"));
}

TEST_F(JackHostTest, DeclaresItsLatencyOnTopOfTheInputs) {
  server_.start();
  config_.latency_frames = 333;
  JackHost host(config_, probe_);
  ASSERT_TRUE(blocksFlow(probe_, 10));
  const auto latencyOf = [&](const std::string& port, const std::string& mode, int frames) {
    return server_.tool("jack_lsp -l " + port + " | grep -q 'port " + mode + " latency = \\[ " +
                        std::to_string(frames) + " " + std::to_string(frames) + " \\] frames'") ==
           0;
  };
  EXPECT_TRUE(eventually([&] { return latencyOf("ergotic:out_1", "capture", 333); }));
  // Dummy capture ports are one period old.
  ASSERT_EQ(server_.tool("jack_connect system:capture_1 ergotic:in_1"), 0);
  ASSERT_EQ(server_.tool("jack_connect system:capture_2 ergotic:in_2"), 0);
  EXPECT_TRUE(eventually([&] { return latencyOf("ergotic:out_1", "capture", 333 + 256); }));
}

TEST_F(JackHostTest, RefusesSettingsOutOfRange) {
  config_ = {};
  config_.outputs = kMaxPorts + 1;
  EXPECT_THROW(JackHost(config_, probe_), Exception);
  config_.outputs = -1;
  EXPECT_THROW(JackHost(config_, probe_), Exception);
  config_.outputs = 1;
  config_.output_peers = {"a:b", "a:c"};
  EXPECT_THROW(JackHost(config_, probe_), Exception);
  config_.output_peers.clear();
  config_.output_names = {"left", "right"};
  EXPECT_THROW(JackHost(config_, probe_), Exception);
  config_.output_names.clear();
  config_.name = "";
  EXPECT_THROW(JackHost(config_, probe_), Exception);
  config_.name = "a:b";
  EXPECT_THROW(JackHost(config_, probe_), Exception);
}

TEST(GateThreadsTest, NobodyIsInsideOnceCloseHasReturned) {
  constexpr int kRounds = 300;
  Gate gate;
  int guarded = 0;  // written inside, and by the closer while closed: a race if the gate leaks
  std::atomic<bool> quit{false};
  std::atomic<int> visits{0};
  std::thread visitor([&] {
    while (!quit) {
      if (gate.enter()) {
        ++guarded;
        ++visits;
        gate.leave();
      }
    }
  });
  int closed_rounds = 0;
  for (int round = 0; round < kRounds; ++round) {
    const int before = visits;
    gate.open();
    while (visits == before) {
      std::this_thread::yield();
    }
    gate.close();
    const int seen = guarded;
    std::this_thread::yield();
    closed_rounds += guarded == seen && seen == visits ? 1 : 0;
    guarded = seen;
  }
  quit = true;
  visitor.join();
  EXPECT_EQ(closed_rounds, kRounds);
  EXPECT_GE(visits, kRounds);
}

}  // namespace
}  // namespace ergotic::audio
