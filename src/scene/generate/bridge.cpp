// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/bridge.hpp"

#include <utility>

#include "at.hpp"
#include "scene/generate/generated.hpp"

namespace ergotic::scene {
namespace {

/// A mass, and what holds it.
int addOwn(SceneBuilder& builder, const BridgeSpec& spec, const Eigen::Vector3d& rest) {
  Mat mass = generatedMat(builder, spec.section, spec.name, rest, spec.place);
  mass.mass = spec.mass;
  const int on = builder.add(std::move(mass));
  if (spec.stiffness.factor == 0.0 && spec.resistance.factor == 0.0) {
    return on;
  }
  Mat ground = generatedMat(builder, spec.section, spec.name + ".ground", rest, spec.place);
  ground.type = MatType::kGround;
  const int below = builder.add(std::move(ground));
  const auto hold = [&](const char* name, const Value& stiffness, const Value& damping) {
    if (stiffness.factor == 0.0 && damping.factor == 0.0) {
      return;
    }
    Lia lia;
    lia.name = spec.name + name;
    lia.a = on;
    lia.b = below;
    lia.stiffness = stiffness;
    lia.damping = damping;
    lia.place = spec.place;
    builder.add(std::move(lia));
  };
  hold(".spring", spec.stiffness, {});
  hold(".resistance", {}, spec.resistance);
  return on;
}

/// Takes what is attached to a ground over to the bridge.
void attach(SceneBuilder& builder, const BridgeSpec& spec, const Grid& grid, int end, int on) {
  Scene& scene = builder.scene();
  bool is_bent = false;
  int links = 0;
  for (Lia& lia : scene.lias) {
    for (int* const side : {&lia.a, &lia.b}) {
      if (*side == end) {
        *side = on;
        ++links;
        is_bent = is_bent || lia.bend >= 0;
      }
    }
  }
  for (Bend& bend : scene.bends) {
    for (Bend::End& each : bend.ends) {
      each.mat = each.mat == end ? on : each.mat;
    }
  }
  const std::string what = "string " + quoted(grid.name) + " of bridge " + quoted(spec.name);
  if (links == 0) {
    builder.fail(spec.place,
                 what + " is attached to nothing there, allowed: one that no bridge has yet");
  }
  if (is_bent && scene.mats[at(on)].type == MatType::kPoint) {
    builder.fail(spec.place, what +
                                 " bends and would end on a point, allowed: a mass, or a string "
                                 "without 'inharmonicity'");
  }
}

/// `settle` tunes the string together with what it ends on.
void keepPitch(SceneBuilder& builder, const BridgeSpec& spec, const Grid& grid) {
  Scene& scene = builder.scene();
  for (Tuning& body : scene.tunings) {
    if (body.first_mat == grid.first) {
      body.keeps_pitch = true;
      return;
    }
  }
  for (StringInfo& string : scene.strings) {
    if (string.first == grid.first && string.frequency_hz > 0.0) {
      string.keeps_pitch = true;
      return;
    }
  }
  builder.fail(spec.place, "string " + quoted(grid.name) + " of bridge " + quoted(spec.name) +
                               " has no pitch that it could keep, allowed: one with 'pitch' or "
                               "'frequency', or a bridge without 'keep_pitch'");
}

}  // namespace

void addBridge(SceneBuilder& builder, const BridgeSpec& spec) {
  std::vector<int> ends;
  for (const int index : spec.grids) {
    const Grid& grid = builder.scene().grids[at(index)];
    ends.push_back(spec.is_at_last ? grid.first + grid.columns - 1 : grid.first);
    const Mat& end = builder.scene().mats[at(ends.back())];
    if (end.type != MatType::kGround) {
      builder.fail(spec.place, "string " + quoted(grid.name) + " of bridge " + quoted(spec.name) +
                                   " has no ground at that end, allowed: strings, hinged bars");
    }
  }
  const Eigen::Vector3d rest = builder.scene().mats[at(ends.front())].rest;
  const int on = spec.on >= 0 ? spec.on : addOwn(builder, spec, rest);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Grid grid = builder.scene().grids[at(spec.grids[i])];
    attach(builder, spec, grid, ends[i], on);
    if (spec.keeps_pitch) {
      keepPitch(builder, spec, grid);
    }
  }
}

}  // namespace ergotic::scene
