// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "ergotic/tgr/end_effector.hpp"
#include "scene/text/number.hpp"
#include "tgr/end_effectors/fields.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using scene::Place;
using scene::SceneBuilder;
using scene::YamlMap;

std::vector<std::string> keysOf(const TypeTraits& traits, EndEffectorType type) {
  std::vector<std::string> keys{"type", "slices", "ports", "position_scale", "force_scale", "pose"};
  for (const Dimension& dimension : traits.dimensions) {
    keys.emplace_back(dimension.key);
  }
  if (type == EndEffectorType::kHandle) {
    keys.emplace_back("points");
  }
  return keys;
}

std::vector<Eigen::Vector3d> readPoints(const SceneBuilder& builder, const YamlMap& map) {
  const scene::Node& list = map.at("points");
  if (!list.isList() || list.size() < kFewestPoints || list.size() > kMaxPoints) {
    map.fail("points", "'points' of " + map.what() + " is " + scene::kindOf(list) +
                           ", allowed: a list of " + std::to_string(kFewestPoints) + " to " +
                           std::to_string(kMaxPoints) + " points [x, y, z]");
  }
  std::vector<Eigen::Vector3d> points;
  for (const scene::Node& node : list) {
    const Place place = scene::placeOf(node, map.placeAt("points"));
    if (!node.isList() || node.size() != 3) {
      builder.fail(place, "a point of " + map.what() + " is " + scene::kindOf(node) +
                              ", allowed: [x, y, z]");
    }
    Eigen::Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[static_cast<Eigen::Index>(axis)] =
          scene::numberOf(builder, node[axis], "a point of " + map.what(), kPointLimits, place);
    }
    points.push_back(point);
  }
  return points;
}

std::vector<std::string> readPorts(const SceneBuilder& builder,
                                   const YamlMap& map,
                                   std::size_t coordinates) {
  const scene::Node& node = map.at("ports");
  if (coordinates == 1 && node.isScalar()) {
    return {map.word("ports")};
  }
  if (!node.isList() || node.size() != coordinates) {
    map.fail("ports", "'ports' of " + map.what() + " is " + scene::kindOf(node) +
                          ", allowed: a list of " + std::to_string(coordinates) +
                          ", one for each coordinate ('': none)");
  }
  std::vector<std::string> ports;
  for (const scene::Node& port : node) {
    ports.push_back(scene::wordOf(builder, port, "a port of " + map.what(), map.placeAt("ports")));
  }
  return ports;
}

EndEffectorConfig readOne(const SceneBuilder& builder,
                          const std::string& name,
                          Place place,
                          const scene::Node& node) {
  scene::checkName(builder, name, place);
  const YamlMap map(builder, node, "end-effector '" + name + "'", place);
  EndEffectorConfig config;
  config.name = name;
  config.place = place;
  config.type = static_cast<EndEffectorType>(map.choice("type", typeNames()));
  const TypeTraits& traits = traitsOf(config.type);
  map.allow(keysOf(traits, config.type));
  config.slices = map.integers("slices", static_cast<std::size_t>(traits.fewest_slices),
                               static_cast<std::size_t>(traits.most_slices), scene::kSliceLimits);
  if (config.type == EndEffectorType::kHandle) {
    config.points = readPoints(builder, map);
  }
  config.ports = readPorts(builder, map, coordinatesOf(config));
  config.position_scale =
      map.number("position_scale", scene::kPositionScaleLimits, config.position_scale);
  config.force_scale = map.number("force_scale", scene::kForceScaleLimits, config.force_scale);
  for (const Dimension& dimension : traits.dimensions) {
    double& value = config.*dimension.member;
    value = map.number(dimension.key, dimension.limits, value);
  }
  if (map.has("pose")) {
    config.pose = scene::poseOf(map.map("pose"));
  }
  return config;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    result += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  return result + "\"";
}

template <class List, class Text>
std::string listOf(const List& list, const Text& text) {
  std::string result;
  for (const auto& item : list) {
    result += (result.empty() ? "" : ", ") + text(item);
  }
  return "[" + result + "]";
}

std::string textOf(const EndEffectorConfig& config) {
  const std::string line = "\n    ";
  const auto vector = [](const Eigen::Vector3d& v) { return listOf(v, scene::shortest); };
  const TypeTraits& traits = traitsOf(config.type);
  std::string text = "  " + quoted(config.name) + ":" + line + "type: " + traits.name;
  text += line + "slices: " + listOf(config.slices, [](int s) { return std::to_string(s); });
  text += line + "ports: " + listOf(config.ports, quoted);
  text += line + "position_scale: " + scene::shortest(config.position_scale);
  text += line + "force_scale: " + scene::shortest(config.force_scale);
  for (const Dimension& dimension : traits.dimensions) {
    text += line + dimension.key + ": " + scene::shortest(config.*dimension.member);
  }
  if (config.type == EndEffectorType::kHandle) {
    text += line + "points: " + listOf(config.points, vector);
  }
  return text + line + "pose: {position: " + vector(config.pose.translation()) +
         ", rotation: " + vector(fixedAxisAngles(config.pose.linear())) + "}\n";
}

}  // namespace

EndEffectors readEndEffectors(const std::string& text, const std::string& name) {
  const Settings settings(parseSettings(text, name), name, "the file of devices and end-effectors");
  settings.top().allow({"devices", "end_effectors"});
  EndEffectors end_effectors;
  end_effectors.file = name;
  if (settings.top().has("end_effectors") && !settings.top().at("end_effectors").isNull()) {
    scene::forEachEntry(
        settings.builder(), settings.top().at("end_effectors"), "'end_effectors'",
        settings.top().keyPlaceAt("end_effectors"),
        [&](const std::string& key, Place place, const scene::Node& node) {
          end_effectors.list.push_back(readOne(settings.builder(), key, place, node));
        });
  }
  return end_effectors;
}

std::string toYaml(const EndEffectors& end_effectors) {
  if (end_effectors.list.empty()) {
    return "end_effectors: {}\n";
  }
  std::string text = "end_effectors:\n";
  for (const EndEffectorConfig& config : end_effectors.list) {
    text += textOf(config);
  }
  return text;
}

}  // namespace ergotic::tgr
