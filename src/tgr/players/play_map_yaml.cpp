// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/keyboard.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using scene::Limits;
using scene::YamlMap;

constexpr Limits kNoteLimits{"", 0.0, 127.0};
constexpr Limits kIndexLimits{"", 0.0, kMaxSlices - 1.0};
constexpr Limits kPlaceLimits{"m", -1.0, 1.0};
constexpr Limits kSpeedLimits{"m/s", 0.001, 2.0};
constexpr Limits kTransposeLimits{"", -60.0, 60.0};

KeyLine readKeys(const YamlMap& map) {
  map.allow(
      {"notes", "slices", "end_effector", "coordinates", "from", "to", "speed", "back", "strikes"});
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
  const bool is_of_tool = map.has("end_effector");
  line.end_effector = is_of_tool ? map.word("end_effector") : "";
  line.indices = map.integers(is_of_tool ? "coordinates" : "slices", 1, kMaxSlices, kIndexLimits);
  line.from_m = map.number("from", kPlaceLimits, line.from_m);
  line.to_m = map.number("to", kPlaceLimits);
  if (map.has("speed")) {
    const std::vector<double> speeds = map.numbers("speed", 1, 2, kSpeedLimits);
    line.slowest = speeds.front();
    line.fastest = speeds.back();
  }
  line.back = map.number("back", kSpeedLimits, line.back);
  line.strikes = map.flag("strikes", line.strikes);
  return line;
}

ControllerLine readController(const YamlMap& map) {
  map.allow({"controller", "parameter"});
  return {map.integer("controller", kNoteLimits), map.word("parameter")};
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
  settings.top().allow({"keys", "controllers", "transpose"});
  PlayMap map;
  forEachOf(settings, "keys", [&](const YamlMap& line) { map.keys.push_back(readKeys(line)); });
  forEachOf(settings, "controllers",
            [&](const YamlMap& line) { map.controllers.push_back(readController(line)); });
  if (settings.top().has("transpose")) {
    map.transpose = settings.top().integer("transpose", kTransposeLimits);
  }
  return map;
}

}  // namespace ergotic::tgr
