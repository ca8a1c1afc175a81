// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <map>
#include <sstream>

#include "ergotic/exception.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::node {
namespace {

const std::map<std::string, physics::Precision> kPrecisions = {
    {"float", physics::Precision::kFloat}, {"double", physics::Precision::kDouble}};
const std::map<std::string, bool> kJack = {{"auto", true}, {"none", false}};
const std::map<std::string, Realtime> kRealtime = {
    {"try", Realtime::kTry}, {"require", Realtime::kRequire}, {"off", Realtime::kOff}};
const std::map<std::string, std::string> kDrivers = {{"virtual", "virtual"}};

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

}  // namespace

Parameters readParameters(const ::ros::NodeHandle& node) {
  Parameters p;
  const Reader read(node);
  read.text("model", p.model);
  read.choice("driver", p.driver, kDrivers);
  read.text("gesture", p.gesture);
  read.text("virtual_shared_memory", p.virtual_shared_memory);
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
  read.number("force_limit", p.force_limit, 0.0, tgr::kAbsoluteForceLimitN);
  read.number("ramp", p.ramp, 0.1, 10.0);
  read.number("max_stall", p.max_stall, 0.001, 1.0);
  read.integer("priority", p.priority, 1, 99);
  read.integer("cpu", p.cpu, -1, 1023);
  read.choice("realtime", p.realtime, kRealtime);
  read.flag("allow_unproven", p.allow_unproven);
  read.flag("autoengage", p.autoengage);
  read.number("display_rate", p.display_rate, 1.0, 60.0);
  read.number("display_zoom", p.display_zoom, 0.0, 1e6);
  return p;
}

std::string toYaml(const Parameters& p) {
  YAML::Emitter out;
  const auto entry = [&out](const char* name, const auto& value) {
    out << YAML::Key << name << YAML::Value << value;
  };
  out << YAML::BeginMap;
  entry("driver", p.driver);
  entry("gesture", p.gesture);
  entry("virtual_shared_memory", p.virtual_shared_memory);
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
  entry("force_limit", p.force_limit);
  entry("ramp", p.ramp);
  entry("max_stall", p.max_stall);
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
