// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/string.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "ergotic/scene/coarse_string.hpp"
#include "scene/yaml/generators/body_keys.hpp"
#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr double kMaxBodyMasses = 2000.0;
constexpr Limits kImpedanceLimits{"N s/m", 0.0, kInfinity, true};
constexpr Limits kTensionLimits{"N", 0.0, kInfinity, true};
constexpr Limits kInharmonicityLimits{"", 0.0, 0.1};

/// Part of a link's stiffness that the string's tension leaves across the string.
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
  return 1.0 / transverseShare(builder, map, spec) *
         stringStiffness(spec.masses, spec.mass, spec.frequency_hz);
}

bool readCoarse(const SceneBuilder& builder, const YamlMap& map, const StringSpec& spec) {
  if (!map.flag("coarse", false)) {
    return false;
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
  return true;
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

void readPluck(const YamlMap& map, StringSpec& spec) {
  if (map.has("pluck")) {
    const YamlMap pluck = map.map("pluck");
    pluck.allow({"at", "height"});
    spec.pluck = Eigen::Vector2d(pluck.number("at", kInnerFractionLimits),
                                 pluck.number("height", kMetreLimits));
  }
}

/// Reads the mass of each moving mass: given, or by the impedance or the tension of the whole. A
/// string of mass m per metre and length L has Z = T/c = m c and f = c/(2 L), so that
/// m L = Z/(2 f) = T/(4 L f^2).
double readStringMass(const SceneBuilder& builder,
                      const YamlMap& map,
                      double pitch_hz,
                      int masses) {
  const std::vector<std::string> ways{"mass", "impedance", "tension"};
  const auto given =
      std::count_if(ways.begin(), ways.end(), [&](const std::string& key) { return map.has(key); });
  if (given != 1) {
    builder.fail(map.place(), map.what() + " has " + (given > 1 ? "more than one" : "none") +
                                  " of 'mass', 'impedance', 'tension', allowed: exactly one");
  }
  if (map.has("length") && !map.has("tension")) {
    builder.fail(map.keyPlaceAt("length"),
                 "'length' of " + map.what() + " without 'tension', allowed: with it");
  }
  if (map.has("mass")) {
    return map.number("mass", kMassLimits);
  }
  const double whole = map.has("impedance")
                           ? map.number("impedance", kImpedanceLimits) / (2.0 * pitch_hz)
                           : map.number("tension", kTensionLimits) /
                                 (4.0 * map.number("length", kSpacingLimits) * pitch_hz * pitch_hz);
  return whole / (masses + 1);
}

/// Reads a string that is tuned with its bending and its losses.
void readStringBody(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(tunedStringKeys());
  StringSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = bodySection(builder, map);
  const BodyForm form = readBodyForm(builder, map, false);
  spec.masses = readCount(map, "masses", {"", 1.0, kMaxBodyMasses}, form, kMassesOfModes);
  spec.wish = readBodyWish(builder, map);
  if (map.has("inharmonicity")) {
    spec.wish->inharmonicity = map.number("inharmonicity", kInharmonicityLimits);
  }
  const double fundamental_hz = spec.wish->pitch_hz / spec.wish->pitch_of;
  spec.mass.factor = readStringMass(builder, map, fundamental_hz, spec.masses);
  readStringPlaces(builder, map, spec);
  spec.wish->is_string = true;
  for (const char* const key : {"pluck", "ends"}) {
    if (form.is_modal && map.has(key)) {
      builder.fail(map.keyPlaceAt(key),
                   quoted(key) + " of " + map.what() + " of modes, allowed as: network");
    }
  }
  readPluck(map, spec);
  addBody(builder, name, spec.section, *spec.wish, form, spec.place,
          [&](SceneBuilder& to, int in, const BodyWish& wish) {
            StringSpec network = spec;
            network.section = in;
            network.wish = wish;
            addString(to, network);
          });
}

}  // namespace

void readString(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  if (map.has("pitch")) {
    readStringBody(builder, name, map);
    return;
  }
  map.allow(limpStringKeys());
  StringSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  spec.masses = map.integer("masses", {"", 1.0, kMaxMats - 2});
  spec.mass = map.value("mass", kMassLimits);
  spec.rest_length_ratio = readRestLengthRatio(builder, map, spec.section);
  spec.frequency_hz = map.number("frequency", kFrequencyLimits, 0.0);
  spec.stiffness = readStringStiffness(builder, map, spec);
  spec.coarse = readCoarse(builder, map, spec);
  spec.damping = map.value("damping", kDampingLimits, {});
  spec.scheme = readScheme(builder, map, sectionAt(builder, spec.section), spec.damping,
                           spec.rest_length_ratio);
  if (map.has("loss")) {
    spec.loss = map.value("loss", kDampingLimits);
  }
  readStringPlaces(builder, map, spec);
  readPluck(map, spec);
  addString(builder, spec);
}

}  // namespace ergotic::scene
