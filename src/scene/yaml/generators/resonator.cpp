// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "scene/yaml/generators/body_keys.hpp"
#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/generators/readers.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMostRows = 400;
constexpr std::size_t kMostPlaces = 64;
constexpr std::size_t kColumns = 3;  // before the weights
constexpr Limits kRatioLimits{"", 0.0, 1000.0, true};
constexpr Limits kT60Limits{"s", 1e-4, 1e4};

std::vector<std::string> readPlaceNames(const SceneBuilder& builder, const YamlMap& map) {
  std::vector<std::string> names;
  if (!map.has("places")) {
    return names;
  }
  const Node& list = map.at("places");
  if (!list.isList() || list.size() < 1 || list.size() > kMostPlaces) {
    map.fail("places", "'places' of " + map.what() + " is " + kindOf(list) +
                           ", allowed: a list of 1...64 names");
  }
  for (const Node& node : list) {
    const Place place = placeOf(node, map.placeAt("places"));
    names.push_back(wordOf(builder, node, "a place of " + map.what(), place));
    checkName(builder, names.back(), place);
  }
  return names;
}

Partial readPartial(const SceneBuilder& builder,
                    const YamlMap& map,
                    const Node& row,
                    double pitch_hz,
                    std::size_t places) {
  const Place place = placeOf(row, map.placeAt("partials"));
  if (!row.isList() || row.size() != kColumns + places) {
    builder.fail(
        place,
        "a partial of " + map.what() + " is " + kindOf(row) + ", allowed: [frequency, t60, mass" +
            (places > 0 ? ", a weight for each of " + std::to_string(places) + " places]" : "]"));
  }
  const std::string of = " of a partial of " + map.what();
  Partial partial;
  const Limits heard{"Hz", 0.0, kHighestPartialHz, true};
  partial.frequency_hz =
      pitch_hz > 0.0 ? pitch_hz * numberOf(builder, row[0], "ratio" + of, kRatioLimits, place)
                     : numberOf(builder, row[0], "frequency" + of, heard, place);
  if (!heard.hold(partial.frequency_hz)) {
    builder.fail(placeOf(row[0], place), outOfRange("frequency" + of, partial.frequency_hz, heard));
  }
  partial.t60_s = numberOf(builder, row[1], "t60" + of, kT60Limits, place);
  partial.mass = numberOf(builder, row[2], "mass" + of, kMassLimits, place);
  for (std::size_t p = 0; p < places; ++p) {
    partial.weights.push_back(
        numberOf(builder, row[kColumns + p], "a weight" + of, kWeightLimits, place));
  }
  return partial;
}

}  // namespace

void readResonator(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "pitch", "partials", "places", "at"});
  ModalSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = bodySection(builder, map);
  spec.at = readRest(sectionAt(builder, spec.section), map, "at");
  spec.places = readPlaceNames(builder, map);
  const double pitch_hz = map.number("pitch", kFrequencyLimits, 0.0);
  const Node& rows = map.at("partials");
  if (!rows.isList() || rows.size() < 1 || rows.size() > kMostRows) {
    map.fail("partials", "'partials' of " + map.what() + " is " + kindOf(rows) +
                             ", allowed: a list of 1...400 rows [frequency, t60, mass, ...]");
  }
  for (const Node& row : rows) {
    spec.partials.push_back(readPartial(builder, map, row, pitch_hz, spec.places.size()));
  }
  addModalBody(builder, spec);
}

}  // namespace ergotic::scene
