// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_tanks.hpp"

#include <algorithm>

#include "scene/generate/stretch.hpp"
#include "scene/limits.hpp"
#include "scene/text/glob.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

void readSprings(const SceneBuilder& builder, const YamlMap& map, StretchKeys& to) {
  const Node& of = map.at("of");
  to.is_list = of.isList();
  if (!to.is_list) {
    to.names.emplace_back(map.word("of"), map.placeAt("of"));
    return;
  }
  for (const Node& part : of) {
    const Place place = placeOf(part, map.placeAt("of"));
    to.names.emplace_back(wordOf(builder, part, "a part of " + map.what(), place), place);
  }
}

/// Springs that a generator has made. \throws TextError if it is no string or mesh
std::vector<int> springsOf(const SceneBuilder& builder, const std::string& grid, Place place) {
  builder.grid(grid, place);
  const std::string stem = grid + ".link.";
  std::vector<int> springs;
  const std::vector<Lia>& lias = builder.scene().lias;
  for (std::size_t l = 0; l < lias.size(); ++l) {
    const std::string name = lias[l].name.str();
    // Another generator may be called `s.link`.
    if (name.compare(0, stem.size(), stem) == 0 &&
        name.find('.', stem.size()) == std::string::npos) {
      springs.push_back(static_cast<int>(l));
    }
  }
  return springs;
}

/// All springs that a pattern means, single ones and those of strings and meshes.
/// \throws TextError if it means none
std::vector<int> springsMeantBy(const SceneBuilder& builder,
                                const std::string& pattern,
                                Place place) {
  std::vector<int> springs;
  const Scene& scene = builder.scene();
  for (std::size_t l = 0; l < scene.lias.size(); ++l) {
    const Lia& lia = scene.lias[l];
    if (lia.type == LiaType::kSpringDamper && lia.stiffness.factor != 0.0 &&
        isMeantBy(lia.name.str(), pattern)) {
      springs.push_back(static_cast<int>(l));
    }
  }
  for (const Grid& grid : scene.grids) {
    if (isMeantBy(grid.name, pattern)) {
      const std::vector<int> of_grid = springsOf(builder, grid.name, place);
      springs.insert(springs.end(), of_grid.begin(), of_grid.end());
    }
  }
  if (springs.empty()) {
    builder.fail(place, quoted(pattern) + " means no spring, string or mesh");
  }
  return springs;
}

}  // namespace

StretchKeys readStretch(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(stretchKeys());
  StretchKeys stretch;
  stretch.tank.name = name;
  stretch.tank.is_mean = true;
  stretch.tank.place = map.place();
  readSprings(builder, map, stretch);
  stretch.tank.spacing = map.number("spacing", kSpacingLimits);
  stretch.tank.hardening = map.value("hardening", kHardeningLimits);
  return stretch;
}

void addStretch(SceneBuilder& builder, StretchKeys stretch) {
  std::vector<int>& springs = stretch.tank.springs;
  for (const auto& [name, place] : stretch.names) {
    const bool is_link = builder.findLia(name) >= 0 || builder.findGrid(name) < 0;
    if (!isPattern(name) && stretch.is_list && is_link) {
      springs.push_back(builder.lia(name, place));
      continue;
    }
    const std::vector<int> of_all =
        isPattern(name) ? springsMeantBy(builder, name, place) : springsOf(builder, name, place);
    springs.insert(springs.end(), of_all.begin(), of_all.end());
  }
  if (stretch.tank.springs.empty()) {
    builder.fail(stretch.tank.place,
                 "link " + quoted(stretch.tank.name) + " is of no spring, allowed: at least 1");
  }
  addStretch(builder, std::move(stretch.tank));
}

void readTank(SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const std::string name = map.word("tank");
  checkName(builder, name, map.placeAt("tank"));
  if (lia.scheme == Scheme::kExplicit) {
    map.fail("scheme",
             map.what() + " is explicit and has a tank, allowed with one: energy_stable, auto");
  }
  std::vector<Tank>& tanks = builder.scene().tanks;
  const auto found =
      std::find_if(tanks.begin(), tanks.end(), [&](const Tank& tank) { return tank.name == name; });
  lia.tank = static_cast<int>(found - tanks.begin());
  lia.scheme = Scheme::kEnergyStable;
  if (found == tanks.end()) {
    tanks.emplace_back();
    tanks.back().name = name;
    tanks.back().place = map.placeAt("tank");
  }
}

}  // namespace ergotic::scene
