// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/scene.hpp"
#include "scene/laws/slopes.hpp"
#include "scene/limits.hpp"

/// Springs that remember: f = K e + Z v + sum K_r q_r, where each q_r follows e and fades in its
/// time tau_r: a spring in series with a damper (Maxwell). Source: docs/physics/elements.md,
/// "Relaxing springs".
namespace ergotic::scene {

constexpr Limits kRelaxationTimeLimits{"s", 1e-6, 1e3};
constexpr Limits kLossFactorLimits{"", 0.0, 0.5, true};

/// A word for how much of its energy a material loses in a radian, whatever the frequency.
struct Material {
  const char* word;
  double loss_factor;
};
constexpr Material kMaterials[] = {{"felt", 0.3}, {"nylon", 0.03}, {"gut", 0.02}, {"wood", 0.01}};

/// Three relaxations that together with a stiffness have the loss factor Im/Re within 2.7 % from
/// 100 Hz to 8 kHz. \param loss_factor  within its limits
std::vector<Relaxation> relaxationsOf(double loss_factor, const Value& stiffness);

/// Largest slopes of its force, in steps of that length: a motion with a period of two steps
/// stretches q by (tau/h) (1 - e^(-h/tau)) only.
Slopes relaxingSlopes(const Scene& scene, const Lia& lia, double step);

}  // namespace ergotic::scene
