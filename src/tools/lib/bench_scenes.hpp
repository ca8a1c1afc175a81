// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// A kind of scene that `bench` makes at any size. A module is a moving mass or a link.
struct BenchKind {
  const char* name;
  const char* what;  ///< in a few words
  int modules;       ///< how many if nobody asks
  bool is_plain;     ///< the plain implementation can play it
  /// A valid scene that moves from the start, as near to that many modules as its shape allows.
  scene::Scene (*make)(int modules);
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
