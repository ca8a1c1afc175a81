// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tree/yaml_map.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "scene/text/number.hpp"
#include "scene/text/quantity.hpp"

namespace ergotic::scene {
namespace {

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool isNameCharacter(char c) {
  return isLetter(c) || (c >= '0' && c <= '9') || c == '.' || c == '-';
}

}  // namespace

std::string kindOf(const Node& node) {
  switch (node.kind()) {
    case Node::Kind::kScalar:
      return "a single value";
    case Node::Kind::kList:
      return "a list of " + std::to_string(node.size());
    case Node::Kind::kMap:
      return "a map";
    case Node::Kind::kNull:
      break;
  }
  return "empty";
}

Place placeOf(const Node& node, Place fallback) {
  // Of a missing value it is wherever the next token is.
  return node.isNull() || node.place().line == 0 ? fallback : node.place();
}

std::string wordOf(const SceneBuilder& builder,
                   const Node& node,
                   const std::string& what,
                   Place fallback) {
  if (!node.isScalar()) {
    builder.fail(placeOf(node, fallback),
                 what + " is " + kindOf(node) + ", allowed: a single value");
  }
  return node.text();
}

double numberOf(const SceneBuilder& builder,
                const Node& node,
                const std::string& what,
                const Limits& limits,
                Place fallback) {
  return numberIn(builder, wordOf(builder, node, what, fallback), what, limits,
                  placeOf(node, fallback));
}

double numberIn(const SceneBuilder& builder,
                const std::string& text,
                const std::string& what,
                const Limits& limits,
                Place place) {
  if (text.find('$') != std::string::npos) {
    builder.fail(place, what + " = " + quoted(text) +
                            " cannot follow a parameter, allowed: a constant, " + limits.text());
  }
  const auto quantity = parseQuantity(text, limits.unit);
  if (const auto* const none = std::get_if<NoQuantity>(&quantity)) {
    builder.fail(place, what + " = " + quoted(text) + none->reason + ", allowed: " + limits.text());
  }
  const double number = std::get<double>(quantity);
  if (!limits.hold(number)) {
    builder.fail(place, outOfRange(what, number, limits));
  }
  return number;
}

Value valueOf(const SceneBuilder& builder,
              const Node& node,
              const std::string& what,
              const Limits& limits,
              Place fallback) {
  const std::string text = wordOf(builder, node, what, fallback);
  const Place place = placeOf(node, fallback);
  const std::size_t dollar = text.find('$');
  if (dollar == std::string::npos) {
    return {numberIn(builder, text, what, limits, place), -1};
  }
  // `$name` or `number*$name`
  double factor = 1.0;
  if (dollar > 0) {
    const std::size_t end = text.find_last_not_of(' ', dollar - 1);
    const bool product = end != std::string::npos && text[end] == '*';
    const std::optional<double> number =
        product ? parseNumber(trimmed(text.substr(0, end))) : std::nullopt;
    if (!number) {
      builder.fail(place, what + " = " + quoted(text) +
                              " is not understood, allowed: a number, $name or number*$name");
    }
    factor = *number;
  }
  const int index = builder.parameter(trimmed(text.substr(dollar + 1)), place);
  const Parameter& parameter = builder.scene().parameters[static_cast<std::size_t>(index)];
  if (dollar == 0 && !areOfOneKind(parameter.unit, limits.unit)) {
    builder.fail(place, what + " follows parameter " + quoted(parameter.name) + ", which is in " +
                            parameter.unit + ", allowed: " + limits.text());
  }
  for (const double end : {parameter.minimum, parameter.maximum}) {
    if (!limits.hold(factor * end)) {
      builder.fail(place,
                   outOfRange(what + " (where " + parameter.name + " = " + numberText(end) + ")",
                              factor * end, limits));
    }
  }
  return {factor, index};
}

void forEachEntry(const SceneBuilder& builder,
                  const Node& node,
                  const std::string& what,
                  Place fallback,
                  const MapEntry& entry) {
  if (!node.isMap()) {
    builder.fail(placeOf(node, fallback), what + " is " + kindOf(node) + ", allowed: a map");
  }
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i + 1 < node.parts().size(); i += 2) {
    const Place place = placeOf(node[i], fallback);
    const std::string key = wordOf(builder, node[i], "a key of " + what, fallback);
    if (!seen.insert(key).second) {
      builder.fail(place, "key " + quoted(key) + " of " + what + " comes twice");
    }
    entry(key, place, node[i + 1]);
  }
}

void checkName(const SceneBuilder& builder, const std::string& name, Place place) {
  if (name.empty() || name.size() > kMaxNameBytes || !isLetter(name.front()) ||
      !std::all_of(name.begin(), name.end(), isNameCharacter)) {
    builder.fail(place, "name " + quoted(name) + " is not legal, allowed: a letter or '_', then " +
                            "letters, digits, '_', '.', '-', at most " +
                            std::to_string(kMaxNameBytes));
  }
}

YamlMap::YamlMap(const SceneBuilder& builder, const Node& node, std::string what, Place place)
    : builder_(builder), what_(std::move(what)), place_(place) {
  forEachEntry(builder, node, what_, place,
               [this](const std::string& key, Place key_place, const Node& value) {
                 entries_.push_back({key, key_place, &value});
               });
}

YamlMap::YamlMap(const SceneBuilder& builder,
                 std::vector<Entry> entries,
                 std::string what,
                 Place place)
    : builder_(builder), what_(std::move(what)), place_(place), entries_(std::move(entries)) {}

void YamlMap::allow(const std::vector<std::string>& keys) const {
  for (const Entry& entry : entries_) {
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end()) {
      builder_.fail(entry.place, "unknown key " + named(entry.key) + suggestion(entry.key, keys));
    }
  }
}

