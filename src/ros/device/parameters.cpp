// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/tgr/driver.hpp"
#include "scene/names.hpp"
#include "tgr/settings.hpp"

namespace ergotic::node {
namespace {

using Value = XmlRpc::XmlRpcValue;

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

// Read in the same namespace by the diagnostic_updater, and by nodelet where the station is its
// own.
const std::vector<std::string> kReadByOthers = {"diagnostic_period", "num_worker_threads"};

/// Reads parameters of one node; every refusal says name, value and what is allowed.
class Reader {
 public:
  Reader(const Value& values, std::string node) : node_(std::move(node)) {
    if (values.getType() == Value::TypeStruct) {
      unread_.insert(values.begin(), values.end());
    }
  }

  void text(const std::string& name, std::string& value) {
    typed(name, value, Value::TypeString, "a string");
  }
  void flag(const std::string& name, bool& value) {
    typed(name, value, Value::TypeBoolean, "true or false");
  }

  void number(const std::string& name, double& value, double minimum, double maximum) {
    within(name, value, minimum, maximum, shown(minimum) + "..." + shown(maximum));
  }

  void integer(const std::string& name, int& value, int minimum, int maximum) {
    const std::string allowed =
        std::to_string(minimum) + "..." + std::to_string(maximum) + ", whole numbers";
    double number = value;
    within(name, number, minimum, maximum, allowed);
    if (number != std::round(number)) {
      refuse(name, shown(number), allowed);
    }
    value = static_cast<int>(number);
  }

  template <class T>
  void choice(const std::string& name, T& value, const std::map<std::string, T>& choices) {
    std::string word;
    text(name, word);
    if (word.empty()) {
      return;
    }
    const auto found = choices.find(word);
    if (found == choices.end()) {
      std::vector<std::string> words;
      for (const auto& [key, unused] : choices) {
        words.push_back(key);
      }
      refuse(name, word, listed(words));
    }
    value = found->second;
  }

  /// After all others: what none of them asked for is misspelt.
  void refuseUnread() {
    for (const std::string& name : kReadByOthers) {
      take(name);
    }
    if (unread_.empty()) {
      return;
    }
    const std::string& name = unread_.begin()->first;
    const std::string nearest = scene::suggestion(name, known_);
    throw Exception("parameter " + node_ + "/" + name + " is not known" +
                    (nearest.empty() ? ", allowed: " + listed(known_) : nearest));
  }

 private:
  static std::string shown(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
  }

  static std::string listed(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) {
      list += (list.empty() ? "" : ", ") + word;
    }
    return list;
  }

  /// \return its value if it was given
  std::optional<Value> take(const std::string& name) {
    known_.push_back(name);
    const auto node = unread_.extract(name);
    return node ? std::optional(node.mapped()) : std::nullopt;
  }

  template <class T>
  void typed(const std::string& name, T& value, Value::Type type, const std::string& allowed) {
    if (const auto given = take(name)) {
      if (given->getType() != type) {
        refuse(name, "of another type", allowed);
      }
      value = static_cast<const T&>(*given);
    }
  }

  void within(const std::string& name,
              double& value,
              double minimum,
              double maximum,
              const std::string& allowed) {
    if (const auto given = take(name)) {
      if (given->getType() == Value::TypeInt) {
        value = static_cast<const int&>(*given);
      } else if (given->getType() == Value::TypeDouble) {
        value = static_cast<const double&>(*given);
      } else {
        refuse(name, "of another type", allowed);
      }
      if (!(value >= minimum && value <= maximum)) {
        refuse(name, shown(value), allowed);
      }
    }
  }

  [[noreturn]] void refuse(const std::string& name,
                           const std::string& value,
                           const std::string& allowed) const {
    throw Exception("parameter " + node_ + "/" + name + " is " + value + ", allowed: " + allowed);
  }

  std::string node_;
  Value::ValueStruct unread_;
  std::vector<std::string> known_;
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

void readSafety(Reader& read, Parameters& p) {
  tgr::SafetyConfig& safety = p.safety;
  read.number("force_limit", safety.force_limit_n, 0.0, tgr::kAbsoluteForceLimitN);
  read.number("ramp", safety.ramp_s, 0.1, 10.0);
  read.number("resume_ramp", safety.resume_ramp_s, 0.005, 10.0);
  read.number("slew", safety.slew_n_per_s, 10.0, 1e6);
  read.number("raw_force_limit", safety.raw_force_limit_n, 1.0, 1e6);
  read.number("energy_limit", safety.energy_limit_j, 0.001, 100.0);
  read.number("energy_cap", safety.energy_cap_j, 0.001, 10.0);
  read.number("energy_supply", safety.energy_supply_w, 0.0, 20.0);
  read.number("slice_mass", safety.slice_mass_kg, 0.01, 100.0);
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
  const std::string place = "parameter driver_settings";
  YAML::Node settings = tgr::parseSettings(p.driver_settings, place);
  if (!p.gesture.empty()) {
    settings["gesture"] = p.gesture;
  }
  if (!p.virtual_shared_memory.empty()) {
    settings["shared_memory"] = p.virtual_shared_memory;
  }
  tgr::StationDevices devices;
  devices.file = "parameter driver";
  devices.devices.resize(1);
  devices.devices.front().driver = p.driver;
  devices.devices.front().settings = std::make_shared<const YAML::Node>(settings);
  devices.devices.front().place = place;
  return devices;
}

}  // namespace

Parameters readParameters(const ::ros::NodeHandle& node) {
  Value values;
  node.getParam(node.getNamespace(), values);
  return readParameters(values, node.getNamespace());
}

Parameters readParameters(const Value& values, const std::string& node) {
  Parameters p;
  Reader read(values, node);
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
  read.refuseUnread();
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
  entry("energy_cap", p.safety.energy_cap_j);
  entry("energy_supply", p.safety.energy_supply_w);
  entry("slice_mass", p.safety.slice_mass_kg);
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
