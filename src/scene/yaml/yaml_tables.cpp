// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_tables.hpp"

#include "scene/yaml/table_csv.hpp"

namespace ergotic::scene {
namespace {

std::string countText() {
  return "2..." + std::to_string(kMaxTablePoints);
}

}  // namespace

Table YamlTables::read(const YamlMap& map, const std::string& key, const TableUnits& units) {
  const Node& node = map.at(key);
  const std::string what = quoted(key) + " of " + map.what();
  Table table;
  if (node.isMap()) {
    table = readNamed(map.map(key), units);
  } else {
    table = readPoints(node, what, units, map.placeAt(key));
  }
  points_ += table.points.size();
  if (points_ > kMaxSceneTablePoints) {
    builder_.fail(map.place(), "the tables of the scene have more than " +
                                   std::to_string(kMaxSceneTablePoints) + " points");
  }
  return table;
}

/// `{points or file, interpolation}`
Table YamlTables::readNamed(const YamlMap& spec, const TableUnits& units) {
  spec.allow({"points", "file", "interpolation"});
  if (spec.has("points") == spec.has("file")) {
    builder_.fail(spec.place(), spec.what() + " has " + (spec.has("file") ? "both" : "neither") +
                                    " 'points' " + (spec.has("file") ? "and" : "nor") +
                                    " 'file', allowed: one of them");
  }
  Table table = spec.has("points")
                    ? readPoints(spec.at("points"), spec.what(), units, spec.placeAt("points"))
                    : readFile(spec, units);
  table.smooth =
      spec.has("interpolation") && spec.choice("interpolation", {"linear", "monotone"}) == 1;
  return table;
}

Table YamlTables::readPoints(const Node& points,
                             const std::string& what,
                             const TableUnits& units,
                             Place place) const {
  if (!points.isList() || points.size() < 2 || points.size() > kMaxTablePoints) {
    builder_.fail(place, what + " is not a list of points, allowed: " + countText() + " pairs");
  }
  Table table;
  for (const Node& point : points) {
    const Place at = placeOf(point, place);
    if (!point.isList() || point.size() != 2) {
      builder_.fail(at, "a point of " + what + " is not a pair of numbers");
    }
    const std::string first = "first number of a point of " + what;
    const double x = numberOf(builder_, point[0], first, {units.first}, at);
    const Limits increasing{"", table.empty() ? -kInfinity : table.points.back().first, kInfinity,
                            true};
    if (!increasing.hold(x)) {
      builder_.fail(at, outOfRange(first, x, increasing));
    }
    table.points.emplace_back(
        x, numberOf(builder_, point[1], "force of a point of " + what, {units.second}, at));
  }
  return table;
}

Table YamlTables::readFile(const YamlMap& spec, const TableUnits& units) {
  const std::string name = PointFiles::nameOf(spec);
  if (files_.isSelfContained()) {
    const PointFiles::Appended* appended = files_.find(PointFiles::Part::kTables, name);
    if (appended == nullptr) {
      spec.fail("file", "file " + quoted(name) + " of " + spec.what() +
                            " is not among the tables of the second document");
    }
    return readPoints(*appended->points, "table " + quoted(name), units, appended->place);
  }
  const auto known = known_.find(name);
  if (known != known_.end()) {
    return known->second;
  }
  const PointFiles::File file = files_.open(spec);
  Table table = readTableCsv(file.text, file.path);
  files_.keep(PointFiles::Part::kTables, name, table.points);
  return known_[name] = std::move(table);
}

}  // namespace ergotic::scene
