// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/laws/clipped_cubic.hpp"
#include "scene/rules/rules.hpp"
#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/selections.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_friction.hpp"
#include "scene/yaml/yaml_keys.hpp"
#include "scene/yaml/yaml_tables.hpp"
#include "scene/yaml/yaml_tanks.hpp"

namespace ergotic::scene {
namespace {

using Keys = std::vector<std::string>;

constexpr const char* kBend = "bend";        // of many ends
constexpr const char* kStretch = "stretch";  // of many springs
constexpr const char* kReleaseForce = "release_force";

/// A word of a scene for a law.
struct LiaKind {
  LiaType type;
  std::string word;
  Keys required;
  Keys optional;
  double release_slope;
  double release_share;
};

Keys keysIn(const char* text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

const std::vector<LiaKind>& liaKinds() {
  static const auto kKinds = [] {
    std::vector<LiaKind> kinds;
    for (std::size_t i = 0; i < kLiaTypes; ++i) {
      const auto type = static_cast<LiaType>(i);
      for (const LawWord& word : lawOf(type).words) {
        kinds.push_back({type, word.word, keysIn(word.required), keysIn(word.optional),
                         word.release_slope, word.release_share});
      }
    }
    return kinds;
  }();
  return kKinds;
}

bool contains(const Keys& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// Ends of one link for each pair: from one module to each of a set, or from each module to its
/// counterpart in another set.
struct Ends {
  std::vector<std::pair<int, int>> pairs;
  bool are_many = false;
};

Ends readEnds(SceneBuilder& builder, const YamlMap& map) {
  const Node& ends = map.at("between");
  if (!ends.isList() || ends.size() != 2) {
    map.fail("between",
             "'between' of " + map.what() +
                 " is not a list of 2, allowed: [lower, upper], what has a comma in quotes");
  }
  Selection sides[2];
  for (std::size_t i = 0; i < 2; ++i) {
    sides[i] = selectionOf(builder, ends[i], "an end of " + map.what(), map.placeAt("between"));
  }
  const std::size_t counts[2] = {sides[0].mats.size(), sides[1].mats.size()};
  if (counts[0] != counts[1] && counts[0] > 1 && counts[1] > 1) {
    map.fail("between", map.what() + " is between " + std::to_string(counts[0]) + " and " +
                            std::to_string(counts[1]) +
                            " modules, allowed: as many, or one of one side");
  }
  Ends result;
  result.are_many = sides[0].is_set || sides[1].is_set;
  for (std::size_t k = 0; k < std::max(counts[0], counts[1]); ++k) {
    const int a = sides[0].mats[counts[0] > 1 ? k : 0];
    const int b = sides[1].mats[counts[1] > 1 ? k : 0];
    if (a == b) {
      const std::string name = builder.scene().mats[static_cast<std::size_t>(a)].name;
      map.fail("between", map.what() + " joins module " + quoted(name) + " to itself");
    }
    result.pairs.emplace_back(a, b);
  }
  return result;
}

/// Refuses parameters in numbers from which others are computed once: these would not follow.
void refuseParameters(const YamlMap& map, const Lia& lia) {
  for (const LiaField& field : lawOf(lia.type).fields) {
    if (field.is_fixed && memberOf(lia, field.member).parameter >= 0) {
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
    lia.law.edit().table = tables.read(map, "elastic", {"m"});
  }
  if (map.has("viscous")) {
    lia.law.edit().viscous_table = tables.read(map, "viscous", {"m/s"});
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

/// The force at which a pluck lets go, in place of its width. Without a stiffness it is bent by 1
/// mm then.
void readReleaseForce(const YamlMap& map, const LiaKind& kind, Lia& lia) {
  constexpr double kUsualTipM = 1e-3;
  const Value force = map.value(kReleaseForce, {"N", 0.0, kInfinity, true});
  if (lia.stiffness.parameter >= 0) {
    map.fail("stiffness", "'stiffness' of " + map.what() +
                              " is a parameter, allowed beside 'release_force': a number");
  }
  Value& width = lia.law.edit().width;
  if (map.has("stiffness")) {
    const double stiffness = map.number("stiffness", {"N/m", 0.0, kInfinity, true});
    width = force;
    width.factor /= kind.release_slope * kind.release_share * stiffness;
  } else {
    lia.stiffness = force;
    lia.stiffness.factor /= kind.release_slope * kUsualTipM;
    width.factor = kUsualTipM / kind.release_share;
  }
}

void readCoefficients(const SceneBuilder& builder,
                      const YamlMap& map,
                      const LiaKind& kind,
                      Lia& lia) {
  const Law& law = lawOf(lia.type);
  if (law.tables == Law::Tables::kCoefficient) {
    return;  // it has read its own
  }
  for (const LiaField& field : law.fields) {
    if (contains(kind.required, field.key) || map.has(field.key)) {
      setMember(lia, field.member, map.value(field.key, field.limits));
    }
  }
  refuseParameters(map, lia);
  completeClippedLaw(lia, ClippedLaw::kContinuous);
  if (map.has(kReleaseForce)) {
    readReleaseForce(map, kind, lia);
  }
  if (law.has_release) {
    readRelease(builder, map, lia);
  }
  if (law.kind == Law::Kind::kRelaxing) {
    readRelaxations(builder, map, lia);
  }
}

void readTables(const SceneBuilder& builder, YamlTables& tables, const YamlMap& map, Lia& lia) {
  switch (lawOf(lia.type).tables) {
    case Law::Tables::kNone:
      return;
    case Law::Tables::kOne:
      lia.law.edit().table =
          tables.read(map, "table", {lawOf(lia.type).friction != nullptr ? "m/s" : "m"});
      return;
    case Law::Tables::kCoefficient:
      readFriction(builder, tables, map, lia);
      return;
    case Law::Tables::kParts:
      readLaws(builder, tables, map, lia);
  }
}

void refuse(const YamlMap& map, const std::string& key, const std::string& fault) {
  if (!fault.empty()) {
    map.fail(key, fault);
  }
}

/// How the link is worked out. Where there is nothing to choose, nothing is left to be chosen.
void readTreatment(SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const Scene& scene = builder.scene();
  lia.scheme = schemeAskedFor(builder, map);
  if (map.has("scheme")) {
    refuse(map, "scheme", schemeFault(scene, lia));
  }
  // A table may be split into parts that are.
  if (!canBeEnergyStable(scene, lia) && lia.type != LiaType::kTable) {
    lia.scheme = Scheme::kExplicit;
  }
  if (map.has("filter")) {
    lia.filtered = map.choice("filter", {"none", "auto"}) == 1;
    refuse(map, "filter", filterFault(scene, lia));
  }
}

/// Reads the type of a link: one of the words for laws, or for a link of many ends or springs.
const std::string& wordOf(const YamlMap& map) {
  static const Keys kWords = [] {
    Keys words{kBend, kStretch};
    for (const LiaKind& each : liaKinds()) {
      if (!contains(words, each.word)) {
        words.push_back(each.word);
      }
    }
    return words;
  }();
  return kWords[map.choice("type", kWords)];
}

/// Some words mean one law with a table and another without, or need other keys with a force.
const LiaKind& kindOf(const YamlMap& map, const std::string& word) {
  const LiaKind* found = nullptr;
  for (const LiaKind& each : liaKinds()) {
    const bool fits = (lawOf(each.type).tables == Law::Tables::kOne) == map.has("table") &&
                      contains(each.required, kReleaseForce) == map.has(kReleaseForce);
    if (word == each.word && (found == nullptr || fits)) {
      found = &each;
    }
  }
  return *found;
}

Keys keysOf(const LiaKind& kind) {
  Keys keys = {"type", "between", "scheme", "filter"};
  for (const Keys& more : {kind.required, kind.optional}) {
    keys.insert(keys.end(), more.begin(), more.end());
  }
  if (kind.type == LiaType::kCubic) {
    keys.emplace_back("tank");
  }
  return keys;
}

Lia readLia(SceneBuilder& builder,
            YamlTables& tables,
            const std::string& name,
            const LiaKind& kind,
            const std::pair<int, int>& ends,
            const YamlMap& map) {
  Lia lia;
  lia.name = name;
  lia.type = kind.type;
  lia.place = map.place();
  lia.a = ends.first;
  lia.b = ends.second;
  lia.rest_length = map.number("rest_length", restLengthLimits(builder.scene(), lia), 0.0);
  readTables(builder, tables, map, lia);
  readCoefficients(builder, map, kind, lia);
  readTreatment(builder, map, lia);
  if (map.has("tank")) {
    readTank(builder, map, lia);
  }
  return lia;
}

}  // namespace

KeysOfTypes keysOfLias() {
  KeysOfTypes all = {{kBend, bendKeys()}, {kStretch, stretchKeys()}};
  for (const LiaKind& kind : liaKinds()) {
    all.emplace_back(kind.word, keysOf(kind));
  }
  return all;
}

void readLias(SceneBuilder& builder, const YamlMap& top, YamlTables& tables) {
  Pressed pressed;
  std::vector<StretchKeys> stretches;
  forEachElement(builder, top, "lias", "link", [&](const std::string& name, const YamlMap& map) {
    const std::string& word = wordOf(map);
    if (word == kBend) {
      readBend(builder, name, map);
      return;
    }
    if (word == kStretch) {
      stretches.push_back(readStretch(builder, name, map));
      return;
    }
    const LiaKind& kind = kindOf(map, word);
    map.allow(keysOf(kind));
    const Ends ends = readEnds(builder, map);
    for (std::size_t k = 0; k < ends.pairs.size(); ++k) {
      Lia lia = readLia(builder, tables, ends.are_many ? name + "." + std::to_string(k) : name,
                        kind, ends.pairs[k], map);
      if (!lia.law->pressed_by.empty()) {
        pressed.emplace_back(lia.law->pressed_by, map.placeAt("normal"));
      }
      builder.add(std::move(lia));
    }
  });
  checkPressers(builder, pressed);
  for (StretchKeys& stretch : stretches) {
    addStretch(builder, std::move(stretch));
  }
}

}  // namespace ergotic::scene
