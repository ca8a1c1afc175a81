// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/tgr/driver.hpp"
#include "files/read_file.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "tgr/settings.hpp"

namespace ergotic::node {
namespace {

using Value = XmlRpc::XmlRpcValue;

constexpr double kLongestStallS = 1.0;
constexpr int kMaxStalls = 1'000'000;
constexpr double kLongestWatchdogS = 1.0;
constexpr int kMinPriority = 1;
constexpr int kMaxPriority = 99;
constexpr double kFrozenS = 0.1;  // the sensors of a TGR are noisier than their quantum

const std::map<std::string, physics::Precision> kPrecisions = {
    {"auto", physics::Precision::kAuto},
    {"float", physics::Precision::kFloat},
    {"double", physics::Precision::kDouble}};
const std::map<std::string, bool> kJack = {{"auto", true}, {"none", false}};
const std::map<std::string, Realtime> kRealtime = {
    {"try", Realtime::kTry}, {"require", Realtime::kRequire}, {"off", Realtime::kOff}};
const std::map<std::string, station::SwapForce> kForceAfterSwap = {
    {"loader", station::SwapForce::kCaller},
    {"always", station::SwapForce::kAlways},
    {"never", station::SwapForce::kNever}};
const std::map<std::string, MidiPrograms> kMidiPrograms = {{"simulated", MidiPrograms::kSimulated},
                                                           {"always", MidiPrograms::kAlways},
                                                           {"never", MidiPrograms::kNever}};
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

/// Reads a switch. YAML makes a boolean of `on`, `yes`, `true` and their opposites unless they are
/// quoted, `roslaunch` only of `true` and `false`. \return nothing if the value is neither
std::optional<bool> switchOf(const Value& given) {
  if (given.getType() == Value::TypeBoolean) {
    return static_cast<const bool&>(given);
  }
  return given.getType() == Value::TypeString
             ? scene::parseSwitch(static_cast<const std::string&>(given))
             : std::nullopt;
}

/// The word of a choice; `no`, `off` and `false` mean that among them which switches off.
std::string chosen(const Value& given, const std::vector<std::string>& words) {
  const auto isAllowed = [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (given.getType() == Value::TypeString && isAllowed(static_cast<const std::string&>(given))) {
    return static_cast<const std::string&>(given);
  }
  const std::optional<bool> is_on = switchOf(given);
  for (const char* const off : {"off", "none", "never"}) {
    if (is_on == false && isAllowed(off)) {
      return off;
    }
  }
  return "";
}

std::string shown(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

/// Describes a given value in words.
std::string described(const Value& given) {
  switch (given.getType()) {
    case Value::TypeBoolean:
      return static_cast<const bool&>(given) ? "true, for which YAML takes on and yes, too"
                                             : "false, for which YAML takes off and no, too";
    case Value::TypeInt:
      return "the number " + std::to_string(static_cast<const int&>(given));
    case Value::TypeDouble:
      return "the number " + shown(static_cast<const double&>(given));
    case Value::TypeString: {
      const auto& text = static_cast<const std::string&>(given);
      return text.empty() ? "empty" : "the text " + scene::quoted(text);
    }
    case Value::TypeArray:
      return "a list";
    case Value::TypeStruct:
      return "a map";
    default:
      return "of another type";
  }
}

/// Advice to quote a word that YAML took for another type; empty if it did not.
std::string howToQuote(const Value& given) {
  switch (given.getType()) {
    case Value::TypeBoolean:
    case Value::TypeInt:
    case Value::TypeDouble:
      return "; quote it for YAML and for the shell: \"'...'\"";
    default:
      return "";
  }
}

/// Reads parameters of one node; every refusal says name, value and what is allowed.
class Reader {
 public:
  Reader(const Value& values, std::string node) : node_(std::move(node)) {
    if (values.getType() == Value::TypeStruct) {
      unread_.insert(values.begin(), values.end());
    }
  }

  /// \param off  what it is where it is switched off, nullptr if it cannot be
  void text(const std::string& name, std::string& value, const char* off = nullptr) {
    const auto given = take(name);
    if (!given) {
      return;
    }
    if (off != nullptr && switchOf(*given) == false) {
      value = off;
    } else if (given->getType() == Value::TypeString) {
      value = static_cast<const std::string&>(*given);
    } else {
      refuse(name, described(*given), "a string" + howToQuote(*given));
    }
  }
  void flag(const std::string& name, bool& value) {
    if (const auto given = take(name)) {
      const std::optional<bool> on = switchOf(*given);
      if (!on) {
        refuse(name, described(*given), "true or false");
      }
      value = *on;
    }
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

  void number(const std::string& name,
              std::optional<double>& value,
              double minimum,
              double maximum) {
    const bool is_given = unread_.count(name) > 0;
    double number = 0.0;
    this->number(name, number, minimum, maximum);
    value = is_given ? std::optional(number) : value;
  }
  void integer(const std::string& name, std::optional<int>& value, int minimum, int maximum) {
    const bool is_given = unread_.count(name) > 0;
    int number = 0;
    integer(name, number, minimum, maximum);
    value = is_given ? std::optional(number) : value;
  }

  template <class T>
  void choice(const std::string& name, T& value, const std::map<std::string, T>& choices) {
    const auto given = take(name);
    if (!given) {
      return;
    }
    std::vector<std::string> words;
    for (const auto& [key, unused] : choices) {
      words.push_back(key);
    }
    const auto found = choices.find(chosen(*given, words));
    if (found == choices.end()) {
      const bool is_word = given->getType() == Value::TypeString;
      const std::string word = is_word ? static_cast<const std::string&>(*given) : "";
      refuse(name, word.empty() ? described(*given) : word, listed(words) + howToQuote(*given));
    }
    value = found->second;
  }

  /// Refuses parameters that no reader asked for, as misspelt. To be called after all readers.
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
        refuse(name, described(*given), allowed);
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

/// Writes the same parameters as YAML.
class Writer {
 public:
  explicit Writer(const tgr::StationDevices& devices) {
    out_ << YAML::BeginMap;
    entry("device", tgr::toYaml(devices));
  }

  void text(const char* name, const std::string& value, const char* /*off*/ = nullptr) {
    entry(name, value);
  }
  void flag(const char* name, bool value) { entry(name, value); }
  void number(const char* name, double value, double /*minimum*/, double /*maximum*/) {
    entry(name, value);
  }
  void integer(const char* name, int value, int /*minimum*/, int /*maximum*/) {
    entry(name, value);
  }
  void number(const char* name, std::optional<double> value, double /*minimum*/, double /*max*/) {
    if (value) {
      entry(name, *value);
    }
  }
  void integer(const char* name, std::optional<int> value, int /*minimum*/, int /*maximum*/) {
    if (value) {
      entry(name, *value);
    }
  }
  template <class T>
  void choice(const char* name, const T& value, const std::map<std::string, T>& choices) {
    const auto found = std::find_if(choices.begin(), choices.end(),
                                    [&](const auto& choice) { return choice.second == value; });
    entry(name, found->first);
  }
  /// Writes the name of the instruction set, not "best", which differs between machines.
  void choice(const char* name, rt::Isa value, const std::map<std::string, rt::Isa>& /*choices*/) {
    entry(name, nameOf(value));
  }
  std::string finish() {
    out_ << YAML::EndMap;
    return out_.c_str();
  }

 private:
  template <class T>
  void entry(const char* name, const T& value) {
    out_ << YAML::Key << name << YAML::Value << value;
  }

  YAML::Emitter out_;
};

/// \param on  Reader, or Writer
template <class Visitor, class Config>
void visitSafety(Visitor& on, Config& safety) {
  on.number("force_limit", safety.force_limit_n, 0.0, tgr::kAbsoluteForceLimitN);
  on.number("ramp", safety.ramp_s, 0.1, 10.0);
  on.number("resume_ramp", safety.resume_ramp_s, 0.005, 10.0);
  on.number("slew", safety.slew_n_per_s, 10.0, 1e6);
  on.number("raw_force_limit", safety.raw_force_limit_n, 1.0, 1e6);
  on.number("energy_limit", safety.energy_limit_j, 0.001, 100.0);
  on.number("energy_cap", safety.energy_cap_j, 0.001, 10.0);
  on.number("energy_supply", safety.energy_supply_w, 0.0, 20.0);
  on.number("slice_mass", safety.slice_mass_kg, 0.01, 100.0);
  on.flag("passivity_controller", safety.passivity_controller);
  on.number("position_limit", safety.position_limit_m, 0.001, 1.0);
  on.number("max_speed", safety.max_speed_m_per_s, 0.1, 100.0);
  on.number("frozen", safety.frozen_s, 0.0, 10.0);
  on.integer("max_missing", safety.max_missing, 0, 1000);
}

/// Visits all parameters but the model and the devices. \param p  parameters, constant for a Writer
template <class Visitor, class P>
void visitParameters(Visitor& on, P& p) {
  on.number("audio_rate", p.audio_rate, 8000.0, 192000.0);
  on.number("gestural_rate", p.gestural_rate, 0.0, 192000.0);
  on.choice("precision", p.compile.precision, kPrecisions);
  on.choice("isa", p.compile.isa, isas());
  on.integer("threads", p.compile.threads, 1, physics::kMaxThreads);
  on.flag("energies", p.compile.metered);
  on.choice("jack", p.jack, kJack);
  on.text("jack_name", p.jack_name);
  on.number("jack_wait", p.jack_wait, 0.0, 60.0);
  on.flag("jack_connect", p.jack_connect);
  on.text("midi_connect", p.midi_connect, "none");
  on.choice("midi_programs", p.midi_programs, kMidiPrograms);
  on.flag("gamepads", p.gamepads);
  on.integer("ring_depth", p.ring_depth, 1, station::AudioBridge::kMaxLatencyFrames);
  on.flag("limiter", p.limiter);
  visitSafety(on, p.safety);
  on.number("max_stall", p.max_stall, 0.001, kLongestStallS);
  on.integer("max_stalls", p.max_stalls, 1, kMaxStalls);
  on.number("watchdog", p.watchdog, 0.004, kLongestWatchdogS);
  on.choice("presence", p.presence, kPresence);
  on.flag("require_master", p.require_master);
  on.flag("allow_fault_injection", p.allow_fault_injection);
  on.integer("priority", p.priority, kMinPriority, kMaxPriority);
  on.integer("cpu", p.cpu, -1, 1023);
  on.choice("realtime", p.realtime, kRealtime);
  on.flag("allow_unproven", p.allow_unproven);
  on.number("max_load", p.max_load, 0.01, 1000.0);
  on.flag("autoengage", p.autoengage);
  on.choice("force_after_swap", p.force_after_swap, kForceAfterSwap);
  on.flag("allow_remote", p.allow_remote);
  on.text("tf_prefix", p.tf_prefix);
  on.number("display_rate", p.display_rate, 1.0, 60.0);
  on.number("display_zoom", p.display_zoom, 0.0, 1e6);
}

void requireMidiConnect(const std::string& wish, const std::string& node) {
  const std::string text = "parameter " + node + "/midi_connect is ";
  const char allowed[] =
      ", allowed: physical, none, or a part of the names of ports, a regular expression";
  if (wish.empty()) {
    throw Exception(text + "empty" + allowed);
  }
  try {
    const std::regex checked(wish, std::regex::extended);
  } catch (const std::regex_error&) {
    throw Exception(text + wish + allowed);
  }
}

void requireTfPrefix(const std::string& prefix, const std::string& node) {
  static const std::regex kNames("(\\w+(/\\w+)*)?");
  if (!std::regex_match(prefix, kNames)) {
    throw Exception("parameter " + node + "/tf_prefix is " + prefix +
                    ", allowed: letters, digits and _, with a / between names");
  }
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
  return {files::readFile(value, scene::kMaxTextBytes), value};
}

/// Makes one device without calibration, from `driver` and the settings of the virtual device.
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
  if (values.valid() && values.getType() != Value::TypeStruct) {  // it took the place of all others
    throw Exception("parameter " + node + " is no map, allowed: a map of parameters");
  }
  Parameters p;
  Reader read(values, node);
  read.text("model", p.model);
  read.text("device", p.device);
  read.text("driver", p.driver);
  read.text("driver_settings", p.driver_settings);
  read.text("gesture", p.gesture);
  read.text("virtual_shared_memory", p.virtual_shared_memory);
  read.text("end_effectors", p.end_effectors);
  p.compile = physics::liveOptions();
  p.safety.frozen_s = kFrozenS;
  visitParameters(read, p);
  read.refuseUnread();
  requireMidiConnect(p.midi_connect, node);
  requireTfPrefix(p.tf_prefix, node);
  return p;
}

EarlyParameters readEarlyParameters(const ::ros::NodeHandle& node) {
  Value values;
  node.getParam(node.getNamespace(), values);
  return readEarlyParameters(values, node.getNamespace());
}

EarlyParameters readEarlyParameters(const Value& values, const std::string& node) {
  EarlyParameters early;
  Reader read(values, node);
  const auto attempt = [&](const auto& one) {
    try {
      one();
    } catch (const Exception& refusal) {
      early.refusals.emplace_back(refusal.what());
    }
  };
  attempt([&] { read.flag("allow_remote", early.allow_remote); });
  attempt([&] { read.choice("realtime", early.realtime, kRealtime); });
  attempt([&] { read.integer("priority", early.priority, kMinPriority, kMaxPriority); });
  attempt([&] { read.flag("gamepads", early.gamepads); });
  attempt([&] {
    std::string prefix;
    read.text("tf_prefix", prefix);
    requireTfPrefix(prefix, node);
    early.tf_prefix = prefix;
  });
  return early;
}

Parameters withStallLimits(Parameters p, bool can_hurt) {
  p.max_stall = p.max_stall.value_or(can_hurt ? 0.05 : kLongestStallS);
  p.max_stalls = p.max_stalls.value_or(can_hurt ? 3 : kMaxStalls);
  p.watchdog = p.watchdog.value_or(can_hurt ? 0.02 : kLongestWatchdogS);
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
    devices.end_effectors = readEndEffectors(p.end_effectors);
  }
  return devices;
}

tgr::EndEffectors readEndEffectors(const std::string& path_or_text) {
  const Text text = textOrFile(path_or_text, "end_effectors");
  return tgr::readEndEffectors(text.text, text.name);
}

std::string toYaml(const Parameters& p, const tgr::StationDevices& devices) {
  Writer write(devices);
  visitParameters(write, p);
  return write.finish();
}

tgr::EndEffectors recordedEndEffectors(const std::string& yaml) {
  try {
    const auto device = YAML::Load(yaml)["device"].as<std::string>("");
    return device.empty() ? tgr::EndEffectors() : tgr::readDevices(device, "device").end_effectors;
  } catch (const YAML::Exception&) {
    return {};
  } catch (const Exception&) {
    return {};
  }
}

std::string unusual(const Parameters& p) {
  const YAML::Node usual = YAML::Load(toYaml(readParameters(Value(), ""), {}));
  std::ostringstream list;
  for (const auto& entry : YAML::Load(toYaml(p, {}))) {
    const auto& name = entry.first.Scalar();
    const YAML::Node& value = entry.second;
    const YAML::Node known = usual[name];
    if (!value.IsScalar() || (known && value.Scalar() == known.Scalar())) {
      continue;
    }
    list << (list.tellp() > 0 ? ", " : "") << name << ": ";
    if (double number = 0.0; YAML::convert<double>::decode(value, number)) {
      list << number;  // in as many digits as people write
    } else {
      list << value.Scalar();
    }
  }
  return list.str();
}

}  // namespace ergotic::node
