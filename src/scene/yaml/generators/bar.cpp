// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/bar.hpp"

#include <cmath>
#include <vector>

#include "scene/yaml/generators/body_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr Limits kBarMasses{"", 4.0, 2000.0};
constexpr Limits kTunedMasses{"", 8.0, 200.0};
constexpr Limits kRatioLimits{"", 1.5, 15.0};
const std::vector<std::string> kEnds{"free", "hinged", "clamped"};

/// Reads the ends of a bar: one word for both, or one for each.
std::array<BarEnd, 2> readEnds(const SceneBuilder& builder, const YamlMap& map) {
  const Node& node = map.at("ends");
  if (node.isScalar()) {
    const auto end = static_cast<BarEnd>(map.choice("ends", kEnds));
    return {end, end};
  }
  if (!node.isList() || node.size() != 2) {
    map.fail("ends", "'ends' of " + map.what() + " is " + kindOf(node) +
                         ", allowed: free, hinged or clamped, or a list of two of them");
  }
  std::array<BarEnd, 2> ends{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Place place = map.placeAt("ends", i);
    const std::string word = wordOf(builder, node[i], "an end of " + map.what(), place);
    const auto found = std::find(kEnds.begin(), kEnds.end(), word);
    if (found == kEnds.end()) {
      builder.fail(place, "unknown end " + quoted(word) + " of " + map.what() +
                              "; known: free, hinged, clamped");
    }
    ends[i] = static_cast<BarEnd>(found - kEnds.begin());
  }
  return ends;
}

void readRatios(const SceneBuilder& builder, const YamlMap& map, BarSpec& spec) {
  spec.ratios = map.numbers("ratios", 1, 2, kRatioLimits);
  if (spec.ends[0] != BarEnd::kFree || spec.ends[1] != BarEnd::kFree) {
    builder.fail(map.keyPlaceAt("ratios"),
                 "'ratios' of " + map.what() + " with ends that are held, allowed: ends: free");
  }
  if (map.has("masses")) {
    map.integer("masses", kTunedMasses);
  }
  if (map.has("pitch_of")) {
    builder.fail(map.keyPlaceAt("pitch_of"),
                 "'pitch_of' of " + map.what() +
                     " cannot be combined with 'ratios', which are relative to partial 1");
  }
}

/// A bar without `from` and `to` gets a length for the picture, that of the wooden bar of a
/// marimba: 38 cm at C3, and as the square root of the period.
void spread(BarSpec& spec) {
  constexpr double kLengthM = 0.38;
  constexpr double kPitchHz = 130.8;
  const double half = 0.5 * kLengthM * std::sqrt(kPitchHz / spec.wish.pitch_hz);
  spec.from.z() -= half;
  spec.to.z() += half;
}

}  // namespace

void readBar(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(barKeys());
  BarSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = bodySection(builder, map);
  const BodyForm form = readBodyForm(builder, map, false);
  spec.masses = readCount(map, "masses", kBarMasses, form, kMassesOfModes);
  spec.mass = map.number("mass", kMassLimits);
  if (map.has("ends")) {
    spec.ends = readEnds(builder, map);
  }
  if (map.has("ratios")) {
    readRatios(builder, map, spec);
  }
  const Section& section = builder.scene().sections[static_cast<std::size_t>(spec.section)];
  spec.from = readRest(section, map, "from");
  spec.to = readRest(section, map, "to");
  spec.wish = readBodyWish(builder, map);
  if (spec.from == spec.to) {
    spread(spec);
  }
  addBody(builder, name, spec.section, spec.wish, form, spec.place,
          [&](SceneBuilder& to, int in, const BodyWish& wish) {
            BarSpec network = spec;
            network.section = in;
            network.wish = wish;
            addBar(to, network);
          });
}

}  // namespace ergotic::scene
