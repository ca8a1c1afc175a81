// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "scene/generate/scene_builder.hpp"

namespace ergotic::tools {

/// A kind of scene that `bench` makes at any size. A module is a moving mass or a link.
struct BenchKind {
  const char* name;
  const char* what;  ///< in a few words
  int modules;       ///< how many if nobody asks
  bool is_plain;     ///< the plain implementation can play it
  /// Adds as near to that many modules as its shape allows.
  void (*add)(scene::SceneBuilder& builder, int modules);
  bool is_scattered = false;  ///< every element gets coefficients of its own
  scene::Geometry geometry = scene::Geometry::kScalar;

  /// A valid scene of that size that moves from the start.
  scene::Scene make(int size) const;
};

const std::vector<BenchKind>& benchKinds();

/// \throws Exception that lists them all if there is no such kind
const BenchKind& benchKindNamed(const std::string& name);

/// Moving masses and links.
std::size_t modulesOf(const scene::Scene& scene);

/// 44.1 kHz, and 14 frames per tick.
physics::Rates benchRates();

constexpr int kMinBenchModules = 20;
constexpr int kMaxBenchModules = 2'000'000;

}  // namespace ergotic::tools
