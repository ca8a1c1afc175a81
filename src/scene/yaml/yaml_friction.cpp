// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_friction.hpp"

#include <cctype>
#include <string>

#include "scene/laws/friction.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::scene {
namespace {

bool isName(const std::string& text) {
  return !text.empty() &&
         (std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_');
}

LiaLaw::Fall readFall(const SceneBuilder& builder,
                      const Node& part,
                      const std::string& what,
                      Place place) {
  const Place at = placeOf(part, place);
  if (!part.isList() || part.size() != 2) {
    builder.fail(at, "a part of " + what + " is not a pair, allowed: [share, m/s]");
  }
  return {numberOf(builder, part[0], "share of a part of " + what, kFallShareLimits, at),
          numberOf(builder, part[1], "width of a part of " + what, kFallWidthLimits, at)};
}

/// mu = steady + sum of share e^(-|v|/width).
void readParts(const SceneBuilder& builder, const YamlMap& map, LiaLaw& law) {
  law.steady = map.number("steady", kFrictionLimits);
  if (!map.has("parts")) {
    return;
  }
  const Node& parts = map.at("parts");
  if (!parts.isList() || parts.size() < 1 || parts.size() > law.falls.size()) {
    map.fail("parts", "'parts' of " + map.what() + " is not a list of 1 or 2 pairs");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    law.falls[i] = readFall(builder, parts[i], map.what(), map.placeAt("parts"));
  }
}

}  // namespace

void readFriction(const SceneBuilder& builder, YamlTables& tables, const YamlMap& map, Lia& lia) {
  LiaLaw& law = lia.law.edit();
  if (isName(map.word("normal"))) {
    law.pressed_by = map.word("normal");
  } else {
    law.normal = map.value("normal", {"N", 0.0});
  }
  if (!map.has("table")) {
    readParts(builder, map, law);
    return;
  }
  for (const char* key : {"steady", "parts"}) {
    if (map.has(key)) {
      builder.fail(map.keyPlaceAt(key), map.what() + " has a table and " + quoted(key) +
                                            ", allowed: a table, or 'steady' and 'parts'");
    }
  }
  law.table = tables.read(map, "table", {"m/s", ""});
  if (const std::string fault = coefficientFault(law.table); !fault.empty()) {
    map.fail("table", "'table' of " + map.what() + " " + fault);
  }
}

void checkPressers(const SceneBuilder& builder, const Pressed& pressed) {
  for (const auto& [name, place] : pressed) {
    const Lia& presser = builder.scene().lias[static_cast<std::size_t>(builder.lia(name, place))];
    const Law& law = lawOf(presser.type);
    if (law.kind != Law::Kind::kGap) {
      builder.fail(place, "link " + quoted(name) + " does not press, it is a " + law.name +
                              ", allowed: a number of N, or a contact");
    }
  }
}

}  // namespace ergotic::scene
