// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/generators/body_keys.hpp"

#include "scene/yaml/generators/generator_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr Limits kPartialLimits{"", 1.0, kMostPartials};
constexpr Limits kT60Limits{"s", 1e-4, 1e4};

int partialOf(const SceneBuilder& builder, const Node& node, const std::string& what, Place place) {
  const double partial = numberOf(builder, node, what, kPartialLimits, place);
  if (partial != static_cast<int>(partial)) {
    builder.fail(placeOf(node, place),
                 what + " = " + numberText(partial) +
                     " is no whole number, allowed: " + kPartialLimits.text());
  }
  return static_cast<int>(partial);
}

/// `2 s`, or `[[1, 2 s], [8, 0.5 s]]`.
void readT60(const SceneBuilder& builder, const YamlMap& map, BodyWish& wish) {
  const Node& node = map.at("t60");
  const std::string what = "'t60' of " + map.what();
  if (node.isScalar()) {
    wish.t60 = {{1, map.number("t60", kT60Limits)}};
    return;
  }
  if (!node.isList() || node.size() < 1 || node.size() > 2) {
    map.fail("t60", what + " is " + kindOf(node) +
                        ", allowed: s, or [[partial, s]], or [[partial, s], [partial, s]]");
  }
  for (const Node& pair : node) {
    const Place place = placeOf(pair, map.placeAt("t60"));
    if (!pair.isList() || pair.size() != 2) {
      builder.fail(place,
                   "an entry of " + what + " is " + kindOf(pair) + ", allowed: [partial, s]");
    }
    wish.t60.emplace_back(partialOf(builder, pair[0], "a partial in " + what, place),
                          numberOf(builder, pair[1], "a time in " + what, kT60Limits, place));
  }
  if (wish.t60.size() == 2 && wish.t60[0].first >= wish.t60[1].first) {
    map.fail("t60", what + " names partial " + std::to_string(wish.t60[1].first) + " after " +
                        std::to_string(wish.t60[0].first) + ", allowed: a higher one");
  }
}

}  // namespace

std::vector<std::string> withBodyKeys(std::vector<std::string> keys) {
  for (const char* key : {"type", "name", "section", "pitch", "pitch_of", "t60"}) {
    keys.emplace_back(key);
  }
  return keys;
}

BodyWish readBodyWish(const SceneBuilder& builder, const YamlMap& map) {
  BodyWish wish;
  wish.pitch_hz = map.number("pitch", kFrequencyLimits);
  wish.pitch_of = map.has("pitch_of") ? map.integer("pitch_of", kPartialLimits) : 1;
  if (map.has("t60")) {
    readT60(builder, map, wish);
  }
  return wish;
}

int bodySection(const SceneBuilder& builder, const YamlMap& map) {
  const int index = sectionOf(builder, map);
  const Section& section = sectionAt(builder, index);
  const Place place = map.has("section") ? map.placeAt("section") : map.place();
  if (section.geometry != Geometry::kScalar) {
    builder.fail(place, map.what() + " has a 'pitch' in section " + quoted(section.name) +
                            ", allowed: scalar sections");
  }
  if (section.medium.factor != 0.0) {
    builder.fail(place, map.what() + " has a 'pitch' in section " + quoted(section.name) +
                            ", whose 'medium' would change what it loses, allowed: a section "
                            "without one, and 't60'");
  }
  return index;
}

}  // namespace ergotic::scene
