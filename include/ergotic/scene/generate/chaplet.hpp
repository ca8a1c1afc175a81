// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace ergotic::scene {

/// One stage of a low-pass chaplet: a spring and a damper, then a mass behind them. The first stage
/// is attached to the slower end, the mass of the last one touches the structure.
///
/// Here in units of the total mass m and of wN = pi times the slower rate: stiffness in m wN^2,
/// damping in m wN, mass in m. Both tables were found by bounded optimisation of the discrete
/// response over the loads {free, Z/3, Z} with Z = 0.05 m wN, under the limit of the explicit
/// scheme; what they do is in docs/physics/multirate.md, "Chaplets: mechanical low-passes".
struct ChapletStage {
  double stiffness = 0.0;
  double damping = 0.0;
  double mass = 0.0;
};

/// Two masses: stable from four steps of the faster rate to one of the slower on. The one in use.
constexpr std::array<ChapletStage, 2> kChapletC2{{{0.0083, 0.2237, 0.4475}, {0.0705, 0.0, 0.5525}}};
constexpr int kChapletC2LowestRatio = 4;

/// Three masses: stops more, is unstable below eight steps to one.
constexpr std::array<ChapletStage, 3> kChapletC3{
    {{0.12486, 0.0, 0.458}, {0.08851, 0.0614, 0.059}, {0.00408, 0.10731, 0.483}}};
constexpr int kChapletC3LowestRatio = 8;

}  // namespace ergotic::scene
