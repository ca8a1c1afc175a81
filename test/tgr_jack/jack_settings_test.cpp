// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_settings.hpp"

#include <yaml-cpp/yaml.h>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "tgr/drivers/jack/jack_driver.hpp"

namespace ergotic::tgr {
namespace {

using Names = std::vector<std::string>;

TEST(JackSettingsTest, TakesPhysicalPortsInTheirOrderUnlessToldOthers) {
  const JackDriverConfig config = readJackSettings(YAML::Load("{slices: 2}"), "s.yaml");
  EXPECT_EQ(config.position_ports, (Names{"physical 1", "physical 2"}));
  EXPECT_EQ(config.force_ports, (Names{"physical 1", "physical 2"}));
  EXPECT_EQ(config.heartbeat_port, "");
  EXPECT_EQ(config.client, "ergotic_tgr");
  EXPECT_EQ(config.volts_per_unit, 1.0);
  EXPECT_EQ(JackDriver(config).damping(), kSupposedDamping);
  EXPECT_EQ(JackDriver(config).declaredDamping(), 0.0);
  EXPECT_EQ(config.round_trip_frames, 0);
}

TEST(JackSettingsTest, ReadsAllOfThem) {
  const JackDriverConfig config = readJackSettings(
      YAML::Load("client: hand\nserver: second\nslices: 2\nposition_ports: {physical: 3}\n"
                 "force_ports: [5, \"card:out 1\"]\nheartbeat_port: 8\nvolts_per_unit: 10\n"
                 "damping: 3.5\nround_trip_frames: 211\nwait_s: 0.5\n"),
      "s.yaml");
  EXPECT_EQ(config.client, "hand");
  EXPECT_EQ(config.server, "second");
  EXPECT_EQ(config.position_ports, (Names{"physical 3", "physical 4"}));
  EXPECT_EQ(config.force_ports, (Names{"physical 5", "card:out 1"}));
  EXPECT_EQ(config.heartbeat_port, "physical 8");
  EXPECT_EQ(config.volts_per_unit, 10.0);
  EXPECT_EQ(config.damping, 3.5);
  EXPECT_EQ(JackDriver(config).damping(), 3.5);
  EXPECT_EQ(JackDriver(config).declaredDamping(), 3.5);
  EXPECT_EQ(config.round_trip_frames, 211);
  EXPECT_EQ(config.wait_s, 0.5);
}

TEST(JackSettingsTest, SaysWhereASettingIsWrongAndWhatIsAllowed) {
  const auto errorOf = [](const std::string& text) -> std::string {
    try {
      JackFactory().make(YAML::Load(text), "s.yaml");
    } catch (const TextError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(errorOf("{slices: 2}"), "accepted");
  EXPECT_NE(errorOf("{}").find("slices"), std::string::npos);
  EXPECT_EQ(errorOf("slices: 2\nports: 3").substr(0, 18), "s.yaml:2:1: error:");
  EXPECT_EQ(errorOf("slices: 65").substr(0, 18), "s.yaml:1:9: error:");
  EXPECT_EQ(
      errorOf("slices: 2\nforce_ports: [1]"),
      "s.yaml:2:14: error: force_ports is a list of 1, allowed: a list of one port for each of "
      "the 2 slices, or {physical: N}");
  EXPECT_EQ(errorOf("slices: 2\nforce_ports: [1, 1]"),
            "s.yaml:2:18: error: force_ports: `physical 1` comes twice, allowed: each port once");
  EXPECT_EQ(errorOf("slices: 2\nforce_ports: [1, 0]").substr(0, 19), "s.yaml:2:18: error:");
  EXPECT_EQ(errorOf("slices: 1\nposition_ports: [left]"),
            "s.yaml:2:18: error: port of position_ports is `left`, allowed: a JACK port, as "
            "`system:capture_1`, or the number of a physical port, from 1 on");
  EXPECT_EQ(errorOf("slices: 1\nheartbeat_port: 1"),
            "s.yaml:2:17: error: heartbeat_port is `physical 1`, one of force_ports, allowed: any "
            "other port");
  EXPECT_EQ(errorOf("slices: 1\nvolts_per_unit: 0").substr(0, 19), "s.yaml:2:17: error:");
  EXPECT_EQ(errorOf("slices: 1\nround_trip_frames: 1.5").substr(0, 19), "s.yaml:2:20: error:");
}

}  // namespace
}  // namespace ergotic::tgr
