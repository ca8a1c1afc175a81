// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/rates.hpp"

/// How faster sections see a slice with `coupling: smooth`: its positions interpolated by a
/// quadratic B-spline, its forces returned by the adjoint weights.
/// Source: docs/physics/multirate.md, "Interpolated hands".
namespace ergotic::physics {

/// One of the N steps of a faster section in a tick. With X the position of this tick, D its change
/// and D' that of the tick before, the slice is seen at `X - behind D - behind_last D'` and to have
/// moved by `share D + share_last D'`; these two weights are those of the force as well, which
/// answers D a tick later.
struct InterpolationStep {
  double behind = 0.0;
  double behind_last = 0.0;
  double share = 0.0;
  double share_last = 0.0;
};

/// \param steps  N >= 2
std::vector<InterpolationStep> interpolationSteps(int steps);

/// Force on a slice by a spring of 1 N/m (a damper of 1 N s per tick) to the ground, after a
/// displacement of 1 m in tick 0 alone. [ticks]
struct InterpolationResponse {
  std::vector<double> spring;
  std::vector<double> damper;
};
/// \param steps  N >= 2
InterpolationResponse interpolationResponse(int steps);

/// Delay of the force against that of a held slice, in ticks, for slow motion.
constexpr double kInterpolationDelay = 1.5;

/// Images that faster sections get beside the movement of a hand that swings by so much of a turn
/// in a tick: on both sides of every multiple of the rate, rms relative to that movement. After k
/// means over a tick they are `turn^k sqrt(2 zeta(2 k))`.
double heardSteps(scene::Coupling coupling, double turn);

/// Whether modules of a section see this one interpolated: a smooth slice that is slower than they.
bool isInterpolated(const scene::Scene& scene, const Rates& rates, int mat, int section);

/// True if the ends of a link see one another interpolated.
inline bool isInterpolated(const scene::Scene& scene, const Rates& rates, const scene::Lia& lia) {
  const auto section = [&](int mat) { return scene.mats[static_cast<std::size_t>(mat)].section; };
  return isInterpolated(scene, rates, lia.a, section(lia.b)) ||
         isInterpolated(scene, rates, lia.b, section(lia.a));
}

}  // namespace ergotic::physics
