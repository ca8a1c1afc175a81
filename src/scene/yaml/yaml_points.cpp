// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <optional>
#include <utility>

#include "scene/generate/points.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

using Way = Connection::Way;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// The entry for one way under a key: an item of `[along, across]`, or, for the first way, the
/// whole value, if it is no such list. nullopt: there is none.
std::optional<YamlMap> saidOf(const SceneBuilder& builder,
                              const YamlMap& map,
                              const std::string& key,
                              bool is_list,
                              std::size_t way) {
  if (!map.has(key)) {
    return std::nullopt;
  }
  if (!is_list) {
    return way == 0 ? std::optional<YamlMap>(map) : std::nullopt;
  }
  const Node& both = map.at(key);
  if (both.size() != 2) {
    map.fail(key, quoted(key) + " of " + map.what() + " is a list of " +
                      std::to_string(both.size()) + ", allowed: [along, across]");
  }
  if (both[way].isNull()) {
    return std::nullopt;
  }
  return YamlMap(builder, {{key, map.placeAt(key, way), &both[way]}}, map.what(), map.place());
}

void refuseListOnString(const YamlMap& map, const std::string& key, const Grid& grid) {
  if (grid.rows == 1) {
    map.fail(key, quoted(key) + " of " + map.what() + " tells of two ways, string " +
                      quoted(grid.name) + " has one");
  }
}

/// `range: [lowest, highest]`, on a mesh that along it, or `[[lowest, highest], [lowest,
/// highest]]`.
void readRange(const SceneBuilder& builder,
               const YamlMap& map,
               const Grid& grid,
               std::size_t index,
               Way& way) {
  const bool is_list = map.has("range") && map.at("range").isList() && map.at("range").size() > 0 &&
                       !map.at("range")[0].isScalar();
  if (is_list) {
    refuseListOnString(map, "range", grid);
  }
  const std::optional<YamlMap> said = saidOf(builder, map, "range", is_list, index);
  if (!said) {
    return;
  }
  const std::vector<double> range = said->vector("range", 2, kFractionLimits);
  if (range[0] > range[1]) {
    said->fail("range", "'range' of " + map.what() + " is [" + numberText(range[0]) + ", " +
                            numberText(range[1]) + "], allowed: [lowest, highest]");
  }
  way.minimum = range[0];
  way.maximum = range[1];
}

/// `guide: {mat, axis, scale}`, on a mesh that along it, or a list of one along and one across.
void readGuide(const SceneBuilder& builder,
               const YamlMap& map,
               const Grid& grid,
               std::size_t index,
               Way& way) {
  const bool is_list = map.has("guide") && map.at("guide").isList();
  if (is_list) {
    refuseListOnString(map, "guide", grid);
  }
  const std::optional<YamlMap> said = saidOf(builder, map, "guide", is_list, index);
  if (!said) {
    return;
  }
  const YamlMap guide = said->map("guide");
  guide.allow({"mat", "axis", "scale"});
  way.guide = builder.mat(guide.word("mat"), guide.placeAt("mat"));
  way.scale = guide.number("scale", kGuideScaleLimits);
  const Mat& mat = builder.scene().mats[static_cast<std::size_t>(way.guide)];
  if (mat.type == MatType::kPoint) {
    guide.fail("mat", map.what() + " is guided by point " + quoted(mat.name) +
                          ", allowed: modules of any other type");
  }
  if (guide.has("axis")) {
    way.axis = static_cast<int>(guide.choice("axis", {kAxes.begin(), kAxes.end()}));
  }
  const int last = dimensionsOf(builder.scene().sectionOf(mat).geometry) - 1;
  if (way.axis > last) {
    guide.fail("axis",
               "'axis' of " + guide.what() + " is " + kAxes[static_cast<std::size_t>(way.axis)] +
                   ", allowed: along which " + quoted(mat.name) + " moves, x" +
                   (last > 0 ? std::string(" to ") + kAxes[static_cast<std::size_t>(last)] : ""));
  }
}

/// `at: u` on a string, `at: [u, v]` on a mesh.
void readStart(const SceneBuilder& builder,
               const YamlMap& map,
               const Grid& grid,
               Connection& connection) {
  const auto limitsOf = [](const Way& way) { return Limits{"", way.minimum, way.maximum}; };
  if (grid.rows == 1) {
    connection.along.at = map.value("at", limitsOf(connection.along));
    return;
  }
  const Node& pair = map.at("at");
  if (!pair.isList() || pair.size() != 2) {
    map.fail("at", "'at' of " + map.what() + " is no place on mesh " + quoted(grid.name) +
                       ", allowed: [along, across]");
  }
  const std::string what = " number of 'at' of " + map.what();
  connection.along.at =
      valueOf(builder, pair[0], "first" + what, limitsOf(connection.along), map.placeAt("at"));
  connection.across.at =
      valueOf(builder, pair[1], "second" + what, limitsOf(connection.across), map.placeAt("at"));
}

}  // namespace

void readPoint(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  Connection connection;
  connection.place = map.place();
  connection.grid = builder.grid(map.word("along"), map.placeAt("along"));
  const Grid& grid = builder.scene().grids[static_cast<std::size_t>(connection.grid)];
  Way* const ways[] = {&connection.along, &connection.across};
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    readRange(builder, map, grid, i, *ways[i]);
    readGuide(builder, map, grid, i, *ways[i]);
  }
  readStart(builder, map, grid, connection);
  connection.speed = map.number("speed", kPointSpeedLimits, 0.0);
  connection.power = map.number("power", kPointPowerLimits, connection.power);
  addPoint(builder, name, connection);
}

}  // namespace ergotic::scene
