// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/jack_client.hpp"

#include <string>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "support/block_probe.hpp"
#include "support/jack_server.hpp"

namespace ergotic::audio {
namespace {

using test::BlockProbe;
using test::eventually;
using test::JackServer;

JackConfig configFor(const JackServer& server) {
  JackConfig config;
  config.server = server.name();
  config.inputs = 2;
  config.outputs = 3;
  return config;
}

bool blocksFlow(const BlockProbe& probe, std::int64_t more) {
  const std::int64_t before = probe.counts.blocks;
  return eventually([&] { return probe.counts.blocks >= before + more; });
}

void expectOrderlyBlocks(const BlockProbe& probe) {
  EXPECT_EQ(probe.counts.stray, 0);
  EXPECT_EQ(probe.counts.wrong_size, 0);
  EXPECT_EQ(probe.counts.bad_times, 0);
  EXPECT_EQ(probe.counts.denormals, 0);
  // A jump is a cycle that JACK lost; it must have said so.
  EXPECT_LE(probe.counts.jumps, probe.counts.xruns);
}

TEST(JackHostTest, BlocksArriveOneAfterTheOther) {
  JackServer server("blocks");
  server.start();
  BlockProbe probe;
  {
    JackHost host(configFor(server), probe);
    ASSERT_TRUE(blocksFlow(probe, 300)) << host.status().message;
    ASSERT_TRUE(eventually([&] { return host.status().running; }));
    const JackStatus status = host.status();
    EXPECT_EQ(status.sample_rate_hz, 44100.0);
    EXPECT_EQ(status.period_frames, 256U);
    EXPECT_EQ(status.client, "ergotic");
    EXPECT_EQ(status.starts, 1);
    EXPECT_EQ(status.message, "");
  }
  EXPECT_EQ(probe.sample_rate, 44100.0);
  EXPECT_EQ(probe.counts.starts, 1);
  EXPECT_EQ(probe.counts.stops, 1);
  expectOrderlyBlocks(probe);
}

TEST(JackHostTest, SaysThatThereIsNoServerAndFindsOneThatAppears) {
  JackServer server("late");
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(eventually([&] { return !host.status().message.empty(); }));
  EXPECT_FALSE(host.status().running);
  EXPECT_NE(host.status().message.find("no JACK server `" + server.name()), std::string::npos)
      << host.status().message;
  EXPECT_EQ(probe.counts.starts, 0);
  server.start();
  EXPECT_TRUE(blocksFlow(probe, 50));
  EXPECT_TRUE(eventually([&] { return host.status().running && host.status().message.empty(); }));
}

TEST(JackHostTest, OutlivesAServerThatIsKilledAndRunsWithTheNext) {
  JackServer server("killed");
  server.start();
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  for (int life = 1; life <= 3; ++life) {
    ASSERT_TRUE(eventually([&] { return probe.counts.starts == life; })) << host.status().message;
    ASSERT_TRUE(blocksFlow(probe, 50));
    server.kill();
    ASSERT_TRUE(eventually([&] { return probe.counts.stops == life; }));
    const std::int64_t blocks = probe.counts.blocks;
    ASSERT_TRUE(eventually([&] { return !host.status().running; }));
    EXPECT_NE(host.status().message, "");
    EXPECT_EQ(probe.counts.blocks, blocks);
    server.start();
  }
  EXPECT_TRUE(eventually([&] { return host.status().running && host.status().starts == 4; }));
  EXPECT_TRUE(blocksFlow(probe, 50));
  expectOrderlyBlocks(probe);
}

TEST(JackHostTest, BeginsAnewWhenTheServerEndsInGoodOrder) {
  JackServer server("ended");
  server.start();
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(blocksFlow(probe, 50));
  server.stop();
  ASSERT_TRUE(eventually([&] { return probe.counts.stops == 1; }));
  server.start();
  EXPECT_TRUE(eventually([&] { return probe.counts.starts == 2; })) << host.status().message;
  EXPECT_TRUE(blocksFlow(probe, 50));
}

TEST(JackHostTest, BeginsAnewWhenItIsDropped) {
  JackServer server("dropped");
  server.start();
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(blocksFlow(probe, 50));
  host.drop();
  ASSERT_TRUE(eventually([&] { return probe.counts.stops == 1; }));
  host.look();
  EXPECT_TRUE(eventually([&] { return probe.counts.starts == 2; })) << host.status().message;
  EXPECT_TRUE(blocksFlow(probe, 50));
  EXPECT_EQ(host.status().message, "");
  expectOrderlyBlocks(probe);
}

TEST(JackHostTest, BeginsAnewWithTheNewPeriod) {
  JackServer server("period");
  server.start();
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(blocksFlow(probe, 50));
  ASSERT_EQ(server.tool("jack_bufsize 512"), 0);
  ASSERT_TRUE(eventually([&] { return probe.counts.starts == 2; }));
  EXPECT_TRUE(blocksFlow(probe, 50));
  EXPECT_EQ(probe.period, 512U);
  EXPECT_EQ(probe.counts.stops, 1);
  EXPECT_TRUE(eventually([&] { return host.status().period_frames == 512U; }));
  expectOrderlyBlocks(probe);
}

TEST(JackHostTest, StopsWhileTheServerFreewheels) {
  JackServer server("freewheel");
  server.start();
  BlockProbe probe;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(blocksFlow(probe, 50));
  ASSERT_EQ(server.tool("jack_freewheel y"), 0);
  ASSERT_TRUE(eventually([&] { return host.status().freewheeling; }));
  EXPECT_TRUE(eventually([&] { return probe.counts.stops == 1; }));
  EXPECT_NE(host.status().message.find("freewheel"), std::string::npos);
  ASSERT_EQ(server.tool("jack_freewheel n"), 0);
  EXPECT_TRUE(eventually([&] { return probe.counts.starts == 2; }));
  EXPECT_TRUE(blocksFlow(probe, 50));
  EXPECT_TRUE(eventually([&] { return host.status().running; }));
  EXPECT_EQ(probe.counts.stray, 0);
}

TEST(JackHostTest, KeepsTheReasonOfAProcessorThatRefusesAndTriesAgain) {
  JackServer server("refused");
  server.start();
  BlockProbe probe;
  probe.refuse = true;
  JackHost host(configFor(server), probe);
  ASSERT_TRUE(eventually([&] { return host.status().message == "the probe wants no audio"; }));
  EXPECT_FALSE(host.status().running);
  EXPECT_NE(server.tool("jack_lsp | grep -q ergotic:"), 0);  // the client is gone
  probe.refuse = false;
  EXPECT_TRUE(blocksFlow(probe, 50));
  EXPECT_EQ(probe.counts.stops, 0);
}

TEST(JackHostTest, ConnectsToPlaybackOnlyIfAskedAndTakesNothingAway) {
  JackServer server("connect");
  server.start();
  BlockProbe first_probe;
  BlockProbe second_probe;
  JackConfig config = configFor(server);
  JackHost quiet(config, first_probe);
  ASSERT_TRUE(blocksFlow(first_probe, 10));
  EXPECT_NE(server.tool("jack_lsp -c | grep -q '   ergotic:out_'"), 0);
  ASSERT_EQ(server.tool("jack_connect ergotic:out_3 system:playback_1"), 0);
  config.connect = true;
  JackHost loud(config, second_probe);
  ASSERT_TRUE(blocksFlow(second_probe, 10));
  const auto connected = [&](const std::string& out, const std::string& sink) {
    return server.tool("jack_lsp -c " + sink + " | grep -q '   " + out + "$'") == 0;
  };
  EXPECT_TRUE(eventually([&] { return connected("ergotic-01:out_2", "system:playback_2"); }));
  EXPECT_TRUE(connected("ergotic-01:out_1", "system:playback_1"));
  EXPECT_TRUE(connected("ergotic:out_3", "system:playback_1"));
}

TEST(JackHostTest, ConnectsNothingToWhatAnotherHostIsWiredTo) {
  JackServer server("wired");
  server.start();
  BlockProbe device_probe;
  BlockProbe sound_probe;
  JackConfig wired = configFor(server);
  wired.name = "device";
  wired.inputs = 0;
  wired.outputs = 1;
  wired.output_peers = {"physical 2"};
  const JackHost device(wired, device_probe);
  ASSERT_TRUE(eventually([&] { return device.status().wired; })) << device.status().message;
  JackConfig config = configFor(server);
  config.connect = true;
  const JackHost sound(config, sound_probe);
  const auto isConnected = [&](const std::string& out, const std::string& sink) {
    return server.tool("jack_lsp -c " + sink + " | grep -q '   " + out + "$'") == 0;
  };
  ASSERT_TRUE(eventually([&] { return isConnected("ergotic:out_1", "system:playback_1"); }));
  ASSERT_TRUE(eventually([&] { return sound.status().running; }));  // its outputs are connected
  EXPECT_FALSE(isConnected("ergotic:out_2", "system:playback_2"));
  EXPECT_TRUE(isConnected("device:out_1", "system:playback_2"));
}

TEST(JackHostTest, MendsAWireAndSaysWhenItIsShared) {
  JackServer server("mended");
  server.start();
  BlockProbe probe;
  JackConfig config = configFor(server);
  config.input_names = {"left", "right"};
  config.input_peers = {"system:capture_2", "physical 1"};
  const JackHost host(config, probe);
  ASSERT_TRUE(eventually([&] { return host.status().wired; })) << host.status().message;
  EXPECT_EQ(host.status().input_latency_frames, 256U) << "of the dummy card";
  ASSERT_EQ(server.tool("jack_disconnect system:capture_2 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] {
    return server.tool("jack_lsp -c system:capture_2 | grep -q '   ergotic:left$'") == 0;
  }));
  ASSERT_EQ(server.tool("jack_connect system:capture_1 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] { return !host.status().wired; }));
  EXPECT_NE(host.status().message.find("`ergotic:left` is wired to `system:capture_2` alone, but "
                                       "connected with `system:capture_1` too"),
            std::string::npos)
      << host.status().message;
  ASSERT_EQ(server.tool("jack_disconnect system:capture_1 ergotic:left"), 0);
  EXPECT_TRUE(eventually([&] { return host.status().wired && host.status().message.empty(); }));
}

TEST(JackHostTest, DeclaresItsLatencyOnTopOfTheInputs) {
  JackServer server("latency");
  server.start();
  BlockProbe probe;
  JackConfig config = configFor(server);
  config.latency_frames = 333;
  JackHost host(config, probe);
  ASSERT_TRUE(blocksFlow(probe, 10));
  const auto latencyOf = [&](const std::string& port, const std::string& mode, int frames) {
    return server.tool("jack_lsp -l " + port + " | grep -q 'port " + mode + " latency = \\[ " +
                       std::to_string(frames) + " " + std::to_string(frames) + " \\] frames'") == 0;
  };
  EXPECT_TRUE(eventually([&] { return latencyOf("ergotic:out_1", "capture", 333); }));
  // Dummy capture ports are one period old.
  ASSERT_EQ(server.tool("jack_connect system:capture_1 ergotic:in_1"), 0);
  ASSERT_EQ(server.tool("jack_connect system:capture_2 ergotic:in_2"), 0);
  EXPECT_TRUE(eventually([&] { return latencyOf("ergotic:out_1", "capture", 333 + 256); }));
}

TEST(JackHostTest, RefusesSettingsOutOfRange) {
  BlockProbe probe;
  JackConfig config;
  config.outputs = kMaxPorts + 1;
  EXPECT_THROW(JackHost(config, probe), Exception);
  config.outputs = -1;
  EXPECT_THROW(JackHost(config, probe), Exception);
  config.outputs = 1;
  config.output_peers = {"a:b", "a:c"};
  EXPECT_THROW(JackHost(config, probe), Exception);
  config.output_peers.clear();
  config.output_names = {"left", "right"};
  EXPECT_THROW(JackHost(config, probe), Exception);
  config.output_names.clear();
  config.name = "";
  EXPECT_THROW(JackHost(config, probe), Exception);
  config.name = "a:b";
  EXPECT_THROW(JackHost(config, probe), Exception);
}

}  // namespace
}  // namespace ergotic::audio
