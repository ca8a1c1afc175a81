// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "ergotic/scene/coarse_string.hpp"
#include "scene/generate/generators.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

const Section& sectionAt(const SceneBuilder& builder, int index) {
  return builder.scene().sections[static_cast<std::size_t>(index)];
}

/// 0 in scalar sections, where the key is refused.
double readRestLengthRatio(const SceneBuilder& builder, const YamlMap& map, int section) {
  if (sectionAt(builder, section).geometry == Geometry::kScalar) {
    refuseIn(builder, sectionAt(builder, section), map, {"rest_length_ratio"},
             "line, plane, space");
  }
  return map.number("rest_length_ratio", kFractionLimits, 0.0);
}

/// Of links with a rest length; without one there is nothing to guard.
Scheme readScheme(const YamlMap& map, double rest_length_ratio) {
  const bool guarded = map.has("scheme") && map.choice("scheme", {"explicit", "guarded"}) == 1;
  if (guarded && !(rest_length_ratio > 0.0)) {
    map.fail("scheme", "'scheme' of " + map.what() +
                           " is guarded without a rest length, allowed: explicit, or "
                           "'rest_length_ratio' above 0");
  }
  return guarded ? Scheme::kGuarded : Scheme::kExplicit;
}

/// What a string's own tension leaves of a link's stiffness across the string.
double transverseShare(const SceneBuilder& builder, const YamlMap& map, const StringSpec& spec) {
  if (dimensionsOf(sectionAt(builder, spec.section).geometry) == 1) {
    return 1.0;
  }
  if (spec.rest_length_ratio == 1.0) {
    map.fail("rest_length_ratio",
             "'rest_length_ratio' of " + map.what() +
                 " = 1 leaves no tension for 'frequency', allowed: below 1, or 'stiffness'");
  }
  return 1.0 - spec.rest_length_ratio;
}

Value readStringStiffness(const SceneBuilder& builder, const YamlMap& map, const StringSpec& spec) {
  if (map.has("stiffness") == map.has("frequency")) {
    builder.fail(map.has("stiffness") ? map.keyPlaceAt("stiffness") : map.place(),
                 map.what() + " has " + (map.has("stiffness") ? "both" : "neither") +
                     " 'stiffness' and 'frequency', allowed: exactly one of them");
  }
  if (map.has("stiffness")) {
    return map.value("stiffness", kStiffnessLimits);
  }
  const double frequency_hz = map.number("frequency", kFrequencyLimits);
  return 1.0 / transverseShare(builder, map, spec) *
         stringStiffness(spec.masses, spec.mass, frequency_hz);
}

/// The frequency of a coarse string, 0 of an ordinary one.
double readCoarse(const SceneBuilder& builder, const YamlMap& map, const StringSpec& spec) {
  if (!map.flag("coarse", false)) {
    return 0.0;
  }
  const Section& section = sectionAt(builder, spec.section);
  if (section.geometry != Geometry::kScalar) {
    refuseIn(builder, section, map, {"coarse"}, "scalar");
  }
  if (!map.has("frequency")) {
    builder.fail(map.keyPlaceAt("stiffness"), "'stiffness' of " + map.what() +
                                                  " is fitted for a coarse string, allowed: "
                                                  "'frequency'");
  }
  if (spec.masses < kFewestCoarseMasses) {
    map.fail("masses", outOfRange("'masses' of coarse " + map.what(), spec.masses,
                                  {"", kFewestCoarseMasses, kMaxMats - 2}));
  }
  return map.number("frequency", kFrequencyLimits);
}

void readStringPlaces(const SceneBuilder& builder, const YamlMap& map, StringSpec& spec) {
  const Section& section = sectionAt(builder, spec.section);
  map.at("to");
  spec.from = readRest(section, map, "from");
  spec.to = readRest(section, map, "to");
  const int moving = dimensionsOf(section.geometry);
  if (section.geometry != Geometry::kScalar && spec.from.head(moving) == spec.to.head(moving)) {
    map.fail("to", "'to' of " + map.what() + " is where it comes from, allowed in section " +
                       quoted(section.name) + ": another place");
  }
}

