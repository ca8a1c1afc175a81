// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/players/play_map.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using scene::Limits;
using scene::YamlMap;

constexpr Limits kNoteLimits{"", 0.0, 127.0};
constexpr Limits kVelocityLimits{"", 1.0, 127.0};
constexpr Limits kIndexLimits{"", 0.0, kMaxSlices - 1.0};
constexpr Limits kPlaceLimits{"m", -1.0, 1.0};
constexpr Limits kSpeedLimits{"m/s", 0.001, 2.0};
constexpr Limits kTransposeLimits{"", -60.0, 60.0};

/// Slices, or coordinates of an end-effector.
struct Places {
  std::string end_effector;
  std::vector<int> indices;
};
Places readPlaces(const YamlMap& map) {
  const bool is_of_tool = map.has("end_effector");
  return {is_of_tool ? map.word("end_effector") : "",
          map.integers(is_of_tool ? "coordinates" : "slices", 1, kMaxSlices, kIndexLimits)};
}

/// Reads the motion of a map, which may also have the keys `others`.
Motion readMotion(const YamlMap& map, std::vector<std::string> others) {
  Motion motion;
  if (map.has("parameter") || (!map.has("slices") && !map.has("end_effector"))) {
    others.emplace_back("parameter");
    map.allow(others);
    motion.parameter = map.word("parameter");
    return motion;
  }
  for (const char* const key : {"slices", "end_effector", "coordinates", "from", "to", "speed"}) {
    others.emplace_back(key);
  }
  map.allow(others);
  const Places places = readPlaces(map);
  motion.end_effector = places.end_effector;
  motion.indices = places.indices;
  motion.from_m = map.number("from", kPlaceLimits, motion.from_m);
  motion.to_m = map.number("to", kPlaceLimits);
  motion.speed = map.number("speed", kSpeedLimits, motion.speed);
  return motion;
}

std::optional<Motion> readMotionUnder(const char* key, const YamlMap& line) {
  return line.has(key) ? std::optional(readMotion(line.map(key), {})) : std::nullopt;
}

KeyLine readKeys(const YamlMap& map) {
  map.allow({"notes", "slices", "end_effector", "coordinates", "from", "to", "speed", "back",
             "strikes", "pressure_to", "bend", "slide"});
  KeyLine line;
  if (map.has("notes")) {
    const std::vector<int> notes = map.integers("notes", 1, 2, kNoteLimits);
    line.first_note = notes.front();
    line.last_note = notes.back();
  }
  if (line.last_note < line.first_note) {
    map.fail("notes", "'notes' of " + map.what() + " ends at " + std::to_string(line.last_note) +
                          ", allowed: " + std::to_string(line.first_note) + " or more");
  }
  const Places places = readPlaces(map);
  line.end_effector = places.end_effector;
  line.indices = places.indices;
  line.from_m = map.number("from", kPlaceLimits, line.from_m);
  line.to_m = map.number("to", kPlaceLimits);
  if (map.has("speed")) {
    const std::vector<double> speeds = map.numbers("speed", 1, 2, kSpeedLimits);
    line.slowest = speeds.front();
    line.fastest = speeds.back();
  }
  line.back = map.number("back", kSpeedLimits, line.back);
  line.strikes = map.flag("strikes", line.strikes);
  if (map.has("pressure_to")) {
    if (line.strikes) {
      map.fail("pressure_to", "'pressure_to' of " + map.what() +
                                  " stands beside strikes, allowed: of hands that stay down");
    }
    line.pressure_to_m = map.number("pressure_to", kPlaceLimits);
  }
  line.bend = readMotionUnder("bend", map);
  line.slide = readMotionUnder("slide", map);
  return line;
}

ControlLine readControl(const YamlMap& map) {
  const std::vector<std::pair<std::string, Control::Kind>> controls = {
      {"controller", Control::Kind::kController},
      {"bend", Control::Kind::kBend},
      {"pressure", Control::Kind::kPressure}};
  ControlLine line;
  std::string named;
  for (const auto& [key, kind] : controls) {
    if (!map.has(key)) {
      continue;
    }
    if (!named.empty()) {
      map.fail(key,
               map.what() + " has both '" + named + "' and '" + key + "', allowed: one of them");
    }
    named = key;
    line.control.kind = kind;
  }
  if (line.control.kind == Control::Kind::kController) {
    line.control.number = map.integer("controller", kNoteLimits);
  } else if (!map.flag(named, false)) {
    map.fail(named, "'" + named + "' of " + map.what() + " is false, allowed: true");
  }
  line.motion = readMotion(map, {"controller", "bend", "pressure"});
  return line;
}

/// A button, or an axis.
void readGamepad(const YamlMap& map, PlayMap& play_map) {
  if (map.has("button")) {
    map.allow({"button", "note", "velocity"});
    ButtonLine line;
    line.button = static_cast<int>(map.choice("button", gamepadButtonNames()));
    line.note = map.integer("note", kNoteLimits);
    line.velocity = map.has("velocity") ? map.integer("velocity", kVelocityLimits) : line.velocity;
    play_map.buttons.push_back(line);
    return;
  }
  ControlLine line;
  line.control.kind = Control::Kind::kAxis;
  line.control.number = static_cast<int>(map.choice("axis", gamepadAxisNames()));
  line.motion = readMotion(map, {"axis"});
  play_map.controls.push_back(line);
}

/// Calls `read` for each map of the list under a key, if there is one.
template <class Read>
void forEachOf(const Settings& settings, const std::string& key, const Read& read) {
  const YamlMap& top = settings.top();
  if (!top.has(key)) {
    return;
  }
  const scene::Node& list = top.at(key);
  if (!list.isList()) {
    top.fail(key, "'" + key + "' is " + scene::kindOf(list) + ", allowed: a list of maps");
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    read(YamlMap(settings.builder(), list[i],
                 "entry " + std::to_string(i + 1) + " of '" + key + "'",
                 scene::placeOf(list[i], top.placeAt(key))));
  }
}

}  // namespace

PlayMap readPlayMap(const std::string& text, const std::string& name) {
  const Settings settings(parseSettings(text, name), name, "the map of notes");
  settings.top().allow({"keys", "controllers", "gamepad", "transpose", "mpe"});
  PlayMap map;
  forEachOf(settings, "keys", [&](const YamlMap& line) { map.keys.push_back(readKeys(line)); });
  forEachOf(settings, "controllers",
            [&](const YamlMap& line) { map.controls.push_back(readControl(line)); });
  map.has_gamepad = settings.top().has("gamepad");
  forEachOf(settings, "gamepad", [&](const YamlMap& line) { readGamepad(line, map); });
  if (settings.top().has("transpose")) {
    map.transpose = settings.top().integer("transpose", kTransposeLimits);
  }
  if (settings.top().has("mpe")) {
    map.mpe = settings.top().flag("mpe", false);
  }
  return map;
}

}  // namespace ergotic::tgr
