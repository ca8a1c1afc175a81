// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scene/clipped_law.hpp"
#include "scene/lia_rules.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_tables.hpp"

namespace ergotic::scene {
namespace {

using Keys = std::vector<std::string>;

/// One type of link as it is written, and the keys it takes beside those of all links.
struct LiaKind {
  const char* name;
  LiaType type;
  Keys required;
  Keys optional;
  Keys with_table;  ///< instead of all these, where there is a `table`
};

const std::vector<LiaKind>& liaKinds() {
  const Keys rest = {"rest_length"};
  const Keys damped = {"damping", "rest_length"};
  const Keys contact = {"damping", "threshold"};
  const Keys clipped = {"stiffness", "nonlinearity", "stiffness_limit"};
  static const std::vector<LiaKind> kKinds = {
      {"spring", LiaType::kSpringDamper, {"stiffness"}, rest, {}},
      {"damper", LiaType::kSpringDamper, {"damping"}, {}, {}},
      {"spring_damper", LiaType::kSpringDamper, {"stiffness", "damping"}, rest, {}},
      {"contact", LiaType::kContact, {"stiffness"}, contact, {}},
      {"power_contact", LiaType::kPowerContact, {"stiffness", "exponent"}, contact, {}},
      {"quadratic", LiaType::kQuadratic, {"stiffness", "nonlinearity"}, damped, {}},
      {"cubic", LiaType::kCubic, {"stiffness", "nonlinearity"}, damped, {}},
      {"clipped_cubic", LiaType::kClippedCubic, clipped, damped, {}},
      {"cubic_contact", LiaType::kCubicContact, clipped, contact, {}},
      {"pluck", LiaType::kPluck, {"stiffness", "width"}, damped, {"table", "rest_length"}},
      {"bow", LiaType::kBow, {"damping", "width"}, {}, {"table"}},
      {"smooth_bow", LiaType::kSmoothBow, {"damping", "width"}, {}, {}},
      {"table", LiaType::kTable, {}, {"elastic", "viscous", "rest_length"}, {}},
      {"conditional",
       LiaType::kConditional,
       {"stiffness", "engage"},
       {"damping", "release", "rest_length"},
       {}},
  };
  return kKinds;
}

bool contains(const Keys& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void readEnds(SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const YAML::Node& ends = map.at("between");
  if (!ends.IsSequence() || ends.size() != 2) {
    map.fail("between",
             "'between' of " + map.what() + " is not a list of 2, allowed: [lower, upper]");
  }
  int indices[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const YAML::Node& end = ends[i];
    const Place place = placeOf(end, map.placeAt("between"));
    indices[i] = pointAt(builder, wordOf(builder, end, "an end of " + map.what(), place), place);
  }
  lia.a = indices[0];
  lia.b = indices[1];
  if (lia.a == lia.b) {
    map.fail("between", map.what() + " joins module " + quoted(ends[0].Scalar()) + " to itself");
  }
}

/// The tipping point of a clipped law is computed once.
void refuseParameters(const YamlMap& map, const Lia& lia) {
  for (const LiaField& field : liaFields(lia.type)) {
    const auto is = [&](LiaMember member) { return field.member == member; };
    const bool shapes =
        is(&Lia::stiffness) || is(&LiaLaw::nonlinearity) || is(&LiaLaw::stiffness_limit);
    if (shapes && memberOf(lia, field.member).parameter >= 0) {
      map.fail(field.key, quoted(field.key) + " of " + map.what() +
                              " is a parameter, allowed in a clipped law: a number");
    }
  }
}

/// Points of an elastic and a viscous law, at least one of them.
void readLaws(const SceneBuilder& builder, YamlTables& tables, const YamlMap& map, Lia& lia) {
  if (!map.has("elastic") && !map.has("viscous")) {
    builder.fail(map.place(),
                 map.what() + " has neither 'elastic' nor 'viscous', allowed: one or both");
  }
  if (map.has("elastic")) {
    lia.law.edit().table = tables.read(map, "elastic");
  }
  if (map.has("viscous")) {
    lia.law.edit().viscous_table = tables.read(map, "viscous");
  }
}

/// `release`, or where the link engages if that is one place.
void readRelease(const SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  if (!map.has("release") && lia.law->width.parameter >= 0) {
    builder.fail(map.place(), "missing key 'release' of " + map.what() +
                                  ", allowed without it: a constant 'engage'");
  }
  lia.law.edit().release =
      map.number("release", releaseLimits(builder.scene(), lia), lia.law->width.factor);
}

/// The coefficients of all types that have no table.
void readCoefficients(const SceneBuilder& builder,
                      const YamlMap& map,
                      const LiaKind& kind,
                      Lia& lia) {
  for (const LiaField& field : liaFields(kind.type)) {
    if (contains(kind.required, field.key) || map.has(field.key)) {
      setMember(lia, field.member, map.value(field.key, field.limits));
    }
  }
  if (kind.type == LiaType::kClippedCubic || kind.type == LiaType::kCubicContact) {
    refuseParameters(map, lia);
    completeClippedLaw(lia, ClippedLaw::kContinuous);
  }
  if (kind.type == LiaType::kConditional) {
    readRelease(builder, map, lia);
  }
}

void refuse(const YamlMap& map, const std::string& key, const std::string& fault) {
  if (!fault.empty()) {
    map.fail(key, fault);
  }
}

/// How the link is worked out. Where there is nothing to choose, nothing is left to be chosen.
void readTreatment(const Scene& scene, const YamlMap& map, Lia& lia) {
  constexpr Scheme kSchemes[] = {Scheme::kAuto, Scheme::kExplicit, Scheme::kGuarded};
  lia.scheme = Scheme::kAuto;
  if (map.has("scheme")) {
    lia.scheme = kSchemes[map.choice("scheme", {"auto", "explicit", "guarded"})];
    refuse(map, "scheme", schemeFault(lia));
  }
  if (!isGuardable(lia)) {
    lia.scheme = Scheme::kExplicit;
  }
  if (map.has("filter")) {
    lia.filtered = map.choice("filter", {"none", "auto"}) == 1;
    refuse(map, "filter", filterFault(scene, lia));
  }
}

const LiaKind& kindOf(const YamlMap& map) {
  static const Keys kWords = [] {
    Keys words;
    for (const LiaKind& each : liaKinds()) {
      words.emplace_back(each.name);
    }
    return words;
  }();
  return liaKinds()[map.choice("type", kWords)];
}

Lia readLia(SceneBuilder& builder,
            YamlTables& tables,
            const std::string& name,
            const YamlMap& map) {
  const LiaKind& kind = kindOf(map);
  const bool has_table = !kind.with_table.empty() && map.has("table");
  Keys keys = {"type", "between", "scheme", "coupling", "filter"};
  for (const Keys& more : has_table ? std::vector<Keys>{kind.with_table}
                                    : std::vector<Keys>{kind.required, kind.optional}) {
    keys.insert(keys.end(), more.begin(), more.end());
  }
  map.allow(keys);

  Lia lia;
  lia.name = name;
  lia.type = kind.type;
  lia.place = map.place();
  readEnds(builder, map, lia);
  lia.rest_length = map.number("rest_length", restLengthLimits(builder.scene(), lia), 0.0);
  if (has_table) {
    lia.law.edit().table = tables.read(map, "table");
  } else if (kind.type == LiaType::kTable) {
    readLaws(builder, tables, map, lia);
  } else {
    readCoefficients(builder, map, kind, lia);
  }
  readTreatment(builder.scene(), map, lia);
  return lia;
}

}  // namespace

void readLias(SceneBuilder& builder, const YamlMap& top, YamlTables& tables) {
  forEachElement(builder, top, "lias", "link", [&](const std::string& name, const YamlMap& map) {
    builder.add(readLia(builder, tables, name, map));
  });
}

}  // namespace ergotic::scene
