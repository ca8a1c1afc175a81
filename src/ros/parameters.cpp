// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <map>
#include <sstream>

#include "ergotic/exception.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::node {
namespace {

constexpr double kFrozenS = 0.1;  // the sensors of a TGR are noisier than their quantum

const std::map<std::string, physics::Precision> kPrecisions = {
    {"float", physics::Precision::kFloat}, {"double", physics::Precision::kDouble}};
const std::map<std::string, bool> kJack = {{"auto", true}, {"none", false}};
const std::map<std::string, Realtime> kRealtime = {
    {"try", Realtime::kTry}, {"require", Realtime::kRequire}, {"off", Realtime::kOff}};
const std::map<std::string, bool> kPresence = {{"topic", true}, {"none", false}};

std::map<std::string, rt::Isa> isas() {
  std::map<std::string, rt::Isa> choices{{"best", rt::bestIsa()}};
  for (const rt::Isa isa : rt::isas()) {
    choices.emplace(nameOf(isa), isa);
  }
  return choices;
}

/// Reads parameters of one node; every refusal says name, value and what is allowed.
class Reader {
 public:
  explicit Reader(const ::ros::NodeHandle& node) : node_(node) {}

  void text(const std::string& name, std::string& value) const { typed(name, value, "a string"); }
  void flag(const std::string& name, bool& value) const { typed(name, value, "true or false"); }

  void number(const std::string& name, double& value, double minimum, double maximum) const {
    typed(name, value, "a number");
    if (!(value >= minimum && value <= maximum)) {
      std::ostringstream range;
      range << minimum << "..." << maximum;
      refuse(name, std::to_string(value), range.str());
    }
  }

  void integer(const std::string& name, int& value, int minimum, int maximum) const {
    typed(name, value, "an integer");
    if (value < minimum || value > maximum) {
      refuse(name, std::to_string(value),
             std::to_string(minimum) + "..." + std::to_string(maximum));
    }
  }

  template <class T>
  void choice(const std::string& name, T& value, const std::map<std::string, T>& choices) const {
    std::string word;
    text(name, word);
    if (word.empty()) {
      return;
    }
    const auto found = choices.find(word);
    if (found == choices.end()) {
      std::string allowed;
      for (const auto& [key, unused] : choices) {
        allowed += (allowed.empty() ? "" : ", ") + key;
      }
      refuse(name, word, allowed);
    }
    value = found->second;
  }

 private:
  template <class T>
  void typed(const std::string& name, T& value, const std::string& what) const {
    if (node_.hasParam(name) && !node_.getParam(name, value)) {
      refuse(name, "of another type", what);
    }
  }

  [[noreturn]] void refuse(const std::string& name,
                           const std::string& value,
                           const std::string& allowed) const {
    throw Exception("parameter " + node_.resolveName(name) + " is " + value +
                    ", allowed: " + allowed);
  }

