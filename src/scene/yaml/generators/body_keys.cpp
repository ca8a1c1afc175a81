// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/generators/body_keys.hpp"

#include "scene/yaml/generators/generator_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr Limits kPartialLimits{"", 1.0, kMaxPartials};

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
  for (const char* key :
       {"type", "name", "section", "pitch", "pitch_of", "t60", "as", "partials", "places"}) {
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

BodyForm readBodyForm(const SceneBuilder& builder, const YamlMap& map, bool is_flat) {
  BodyForm form;
  form.is_modal = map.has("as") && map.choice("as", {"network", "modes"}) == 1;
  if (map.has("partials")) {
    form.partials = map.integer("partials", kPartialLimits);
    if (!form.is_modal) {
      builder.fail(map.keyPlaceAt("partials"),
                   "'partials' of " + map.what() + " as a network, allowed with as: modes");
    }
  }
  if (!map.has("places")) {
    return form;
  }
  const auto read = [&](const std::string& key, Place key_place, const Node& node) {
    checkName(builder, key, key_place);
    const std::string what = "place " + quoted(key) + " of " + map.what();
    const Place place = placeOf(node, key_place);
    if (is_flat && (!node.isList() || node.size() != 2)) {
      builder.fail(place, what + " is " + kindOf(node) + ", allowed: [along, across], each 0...1");
    }
    BodyPlace wanted{key, 0.0, 0.0, place};
    wanted.along = numberOf(builder, is_flat ? node[0] : node, what, kFractionLimits, place);
    wanted.across = is_flat ? numberOf(builder, node[1], what, kFractionLimits, place) : 0.0;
    form.places.push_back(std::move(wanted));
  };
  forEachEntry(builder, map.at("places"), "'places' of " + map.what(), map.placeAt("places"), read);
  return form;
}

int readCount(const YamlMap& map,
              const std::string& key,
              const Limits& limits,
              const BodyForm& form,
              int of_modes) {
  return form.is_modal && !map.has(key) ? of_modes : map.integer(key, limits);
}

int bodySection(const SceneBuilder& builder, const YamlMap& map) {
  const int index = sectionOf(builder, map);
  const Section& section = sectionAt(builder, index);
  const Place place = map.has("section") ? map.placeAt("section") : map.place();
  if (section.geometry != Geometry::kScalar) {
    builder.fail(place, map.what() + " is in section " + quoted(section.name) +
                            ", allowed: scalar sections");
  }
  if (section.medium.factor != 0.0) {
    builder.fail(place, map.what() + " is in section " + quoted(section.name) +
                            ", whose 'medium' would change what it loses, allowed: a section "
                            "without one, and 't60'");
  }
  return index;
}

}  // namespace ergotic::scene
