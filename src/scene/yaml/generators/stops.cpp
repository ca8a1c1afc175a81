// SPDX-License-Identifier: BSD-3-Clause
// What strings meet: frets, barriers, bridges.
#include "scene/generate/stops.hpp"

#include <algorithm>
#include <vector>

#include "ergotic/scene/table.hpp"
#include "scene/generate/bridge.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_keys.hpp"
#include "scene/yaml/yaml_tables.hpp"

namespace ergotic::scene {
namespace {

constexpr Limits kFretLimits{"", 1.0, 36.0};
constexpr Limits kHeightLimits{"m", 0.0};
constexpr std::size_t kMaxStrings = 64;

/// A string or bar by its name.
int readRow(const SceneBuilder& builder, const YamlMap& map, const std::string& name, Place place) {
  const int index = builder.grid(name, place);
  const Grid& grid = builder.scene().grids[static_cast<std::size_t>(index)];
  const Mat& first = builder.scene().mats[static_cast<std::size_t>(grid.first)];
  const Section& section = builder.scene().sectionOf(first);
  if (grid.rows > 1 || section.geometry != Geometry::kScalar) {
    builder.fail(place, map.what() + " is on " + quoted(name) + ", " +
                            (grid.rows > 1 ? "which has rows" : "which is in no scalar section") +
                            ", allowed: strings and bars of scalar sections");
  }
  return index;
}

StopsSpec readStops(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  StopsSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.grid = readRow(builder, map, map.word("along"), map.placeAt("along"));
  spec.damping = map.value("damping", kDampingLimits, {});
  return spec;
}

}  // namespace

void readFrets(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(fretsKeys());
  StopsSpec spec = readStops(builder, name, map);
  const int count = map.integer("count", kFretLimits);
  const bool is_from_last = map.has("nut") && map.choice("nut", {"first", "last"}) == 1;
  const std::vector<double> height = map.numbers("height", 1, 2, kHeightLimits);
  spec.are_points = true;
  spec.stops = fretsOf(count, height.front(), height.back(), is_from_last);
  addStops(builder, spec);
}

void readBarrier(SceneBuilder& builder,
                 const std::string& name,
                 const YamlMap& map,
                 YamlTables& tables) {
  map.allow(barrierKeys());
  StopsSpec spec = readStops(builder, name, map);
  const Table table = tables.read(map, "curve", {"", "m"});
  const Curve curve = interpolate(table);
  const Grid& grid = builder.scene().grids[static_cast<std::size_t>(spec.grid)];
  for (int i = 0; i < grid.columns; ++i) {
    const double along = static_cast<double>(i) / (grid.columns - 1);
    const Mat& mat = builder.scene().mats[static_cast<std::size_t>(grid.first + i)];
    const bool is_over = along >= table.points.front().first && along <= table.points.back().first;
    if (is_over && mat.type != MatType::kGround) {
      spec.stops.push_back({along, valueAt(curve, along)});
    }
  }
  if (spec.stops.empty()) {
    map.fail("curve", "'curve' of " + map.what() + " is beside all masses of " + quoted(grid.name) +
                          ", allowed: fractions along it that some lie at");
  }
  addStops(builder, spec);
}

void readBridge(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(bridgeKeys());
  BridgeSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  const Node& strings = map.at("of");
  if (!strings.isList() || strings.size() < 1 || strings.size() > kMaxStrings) {
    map.fail("of", "'of' of " + map.what() + " is " + kindOf(strings) +
                       ", allowed: a list of 1...64 strings");
  }
  spec.is_at_last = map.has("end") && map.choice("end", {"first", "last"}) == 1;
  for (const Node& string : strings) {
    const Place place = placeOf(string, map.placeAt("of"));
    const std::string word = wordOf(builder, string, "a string of " + map.what(), place);
    spec.grids.push_back(readRow(builder, map, word, place));
  }
  if (map.has("mat") == map.has("mass")) {
    builder.fail(map.place(), map.what() + " has " +
                                  (map.has("mat") ? "both 'mat' and" : "neither 'mat' nor") +
                                  " 'mass', allowed: exactly one of them");
  }
  if (map.has("mat")) {
    for (const char* const key : {"section", "stiffness", "resistance"}) {
      if (map.has(key)) {
        builder.fail(map.keyPlaceAt(key), quoted(key) + " of " + map.what() +
                                              " that lies on a module, allowed with 'mass'");
      }
    }
    spec.on = pointAt(builder, map.word("mat"), map.placeAt("mat"));
  } else {
    spec.section = sectionOf(builder, map);
    spec.mass = map.value("mass", kMassLimits);
    spec.stiffness = map.value("stiffness", kStiffnessLimits, {});
    spec.resistance = map.value("resistance", kDampingLimits, {});
  }
  spec.keeps_pitch = map.flag("keep_pitch", false);
  addBridge(builder, spec);
}

void readEnds(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  if (!map.has("ends")) {
    return;
  }
  const Node& ends = map.at("ends");
  const Place place = map.placeAt("ends");
  if (!ends.isList() || ends.size() != 2) {
    map.fail("ends", "'ends' of " + map.what() + " is " + kindOf(ends) +
                         ", allowed: a list of two, each 'ground' or a module or place");
  }
  BridgeSpec spec;
  spec.name = name;
  spec.grids = {readRow(builder, map, name, place)};
  spec.keeps_pitch = true;
  for (std::size_t i = 0; i < 2; ++i) {
    spec.place = placeOf(ends[i], place);
    const std::string word = wordOf(builder, ends[i], "an end of " + map.what(), spec.place);
    if (word != "ground") {
      spec.is_at_last = i == 1;
      spec.on = pointAt(builder, word, spec.place);
      addBridge(builder, spec);
    }
  }
}

}  // namespace ergotic::scene