const YamlMap::Entry* YamlMap::find(const std::string& key) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&key](const Entry& e) { return e.key == key; });
  return entry == entries_.end() ? nullptr : &*entry;
}

const YamlMap::Entry& YamlMap::require(const std::string& key) const {
  const Entry* entry = find(key);
  if (entry == nullptr) {
    builder_.fail(place_, "missing key " + named(key));
  }
  return *entry;
}

std::string YamlMap::named(const std::string& key) const {
  return quoted(key) + " of " + what_;
}

const Node& YamlMap::at(const std::string& key) const {
  return *require(key).value;
}

Place YamlMap::placeAt(const std::string& key) const {
  const Entry& entry = require(key);
  return placeOf(*entry.value, entry.place);
}

Place YamlMap::placeAt(const std::string& key, std::size_t index) const {
  const Node& value = at(key);
  return placeOf(value.isList() ? value[index] : value, placeAt(key));
}

Place YamlMap::keyPlaceAt(const std::string& key) const {
  return require(key).place;
}

void YamlMap::fail(const std::string& key, const std::string& message) const {
  builder_.fail(placeAt(key), message);
}

std::string YamlMap::word(const std::string& key) const {
  const Entry& entry = require(key);
  return wordOf(builder_, *entry.value, named(key), entry.place);
}

std::size_t YamlMap::choice(const std::string& key, const std::vector<std::string>& words) const {
  const std::string text = word(key);
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) {
    fail(key, "unknown " + key + " " + named(text) + suggestion(text, words));
  }
  return static_cast<std::size_t>(found - words.begin());
}

double YamlMap::number(const std::string& key, const Limits& limits) const {
  const Entry& entry = require(key);
  return numberOf(builder_, *entry.value, named(key), limits, entry.place);
}

double YamlMap::number(const std::string& key, const Limits& limits, double otherwise) const {
  return has(key) ? number(key, limits) : otherwise;
}

int YamlMap::integer(const std::string& key, const Limits& limits) const {
  const std::string text = word(key);
  const std::optional<int> whole = parseInteger(text);
  if (!whole) {
    number(key, limits);  // says it if this is no number at all, or out of range
    fail(key,
         named(key) + " = " + quoted(text) + " is not a whole number, allowed: " + limits.text());
  }
  if (!limits.hold(*whole)) {
    fail(key, outOfRange(named(key), *whole, limits));
  }
  return *whole;
}

std::vector<double> YamlMap::vector(const std::string& key,
                                    std::size_t count,
                                    const Limits& limits) const {
  return has(key) ? list(key, count, count, limits) : std::vector<double>(count, 0.0);
}

std::vector<double> YamlMap::numbers(const std::string& key,
                                     std::size_t fewest,
                                     std::size_t most,
                                     const Limits& limits) const {
  if (fewest == 1 && at(key).isScalar()) {
    return {number(key, limits)};
  }
  return list(key, fewest, most, limits);
}

std::vector<int> YamlMap::integers(const std::string& key,
                                   std::size_t fewest,
                                   std::size_t most,
                                   const Limits& limits) const {
  std::vector<int> result;
  for (const double number : numbers(key, fewest, most, limits)) {
    if (number != std::floor(number)) {
      builder_.fail(placeAt(key, result.size()),
                    named(key) + " = " + numberText(number) +
                        " is not a whole number, allowed: " + limits.text());
    }
    result.push_back(static_cast<int>(number));
  }
  return result;
}

std::vector<double> YamlMap::list(const std::string& key,
                                  std::size_t fewest,
                                  std::size_t most,
                                  const Limits& limits) const {
  const Node& node = at(key);
  if (!node.isList() || node.size() < fewest || node.size() > most) {
    const std::string count =
        std::to_string(fewest) + (most > fewest ? " to " + std::to_string(most) : std::string());
    fail(key, named(key) + " is " + kindOf(node) +
                  ", allowed: " + (fewest == 1 ? "a number or " : "") + "a list of " + count +
                  (most == 1 ? " number" : " numbers"));
  }
  std::vector<double> result;
  for (const Node& item : node) {
    result.push_back(numberOf(builder_, item, named(key), limits, placeAt(key)));
  }
  return result;
}

bool YamlMap::flag(const std::string& key, bool otherwise) const {
  if (!has(key)) {
    return otherwise;
  }
  const std::optional<bool> is_on = parseSwitch(word(key));
  return is_on ? *is_on : choice(key, {"false", "true"}) == 1;  // which says what is allowed
}

Value YamlMap::value(const std::string& key, const Limits& limits) const {
  const Entry& entry = require(key);
  return valueOf(builder_, *entry.value, named(key), limits, entry.place);
}

Value YamlMap::value(const std::string& key, const Limits& limits, const Value& otherwise) const {
  return has(key) ? value(key, limits) : otherwise;
}

YamlMap YamlMap::map(const std::string& key) const {
  const Entry& entry = require(key);
  return YamlMap(builder_, *entry.value, named(key), entry.place);
}

Eigen::Isometry3d poseOf(const YamlMap& pose) {
  pose.allow({"position", "rotation"});
  const std::vector<double> position = pose.vector("position", 3, kMetreLimits);
  const std::vector<double> rotation = pose.vector("rotation", 3, kAngleLimits);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translate(Eigen::Vector3d(position[0], position[1], position[2]));
  result.rotate(Eigen::AngleAxisd(rotation[2], Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rotation[1], Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(rotation[0], Eigen::Vector3d::UnitX()));
  return result;
}

}  // namespace ergotic::scene
