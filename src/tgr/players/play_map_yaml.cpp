// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
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
constexpr Limits kAfterLimits{"s", 0.0, 1.0};
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

const std::vector<std::string>& keysOfMoves() {
  static const std::vector<std::string> keys = {
      "slices", "end_effector", "coordinates", "from",    "to",     "speed",
      "back",   "after",        "strikes",     "release", "legato", "pressure_to"};
  return keys;
}

/// What stays down until the key is released has no meaning for a hand that strikes.
void refuseBesideStrikes(const YamlMap& map, const char* key) {
  if (map.has(key)) {
    map.fail(key, "'" + std::string(key) + "' of " + map.what() +
                      " stands beside strikes, allowed: of hands that stay down");
  }
}

/// \param notes  how many notes the line has
KeyMove readKeyMove(const YamlMap& map, std::size_t notes) {
  KeyMove move;
  const Places places = readPlaces(map);
  move.end_effector = places.end_effector;
  move.indices = places.indices;
  move.from_m = map.number("from", kPlaceLimits, move.from_m);
  move.to_m = map.numbers("to", 1, notes, kPlaceLimits);
  if (move.to_m.size() != 1 && move.to_m.size() != notes) {
    map.fail("to", "'to' of " + map.what() + " has " + std::to_string(move.to_m.size()) +
                       " places, allowed: 1, or " + std::to_string(notes) + ", one for each note");
  }
  if (map.has("speed")) {
    const std::vector<double> speeds = map.numbers("speed", 1, 2, kSpeedLimits);
    move.slowest = speeds.front();
    move.fastest = speeds.back();
  }
  move.back = map.number("back", kSpeedLimits, move.back);
  move.after_s = map.number("after", kAfterLimits, move.after_s);
  move.strikes = map.flag("strikes", move.strikes);
  if (move.strikes) {
    for (const char* const key : {"release", "legato", "pressure_to"}) {
      refuseBesideStrikes(map, key);
    }
  }
  if (map.has("release")) {
    move.release = static_cast<Release>(map.choice("release", {"returns", "stays", "stops"}));
  }
  move.legato = move.release == Release::kReturns ? Legato::kLifts : Legato::kGlides;
  if (map.has("legato")) {
    move.legato = static_cast<Legato>(map.choice("legato", {"lifts", "glides", "turns"}));
  }
  if (map.has("pressure_to") && move.legato == Legato::kTurns) {
    map.fail("pressure_to", "'pressure_to' of " + map.what() +
                                " stands beside turns, allowed: of hands that stay down");
  }
  if (map.has("pressure_to")) {
    move.pressure_to_m = map.number("pressure_to", kPlaceLimits);
  }
  return move;
}

/// Calls `read` for each map of the list under a key, if there is one.
template <class Read>
void forEachOf(const scene::SceneBuilder& builder,
               const YamlMap& map,
               const std::string& key,
               const Read& read) {
  if (!map.has(key)) {
    return;
  }
  const scene::Node& list = map.at(key);
  if (!list.isList()) {
    map.fail(key, "'" + key + "' is " + scene::kindOf(list) + ", allowed: a list of maps");
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    read(YamlMap(builder, list[i], "entry " + std::to_string(i + 1) + " of '" + key + "'",
                 scene::placeOf(list[i], map.placeAt(key))));
  }
}

/// A note can send a hand to one place only, and coordinates of one end-effector move together.
void refuseTwice(const YamlMap& map, const std::vector<KeyMove>& moves, const KeyMove& other) {
  for (const KeyMove& move : moves) {
    const bool is_tool = !move.end_effector.empty() && move.end_effector == other.end_effector;
    const bool is_slice =
        move.end_effector.empty() && other.end_effector.empty() &&
        std::any_of(move.indices.begin(), move.indices.end(), [&other](int index) {
          return std::count(other.indices.begin(), other.indices.end(), index) > 0;
        });
    if (is_tool || is_slice) {
      const char* const key = is_tool ? "end_effector" : "slices";
      map.fail(key, "'" + std::string(key) + "' of " + map.what() +
                        " names what its line moves already, allowed: another");
    }
  }
}

KeyLine readKeys(const scene::SceneBuilder& builder, const YamlMap& map) {
  std::vector<std::string> keys = keysOfMoves();
  keys.insert(keys.begin(), {"notes", "with", "bend", "slide"});
  map.allow(keys);
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
  const auto notes = static_cast<std::size_t>(line.last_note - line.first_note + 1);
  line.moves.push_back(readKeyMove(map, notes));
  forEachOf(builder, map, "with", [&](const YamlMap& other) {
    other.allow(keysOfMoves());
    const KeyMove move = readKeyMove(other, notes);
    refuseTwice(other, line.moves, move);
    line.moves.push_back(move);
  });
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

}  // namespace

PlayMap readPlayMap(const std::string& text, const std::string& name) {
  const Settings settings(parseSettings(text, name), name, "the map of notes");
  settings.top().allow({"keys", "controllers", "gamepad", "transpose", "mpe"});
  PlayMap map;
  const auto for_each_of = [&](const char* key, const auto& read) {
    forEachOf(settings.builder(), settings.top(), key, read);
  };
  for_each_of("keys",
              [&](const YamlMap& line) { map.keys.push_back(readKeys(settings.builder(), line)); });
  for_each_of("controllers",
              [&](const YamlMap& line) { map.controls.push_back(readControl(line)); });
  map.has_gamepad = settings.top().has("gamepad");
  for_each_of("gamepad", [&](const YamlMap& line) { readGamepad(line, map); });
  if (settings.top().has("transpose")) {
    map.transpose = settings.top().integer("transpose", kTransposeLimits);
  }
  if (settings.top().has("mpe")) {
    map.mpe = settings.top().flag("mpe", false);
  }
  return map;
}

}  // namespace ergotic::tgr
