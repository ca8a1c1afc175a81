// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/generators/generator_keys.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace ergotic::scene {

const Section& sectionAt(const SceneBuilder& builder, int index) {
  return builder.scene().sections[static_cast<std::size_t>(index)];
}

double readRestLengthRatio(const SceneBuilder& builder, const YamlMap& map, int section) {
  if (sectionAt(builder, section).geometry == Geometry::kScalar) {
    refuseIn(builder, sectionAt(builder, section), map, {"rest_length_ratio"},
             "line, plane, space");
  }
  return map.number("rest_length_ratio", kFractionLimits, 0.0);
}

Scheme schemeAskedFor(SceneBuilder& builder, const YamlMap& map) {
  constexpr Scheme kSchemes[] = {Scheme::kAuto, Scheme::kExplicit, Scheme::kEnergyStable};
  if (!map.has("scheme")) {
    return Scheme::kAuto;
  }
  if (map.word("scheme") != "guarded") {
    return kSchemes[map.choice("scheme", {"auto", "explicit", "energy_stable"})];
  }
  const std::string told = "'scheme: guarded' is the old word for 'scheme: energy_stable'";
  const std::vector<std::string>& warnings = builder.scene().warnings;
  if (std::none_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
        return warning.find(told) != std::string::npos;
      })) {
    builder.warn(map.placeAt("scheme"), told);
  }
  return Scheme::kEnergyStable;
}

Scheme readScheme(SceneBuilder& builder,
                  const YamlMap& map,
                  const Section& section,
                  const Value& damping,
                  double rest_length_ratio) {
  const Scheme scheme = schemeAskedFor(builder, map);
  const bool is_damped = damping.factor != 0.0 && dimensionsOf(section.geometry) > 1;
  if (rest_length_ratio > 0.0 || is_damped) {
    return scheme;
  }
  if (scheme == Scheme::kEnergyStable) {
    map.fail("scheme",
             "'scheme' of " + map.what() +
                 " is energy-stable, but all of it is linear, allowed: auto, explicit, or "
                 "'rest_length_ratio' above 0, or 'damping' in a plane or space");
  }
  return Scheme::kExplicit;
}

}  // namespace ergotic::scene
