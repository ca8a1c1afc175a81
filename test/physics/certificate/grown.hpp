// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {

struct Grown {
  double times = 0.0;  ///< kinetic energy in all, of what there was at the start
  Certificate certificate;
};

inline Grown grown(const SceneBuilder& b, int ratio, double seconds, Precision precision) {
  Player player(compile(b.scene, {kRate, ratio}, precision));
  const double start = kineticEnergy(player);
  double most = start;
  for (int n = 0; n < static_cast<int>(seconds * kRate / ratio) && most < 1e12 * start; ++n) {
    player.tick();
    most = std::max(most, kineticEnergy(player));
  }
  return {most / start, certify(b.scene, {kRate, ratio})};
}

/// Played in both precisions it grows by so much, and is not certified.
inline void expectRefused(const SceneBuilder& b, int ratio, double seconds, double times) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const Grown scene = grown(b, ratio, seconds, precision);
    EXPECT_GT(scene.times, times);
    EXPECT_GE(scene.certificate.verdict, Verdict::kUnproven);
  }
}

}  // namespace ergotic::physics
