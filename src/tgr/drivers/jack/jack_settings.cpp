// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_settings.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/tgr/driver.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

constexpr scene::Limits kSliceCount{"", 1.0, kMaxSlices};
constexpr scene::Limits kPhysical{"", 1.0, 1024.0};
constexpr scene::Limits kVolts{"V", 1e-3, 1e3};
constexpr scene::Limits kDamping{"N s/m", 0.0, 1e4};
constexpr scene::Limits kRoundTrip{"frames", 1.0, 1 << 16};
constexpr scene::Limits kWait{"s", 0.0, 60.0};

std::string physical(int index) {
  return "physical " + std::to_string(index);
}

/// A port as it is written: its full name, or its number among the physical ones.
std::string portOf(const Settings& settings, const scene::Node& node, const std::string& key) {
  const scene::Place place = scene::placeOf(node, settings.top().placeAt(key));
  const std::string what = "port of " + key;
  std::string word = scene::wordOf(settings.builder(), node, what, place);
  if (word.find(':') != std::string::npos) {
    return word;
  }
  const bool digits =
      std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (word.empty() || !digits) {
    settings.builder().fail(place, what + " is `" + word +
                                       "`, allowed: a JACK port, as `system:capture_1`, or the "
                                       "number of a physical port, from 1 on");
  }
  return physical(
      static_cast<int>(scene::numberIn(settings.builder(), word, what, kPhysical, place)));
}

/// `{physical: first}` or a list of `slices` ports, none of them twice.
std::vector<std::string> portsOf(const Settings& settings, const std::string& key, int slices) {
  std::vector<std::string> ports;
  const scene::YamlMap& top = settings.top();
  if (!top.has(key) || top.at(key).isMap()) {
    int first = 1;
    if (top.has(key)) {
      const scene::YamlMap map = top.map(key);
      map.allow({"physical"});
      first = map.integer("physical", kPhysical);
    }
    for (int i = 0; i < slices; ++i) {
      ports.push_back(physical(first + i));
    }
    return ports;
  }
  const scene::Node& list = top.at(key);
  if (!list.isList() || list.size() != static_cast<std::size_t>(slices)) {
    top.fail(key, key + " is " + scene::kindOf(list) +
                      ", allowed: a list of one port for each of the " + std::to_string(slices) +
                      " slices, or {physical: N}");
  }
  for (const scene::Node& node : list) {
    ports.push_back(portOf(settings, node, key));
    if (std::count(ports.begin(), ports.end(), ports.back()) > 1) {
      settings.builder().fail(
          scene::placeOf(node, top.placeAt(key)),
          key + ": `" + ports.back() + "` comes twice, allowed: each port once");
    }
  }
  return ports;
}

}  // namespace

JackDriverConfig readJackSettings(const YAML::Node& node, const std::string& file) {
  const Settings settings(node, file, "driver jack");
  const scene::YamlMap& top = settings.top();
  top.allow({"client", "server", "slices", "position_ports", "force_ports", "heartbeat_port",
             "volts_per_unit", "damping", "round_trip_frames", "wait_s"});
  JackDriverConfig config;
  const int slices = top.integer("slices", kSliceCount);
  if (top.has("client")) {
    config.client = top.word("client");
  }
  if (top.has("server")) {
    config.server = top.word("server");
  }
  config.position_ports = portsOf(settings, "position_ports", slices);
  config.force_ports = portsOf(settings, "force_ports", slices);
  if (top.has("heartbeat_port")) {
    config.heartbeat_port = portOf(settings, top.at("heartbeat_port"), "heartbeat_port");
    const auto& forces = config.force_ports;
    if (std::count(forces.begin(), forces.end(), config.heartbeat_port) > 0) {
      top.fail("heartbeat_port", "heartbeat_port is `" + config.heartbeat_port +
                                     "`, one of force_ports, allowed: any other port");
    }
  }
  config.volts_per_unit = top.number("volts_per_unit", kVolts, config.volts_per_unit);
  if (top.has("damping")) {
    config.damping = top.number("damping", kDamping);
  }
  if (top.has("round_trip_frames")) {
    config.round_trip_frames = top.integer("round_trip_frames", kRoundTrip);
  }
  config.wait_s = top.number("wait_s", kWait, config.wait_s);
  return config;
}

}  // namespace ergotic::tgr