  const ::ros::NodeHandle& node_;
};

template <class T>
std::string wordOf(const T& value, const std::map<std::string, T>& choices) {
  for (const auto& [word, meaning] : choices) {
    if (meaning == value) {
      return word;
    }
  }
  return "";
}

void readSafety(const Reader& read, Parameters& p) {
  tgr::SafetyConfig& safety = p.safety;
  read.number("force_limit", safety.force_limit_n, 0.0, tgr::kAbsoluteForceLimitN);
  read.number("ramp", safety.ramp_s, 0.1, 10.0);
  read.number("resume_ramp", safety.resume_ramp_s, 0.005, 10.0);
  read.number("slew", safety.slew_n_per_s, 10.0, 1e6);
  read.number("raw_force_limit", safety.raw_force_limit_n, 1.0, 1e6);
  read.number("energy_limit", safety.energy_limit_j, 0.001, 100.0);
  read.flag("passivity_controller", safety.passivity_controller);
  read.number("position_limit", safety.position_limit_m, 0.001, 1.0);
  read.number("max_speed", safety.max_speed_m_per_s, 0.1, 100.0);
  safety.frozen_s = kFrozenS;
  read.number("frozen", safety.frozen_s, 0.0, 10.0);
  read.integer("max_missing", safety.max_missing, 0, 1000);
  read.number("max_stall", p.max_stall, 0.001, 1.0);
  read.number("watchdog", p.watchdog, 0.004, 1.0);
  read.choice("presence", p.presence, kPresence);
  read.flag("require_master", p.require_master);
  read.flag("allow_fault_injection", p.allow_fault_injection);
}

/// A path, or a text of more than one line.
struct Text {
  std::string text;
  std::string name;
};
Text textOrFile(const std::string& value, const std::string& inline_name) {
  if (value.find('\n') != std::string::npos) {
    return {value, inline_name};
  }
  std::ifstream file(value);
  if (!file) {
    throw Exception(value + ": cannot be read, allowed: a path, or YAML of more than one line");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return {text.str(), value};
}

/// One device without calibration, as `driver` and the settings of the virtual one say.
tgr::StationDevices plainDevice(const Parameters& p) {
  const bool is_virtual = !p.gesture.empty() || !p.virtual_shared_memory.empty();
  if (is_virtual && !p.driver_settings.empty()) {
    throw Exception(
        "parameter driver_settings stands beside gesture or virtual_shared_memory, allowed: all "
        "of them in driver_settings");
  }
  YAML::Emitter settings;
  settings << YAML::Flow << YAML::BeginMap;
  if (!p.gesture.empty()) {
    settings << YAML::Key << "gesture" << YAML::Value << p.gesture;
  }
  if (!p.virtual_shared_memory.empty()) {
    settings << YAML::Key << "shared_memory" << YAML::Value << p.virtual_shared_memory;
  }
  settings << YAML::EndMap;
  tgr::StationDevices devices;
  devices.file = "parameter driver";
  devices.devices.resize(1);
  devices.devices.front().driver = p.driver;
  devices.devices.front().settings =
      p.driver_settings.empty() ? settings.c_str() : p.driver_settings;
  devices.devices.front().place = "parameter driver_settings";
  return devices;
}

}  // namespace

Parameters readParameters(const ::ros::NodeHandle& node) {
  Parameters p;
  const Reader read(node);
  read.text("model", p.model);
  read.text("device", p.device);
  read.text("driver", p.driver);
  read.text("driver_settings", p.driver_settings);
  read.text("gesture", p.gesture);
  read.text("virtual_shared_memory", p.virtual_shared_memory);
  read.text("end_effectors", p.end_effectors);
  read.number("audio_rate", p.audio_rate, 8000.0, 192000.0);
  read.number("gestural_rate", p.gestural_rate, 0.0, 192000.0);
  read.choice("precision", p.compile.precision, kPrecisions);
  read.choice("isa", p.compile.isa, isas());
  read.integer("threads", p.compile.threads, 1, physics::kMaxThreads);
  p.compile.wait_limit_ns = physics::kLiveWaitNs;
  read.flag("energies", p.compile.metered);
  read.choice("jack", p.jack, kJack);
  read.text("jack_name", p.jack_name);
  read.number("jack_wait", p.jack_wait, 0.0, 60.0);
  read.flag("jack_connect", p.jack_connect);
  read.integer("ring_depth", p.ring_depth, 1, station::AudioBridge::kMaxLatencyFrames);
  readSafety(read, p);
  read.integer("priority", p.priority, 1, 99);
  read.integer("cpu", p.cpu, -1, 1023);
  read.choice("realtime", p.realtime, kRealtime);
  read.flag("allow_unproven", p.allow_unproven);
  read.flag("autoengage", p.autoengage);
  read.number("display_rate", p.display_rate, 1.0, 60.0);
  read.number("display_zoom", p.display_zoom, 0.0, 1e6);
  return p;
}

tgr::StationDevices readDevices(const Parameters& p) {
  tgr::StationDevices devices;
  if (p.device.empty()) {
    devices = plainDevice(p);
  } else {
    const Text device = textOrFile(p.device, "device");
    devices = tgr::readDevices(device.text, device.name);
  }
  if (!p.end_effectors.empty()) {
    const Text text = textOrFile(p.end_effectors, "end_effectors");
    devices.end_effectors = tgr::readEndEffectors(text.text, text.name);
  }
  return devices;
}

std::string toYaml(const Parameters& p, const tgr::StationDevices& devices) {
  YAML::Emitter out;
  const auto entry = [&out](const char* name, const auto& value) {
    out << YAML::Key << name << YAML::Value << value;
  };
  out << YAML::BeginMap;
  entry("device", tgr::toYaml(devices));
  entry("audio_rate", p.audio_rate);
  entry("gestural_rate", p.gestural_rate);
  entry("precision", nameOf(p.compile.precision));
  entry("isa", nameOf(p.compile.isa));
  entry("threads", p.compile.threads);
  entry("energies", p.compile.metered);
  entry("jack", wordOf(p.jack, kJack));
  entry("jack_name", p.jack_name);
  entry("jack_wait", p.jack_wait);
  entry("jack_connect", p.jack_connect);
  entry("ring_depth", p.ring_depth);
  entry("force_limit", p.safety.force_limit_n);
  entry("ramp", p.safety.ramp_s);
  entry("resume_ramp", p.safety.resume_ramp_s);
  entry("slew", p.safety.slew_n_per_s);
  entry("raw_force_limit", p.safety.raw_force_limit_n);
  entry("energy_limit", p.safety.energy_limit_j);
  entry("passivity_controller", p.safety.passivity_controller);
  entry("position_limit", p.safety.position_limit_m);
  entry("max_speed", p.safety.max_speed_m_per_s);
  entry("frozen", p.safety.frozen_s);
  entry("max_missing", p.safety.max_missing);
  entry("max_stall", p.max_stall);
  entry("watchdog", p.watchdog);
  entry("presence", wordOf(p.presence, kPresence));
  entry("require_master", p.require_master);
  entry("allow_fault_injection", p.allow_fault_injection);
  entry("priority", p.priority);
  entry("cpu", p.cpu);
  entry("realtime", wordOf(p.realtime, kRealtime));
  entry("allow_unproven", p.allow_unproven);
  entry("autoengage", p.autoengage);
  entry("display_rate", p.display_rate);
  entry("display_zoom", p.display_zoom);
  out << YAML::EndMap;
  return out.c_str();
}

}  // namespace ergotic::node
