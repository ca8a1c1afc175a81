// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

const std::vector<std::string>& geometryNames() {
  static const std::vector<std::string> kNames = {"scalar", "line", "plane", "space"};
  return kNames;
}

void readRate(const YamlMap& map, Section& section) {
  if (!map.has("rate")) {
    return;
  }
  if (map.at("rate").isMap()) {
    const YamlMap rate = map.map("rate");
    rate.allow({"divisor"});
    section.divisor = rate.integer("divisor", kDivisorLimits);
    return;
  }
  const std::size_t word = map.choice("rate", {"audio", "gestural", "auto"});
  section.gestural = word == 1;
  section.automatic_rate = word == 2;
}

/// `all`, `auto` or a number of modes.
int readModes(const YamlMap& map) {
  const std::string word = map.word("modes");
  if (word == "all") {
    return kAllModes;
  }
  if (word == "auto") {
    return kAutomaticModes;
  }
  if (word.empty() || std::isdigit(static_cast<unsigned char>(word.front())) == 0) {
    map.fail("modes", "'modes' of " + map.what() + " is " + quoted(word) +
                          ", allowed: all, auto or a number of modes");
  }
  return map.integer("modes", kModesLimits);
}

Section readSection(const std::string& name, const YamlMap& map) {
  map.allow(sectionKeys());
  Section section;
  section.name = name;
  section.place = map.place();
  readRate(map, section);
  if (map.has("geometry")) {
    section.geometry = static_cast<Geometry>(map.choice("geometry", geometryNames()));
  }
  section.gravity = readMoving(section, map, "gravity", kGravityLimits, Eigen::Vector3d::Zero());
  section.medium = map.value("medium", kDampingLimits, {});
  section.sleep_energy = map.number("sleep", kSleepLimits, 0.0);
  section.starts_in_balance =
      map.has("start") && map.choice("start", {"as_written", "equilibrium"}) == 1;
  if (map.has("modes")) {
    section.modes = readModes(map);
  }
  if (map.has("pose")) {
    section.pose = poseOf(map.map("pose"));
  }
  return section;
}

}  // namespace

void readSections(SceneBuilder& builder, const YamlMap& top) {
  top.at("sections");
  forEachElement(
      builder, top, "sections", "section",
      [&](const std::string& name, const YamlMap& map) { builder.add(readSection(name, map)); });
  if (builder.scene().sections.empty()) {
    top.fail("sections", "the scene has no section, allowed: at least one");
  }
}

int sectionOf(const SceneBuilder& builder, const YamlMap& map) {
  if (map.has("section")) {
    return builder.section(map.word("section"), map.placeAt("section"));
  }
  if (builder.scene().sections.size() == 1) {
    return 0;
  }
  std::string names;
  for (const Section& section : builder.scene().sections) {
    names += (names.empty() ? "" : ", ") + section.name;
  }
  builder.fail(map.place(), "missing key 'section' of " + map.what() + ", allowed: " + names);
}

Eigen::Vector3d readRest(const Section& section, const YamlMap& map, const std::string& key) {
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();
  if (section.geometry == Geometry::kScalar) {
    const std::vector<double> yz = map.vector(key, 2, kMetreLimits);
    rest.tail<2>() << yz[0], yz[1];
  } else if (map.has(key)) {
    const auto moving = static_cast<std::size_t>(dimensionsOf(section.geometry));
    const std::vector<double> numbers = map.numbers(key, moving, 3, kMetreLimits);
    std::copy(numbers.begin(), numbers.end(), rest.begin());
  }
  return rest;
}

Eigen::Vector3d readMoving(const Section& section,
                           const YamlMap& map,
                           const std::string& key,
                           const Limits& limits,
                           const Eigen::Vector3d& otherwise) {
  if (!map.has(key)) {
    return otherwise;
  }
  const auto moving = static_cast<std::size_t>(dimensionsOf(section.geometry));
  const std::vector<double> numbers = map.numbers(key, moving, moving, limits);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  std::copy(numbers.begin(), numbers.end(), result.begin());
  return result;
}

void refuseIn(const SceneBuilder& builder,
              const Section& section,
              const YamlMap& map,
              const std::vector<std::string>& keys,
              const std::string& allowed) {
  for (const std::string& key : keys) {
    if (map.has(key)) {
      builder.fail(map.keyPlaceAt(key),
                   quoted(key) + " of " + map.what() + " has no meaning in section " +
                       quoted(section.name) + " of geometry " +
                       geometryNames()[static_cast<std::size_t>(section.geometry)] +
                       ", allowed: " + allowed);
    }
  }
}

}  // namespace ergotic::scene