void readString(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "masses", "mass", "stiffness", "frequency", "coarse",
             "damping", "loss", "rest_length_ratio", "scheme", "from", "to", "pluck"});
  StringSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  spec.masses = map.integer("masses", {"", 1.0, kMaxMats - 2});
  spec.mass = map.value("mass", kMassLimits);
  spec.rest_length_ratio = readRestLengthRatio(builder, map, spec.section);
  spec.scheme = readScheme(map, spec.rest_length_ratio);
  spec.stiffness = readStringStiffness(builder, map, spec);
  spec.corrected_hz = readCoarse(builder, map, spec);
  spec.damping = map.value("damping", kDampingLimits, {});
  if (map.has("loss")) {
    spec.loss = map.value("loss", kDampingLimits);
  }
  readStringPlaces(builder, map, spec);
  if (map.has("pluck")) {
    const YamlMap pluck = map.map("pluck");
    pluck.allow({"at", "height"});
    spec.pluck = Eigen::Vector2d(pluck.number("at", kInnerFractionLimits),
                                 pluck.number("height", kMetreLimits));
  }
  addString(builder, spec);
}

void readMesh(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "rows", "columns", "spacing", "at", "neighbours", "mass",
             "stiffness", "diagonal_stiffness", "damping", "rest_length_ratio", "scheme", "edges"});
  MeshSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  if (map.has("edges")) {
    spec.edges = static_cast<MeshEdges>(map.choice("edges", {"fixed", "free", "corners"}));
  }
  const Limits sides{"", spec.edges == MeshEdges::kFixed ? 3.0 : 2.0, kMaxMats / 2};
  spec.rows = map.integer("rows", sides);
  spec.columns = map.integer("columns", sides);
  spec.spacing = map.number("spacing", kSpacingLimits);
  spec.at = readRest(sectionAt(builder, spec.section), map, "at");
  spec.mass = map.value("mass", kMassLimits);
  spec.stiffness = map.value("stiffness", kStiffnessLimits);
  spec.damping = map.value("damping", kDampingLimits, {});
  spec.rest_length_ratio = readRestLengthRatio(builder, map, spec.section);
  spec.scheme = readScheme(map, spec.rest_length_ratio);
  if (map.has("neighbours") && map.choice("neighbours", {"4", "8"}) == 1) {
    spec.diagonal_stiffness =
        map.value("diagonal_stiffness", kStiffnessLimits, 0.5 * spec.stiffness);
  } else if (map.has("diagonal_stiffness")) {
    builder.fail(map.keyPlaceAt("diagonal_stiffness"), "'diagonal_stiffness' of " + map.what() +
                                                           " without diagonals, allowed with "
                                                           "neighbours: 8");
  }
  addMesh(builder, spec);
}

void readChaplet(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "from", "mass", "at"});
  ChapletSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  const Section& section = sectionAt(builder, spec.section);
  if (section.gestural || section.automatic_rate || section.divisor != 1 ||
      section.geometry != Geometry::kScalar) {
    builder.fail(map.has("section") ? map.placeAt("section") : map.place(),
                 map.what() + " is in section " + quoted(section.name) +
                     ", allowed: scalar sections with rate: audio");
  }
  spec.from = builder.mat(map.word("from"), map.placeAt("from"));
  spec.mass = map.value("mass", kMassLimits);
  const Mat& carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];
  const Eigen::Vector3d at = map.has("at") ? readRest(section, map, "at") : carrier.rest;
  spec.at = at.tail<2>();
  addChaplet(builder, spec);
}

}  // namespace

void readGenerators(SceneBuilder& builder, const YamlMap& top) {
  if (!top.has("generators")) {
    return;
  }
  const YAML::Node& list = top.at("generators");
  if (!list.IsSequence()) {
    top.fail("generators", "'generators' is not a list, allowed: a list of maps");
  }
  for (const YAML::Node& node : list) {
    const YamlMap map(builder, node, "generator", placeOf(node, top.placeAt("generators")));
    constexpr void (*kReaders[])(SceneBuilder&, const std::string&, const YamlMap&) = {
        readString, readMesh, readChaplet};
    const std::size_t type = map.choice("type", {"string", "mesh", "chaplet"});
    const std::string name = map.word("name");
    checkName(builder, name, map.placeAt("name"));
    kReaders[type](builder, name, map);
  }
}

}  // namespace ergotic::scene
