// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>

#include "scene/laws/relaxing.hpp"
#include "scene/names.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kKeys[] = {"branches", "loss_factor", "material"};

void readBranches(const SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const Node& list = map.at("branches");
  const std::string what = "'branches' of " + map.what();
  if (!list.isList() || list.size() < 1 || list.size() > kMaxRelaxations) {
    map.fail("branches",
             what + " is " + kindOf(list) + ", allowed: [[N/m, s], ...], 1...3 of them");
  }
  for (const Node& branch : list) {
    const Place place = placeOf(branch, map.placeAt("branches"));
    if (!branch.isList() || branch.size() != 2) {
      builder.fail(place, "a branch of " + map.what() + " is " + kindOf(branch) +
                              ", allowed: [stiffness, time]");
    }
    lia.law.edit().relaxations.push_back(
        {valueOf(builder, branch[0], "stiffness of a branch of " + map.what(), kStiffnessLimits,
                 place),
         numberOf(builder, branch[1], "time of a branch of " + map.what(), kRelaxationTimeLimits,
                  place)});
  }
}

double lossFactorOf(const YamlMap& map) {
  if (map.has("loss_factor")) {
    return map.number("loss_factor", kLossFactorLimits);
  }
  std::vector<std::string> words;
  for (const Material& material : kMaterials) {
    words.emplace_back(material.word);
  }
  return kMaterials[map.choice("material", words)].loss_factor;
}

}  // namespace

void readRelaxations(const SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const auto given = std::count_if(std::begin(kKeys), std::end(kKeys),
                                   [&](const char* key) { return map.has(key); });
  if (given != 1) {
    builder.fail(map.place(), map.what() + " has " + std::to_string(given) +
                                  " of 'branches', 'loss_factor' and 'material', allowed: one");
  }
  if (map.has("branches")) {
    readBranches(builder, map, lia);
  } else {
    lia.law.edit().relaxations = relaxationsOf(lossFactorOf(map), lia.stiffness);
  }
}

}  // namespace ergotic::scene
