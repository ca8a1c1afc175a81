// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml_tables.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "ergotic/exception.hpp"
#include "scene/source_text.hpp"
#include "scene/table_csv.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kPart = "tables";
constexpr std::size_t kMaxFileNameBytes = 255;

std::string countText() {
  return "2..." + std::to_string(kMaxTablePoints);
}

/// Where a table file is: beside the scene.
std::string pathBeside(const std::string& scene_file, const std::string& name) {
  const std::size_t slash = scene_file.rfind('/');
  return slash == std::string::npos ? name : scene_file.substr(0, slash + 1) + name;
}

bool isFileName(const std::string& name) {
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < 0x20U || c == '\x7F';
  };
  return !name.empty() && name.size() <= kMaxFileNameBytes && name.front() != '/' &&
         std::none_of(name.begin(), name.end(), is_control);
}

/// The shortest text that reads back to the same bits.
void appendNumber(std::string& text, double value) {
  std::array<char, 32> digits{};
  const std::to_chars_result end = std::to_chars(digits.begin(), digits.end(), value);
  text.append(digits.data(), end.ptr);
}

/// `"name": [[x, y], ...]`
void appendTable(std::string& text, const std::string& name, const Table& table) {
  text += '"';
  for (const char c : name) {
    text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  text += "\": [";
  const char* comma = "";
  for (const auto& [x, y] : table.points) {
    text += comma;
    text += '[';
    appendNumber(text, x);
    text += ", ";
    appendNumber(text, y);
    text += ']';
    comma = ", ";
  }
  text += ']';
}

}  // namespace

YamlTables::YamlTables(SceneBuilder& builder, const YAML::Node* appended) : builder_(builder) {
  if (appended == nullptr) {
    return;
  }
  self_contained_ = true;
  const Place place = placeOf(*appended, {1, 1});
  if (!appended->IsMap() || appended->size() != 1 || !appended->begin()->first.IsScalar() ||
      appended->begin()->first.Scalar() != kPart) {
    builder_.fail(place,
                  "a second document, allowed: one in each file, and one after it that "
                  "begins with 'tables:'");
  }
  forEachEntry(builder_, appended->begin()->second, "'tables' of the second document", place,
               [this](const std::string& name, Place at, const YAML::Node& points) {
                 appended_[name] = {points, at};
               });
}

Table YamlTables::read(const YamlMap& map, const std::string& key) {
  const YAML::Node& node = map.at(key);
  const std::string what = quoted(key) + " of " + map.what();
  Table table;
  if (node.IsMap()) {
    table = readNamed(map.map(key));
  } else {
    table = readPoints(node, what, map.placeAt(key));
  }
  points_ += table.points.size();
  if (points_ > kMaxSceneTablePoints) {
    builder_.fail(map.place(), "the tables of the scene have more than " +
                                   std::to_string(kMaxSceneTablePoints) + " points");
  }
  return table;
}

/// `{points or file, interpolation}`
Table YamlTables::readNamed(const YamlMap& spec) {
  spec.allow({"points", "file", "interpolation"});
  if (spec.has("points") == spec.has("file")) {
    builder_.fail(spec.place(), spec.what() + " has " + (spec.has("file") ? "both" : "neither") +
                                    " 'points' " + (spec.has("file") ? "and" : "nor") +
                                    " 'file', allowed: one of them");
  }
  Table table = spec.has("points")
                    ? readPoints(spec.at("points"), spec.what(), spec.placeAt("points"))
                    : readFile(spec, spec.word("file"));
  table.smooth =
      spec.has("interpolation") && spec.choice("interpolation", {"linear", "monotone"}) == 1;
  return table;
}

Table YamlTables::readPoints(const YAML::Node& points, const std::string& what, Place place) const {
  if (!points.IsSequence() || points.size() < 2 || points.size() > kMaxTablePoints) {
    builder_.fail(place, what + " is not a list of points, allowed: " + countText() + " pairs");
  }
  Table table;
  for (const YAML::Node& point : points) {
    const Place at = placeOf(point, place);
    if (!point.IsSequence() || point.size() != 2) {
      builder_.fail(at, "a point of " + what + " is not a pair of numbers");
    }
    const std::string first = "first number of a point of " + what;
    const double x = numberOf(builder_, point[0], first, {}, at);
    const Limits increasing{"", table.empty() ? -kInfinity : table.points.back().first, kInfinity,
                            true};
    if (!increasing.hold(x)) {
      builder_.fail(at, outOfRange(first, x, increasing));
    }
    table.points.emplace_back(
        x, numberOf(builder_, point[1], "force of a point of " + what, kForceLimits, at));
  }
  return table;
}

Table YamlTables::readFile(const YamlMap& spec, const std::string& name) {
  if (!isFileName(name)) {
    spec.fail("file", "file " + quoted(name) + " of " + spec.what() +
                          " is no path from the scene's folder, allowed: 1..." +
                          std::to_string(kMaxFileNameBytes) + " bytes that do not begin with '/'");
  }
  if (self_contained_) {
    const auto found = appended_.find(name);
    if (found == appended_.end()) {
      spec.fail("file", "file " + quoted(name) + " of " + spec.what() +
                            " is not among the tables of the second document");
    }
    used_.insert(name);
    return readPoints(found->second.points, "table " + quoted(name), found->second.place);
  }
  const auto known = files_.find(name);
  if (known != files_.end()) {
    return known->second;
  }
  const std::string path = pathBeside(builder_.scene().file, name);
  const std::optional<std::string> text = readBytes(path);
  if (!text) {
    spec.fail("file",
              "cannot read " + quoted(path) + " of " + spec.what() + ": " + std::strerror(errno));
  }
  return files_[name] = readTableCsv(*text, path);
}

void YamlTables::finish() {
  for (const auto& [name, table] : appended_) {
    if (used_.count(name) == 0) {
      builder_.fail(table.place, "table " + quoted(name) + " is used by no link");
    }
  }
  if (files_.empty()) {
    return;
  }
  std::string& text = builder_.scene().text;
  const std::size_t written = text.size();
  text += text.empty() || text.back() == '\n' ? "---\n" : "\n---\n";
  const char* separator = "tables: {";
  for (const auto& [name, table] : files_) {
    text += separator;
    appendTable(text, name, table);
    separator = ",\n  ";
  }
  text += "}\n";
  if (text.size() > kMaxTextBytes) {
    builder_.fail({1, 1}, "the text has " + std::to_string(written) + " bytes and its tables " +
                              std::to_string(text.size() - written) + ", allowed: at most " +
                              std::to_string(kMaxTextBytes) + " in all");
  }
}

}  // namespace ergotic::scene
