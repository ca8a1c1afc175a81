// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "scene/generate/plate.hpp"
#include "scene/generate/round_plate.hpp"
#include "scene/generate/skin.hpp"
#include "scene/yaml/generators/body_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr Limits kCellLimits{"", 2.0, 100.0};
constexpr Limits kRadiusLimits{"", 2.0, 50.0};
constexpr int kCellsOfModes = 24;
constexpr Limits kPoissonLimits{"", 0.0, 0.5};
constexpr Limits kLoadRatio{"", 0.01, 100.0};
constexpr Limits kLoadPower{"", 0.1, 100.0};
constexpr Limits kThicknessLimits{"m", 1e-6, 1.0};
constexpr Limits kRoundRadiusLimits{"m", 1e-3, 10.0};
constexpr Limits kStrainLimits{"", 1e-6, 1.0};

/// What all flat bodies have.
template <class Spec>
void readFlatBody(SceneBuilder& builder, const std::string& name, const YamlMap& map, Spec& spec) {
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = bodySection(builder, map);
  spec.mass = map.number("mass", kMassLimits);
  spec.wish = readBodyWish(builder, map);
  spec.at = readRest(builder.scene().sections[static_cast<std::size_t>(spec.section)], map, "at");
}

template <class Spec>
void readSheet(SceneBuilder& builder, const std::string& name, const YamlMap& map, Spec& spec) {
  readFlatBody(builder, name, map, spec);
  spec.spacing = map.number("spacing", kSpacingLimits, spec.spacing);
}

/// `[columns, rows]` of masses, or one number for both.
template <class Spec>
void readCells(const YamlMap& map, const BodyForm& form, Spec& spec, int grounds) {
  const std::vector<int> cells = form.is_modal && !map.has("cells")
                                     ? std::vector<int>{kCellsOfModes}
                                     : map.integers("cells", 1, 2, kCellLimits);
  spec.columns = cells.front() + grounds;
  spec.rows = cells.back() + grounds;
}

/// Adds a flat body as a network, or as its modes.
template <class Spec>
void addSheetBody(SceneBuilder& builder,
                  const Spec& spec,
                  const BodyForm& form,
                  void (*add)(SceneBuilder& builder, const Spec& spec)) {
  addBody(builder, spec.name, spec.section, spec.wish, form, spec.place,
          [&](SceneBuilder& to, int in, const BodyWish& wish) {
            Spec network = spec;
            network.section = in;
            network.wish = wish;
            add(to, network);
          });
}

/// Reads `hardening` and the key that says how much it is: both or neither.
template <class Spec>
void readHardening(const SceneBuilder& builder,
                   const YamlMap& map,
                   const BodyForm& form,
                   const char* measure,
                   Spec& spec) {
  if (map.has("hardening") != map.has(measure)) {
    const std::string given = map.has("hardening") ? "hardening" : measure;
    builder.fail(map.keyPlaceAt(given), quoted(given) + " of " + map.what() + " without " +
                                            quoted(map.has("hardening") ? measure : "hardening") +
                                            ", allowed: both");
  }
  if (!map.has("hardening")) {
    return;
  }
  spec.hardening =
      map.choice("hardening", {"local", "global"}) == 0 ? Hardening::kLocal : Hardening::kGlobal;
  if (form.is_modal) {
    builder.fail(map.keyPlaceAt("hardening"),
                 "'hardening' of " + map.what() + " of modes, allowed as: network");
  }
}

SkinLoad readLoad(const YamlMap& map) {
  map.allow({"ratio", "radius", "power"});
  SkinLoad load;
  load.ratio = map.number("ratio", kLoadRatio);
  if (map.has("radius") == map.has("power")) {
    map.fail("ratio", map.what() + " has " + (map.has("radius") ? "both" : "neither") +
                          " 'radius' and 'power', allowed: exactly one of them");
  }
  if (map.has("radius")) {
    load.radius = map.number("radius", kInnerFractionLimits);
  } else {
    load.power = map.number("power", kLoadPower);
  }
  return load;
}

bool isRound(const YamlMap& map) {
  return map.has("shape") && map.choice("shape", {"rectangular", "round"}) == 1;
}

PlateEdges readEdges(const YamlMap& map) {
  return map.has("edges")
             ? static_cast<PlateEdges>(map.choice("edges", {"supported", "clamped", "free"}))
             : PlateEdges::kFree;
}

void readRoundPlate(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  RoundPlateSpec spec;
  spec.form = readBodyForm(builder, map, true);
  if (!spec.form.is_modal) {
    builder.fail(map.keyPlaceAt("shape"),
                 map.what() + " is round, and a network, allowed with as: modes");
  }
  map.allow(roundPlateKeys());
  readFlatBody(builder, name, map, spec);
  spec.edges = readEdges(map);
  if (map.has("poisson") && spec.edges == PlateEdges::kClamped) {
    builder.fail(map.keyPlaceAt("poisson"), "'poisson' of " + map.what() +
                                                ", whose edge is clamped: it changes nothing, "
                                                "allowed with edges: free or supported");
  }
  spec.poisson = map.number("poisson", kPoissonLimits, spec.poisson);
  spec.radius = map.number("radius", kRoundRadiusLimits, spec.radius);
  addRoundPlate(builder, spec);
}

}  // namespace

void readMembrane(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(membraneKeys());
  MembraneSpec spec;
  readSheet(builder, name, map, spec);
  const BodyForm form = readBodyForm(builder, map, true);
  spec.is_round = isRound(map);
  spec.has_diagonals = !map.has("neighbours") || map.choice("neighbours", {"4", "8"}) == 1;
  if (spec.is_round) {
    spec.rows = spec.columns = 2 * readCount(map, "cells", kRadiusLimits, form, kCellsOfModes) + 1;
    if (map.has("load")) {
      spec.load = readLoad(map.map("load"));
    }
  } else {
    readCells(map, form, spec, 2);
    if (map.has("load")) {
      builder.fail(map.keyPlaceAt("load"),
                   "'load' of " + map.what() + ", allowed with shape: round");
    }
  }
  readHardening(builder, map, form, "strain", spec);
  if (map.has("strain") && !map.has("spacing")) {
    builder.fail(map.keyPlaceAt("strain"), "'strain' of " + map.what() +
                                               " without 'spacing', allowed: both, as lengths "
                                               "count here");
  }
  spec.strain = map.number("strain", kStrainLimits, spec.strain);
  addSheetBody(builder, spec, form, addMembrane);
}

void readPlate(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  if (isRound(map)) {
    readRoundPlate(builder, name, map);
    return;
  }
  map.allow(plateKeys());
  PlateSpec spec;
  readSheet(builder, name, map, spec);
  const BodyForm form = readBodyForm(builder, map, true);
  spec.edges = readEdges(map);
  const bool is_free = spec.edges == PlateEdges::kFree;
  if (map.has("poisson") && !is_free) {
    builder.fail(map.keyPlaceAt("poisson"), "'poisson' of " + map.what() +
                                                ", whose edges are held: it changes nothing, "
                                                "allowed with edges: free");
  }
  spec.poisson = map.number("poisson", kPoissonLimits, spec.poisson);
  readCells(map, form, spec, is_free ? 0 : 2);
  if (is_free && (spec.rows < 3 || spec.columns < 3)) {
    map.fail("cells", "'cells' of " + map.what() + " is too few for free edges, allowed: 3...100");
  }
  readHardening(builder, map, form, "thickness", spec);
  spec.thickness = map.number("thickness", kThicknessLimits, spec.thickness);
  addSheetBody(builder, spec, form, addPlate);
}

}  // namespace ergotic::scene
