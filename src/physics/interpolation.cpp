// SPDX-License-Identifier: BSD-3-Clause
#include "physics/interpolation.hpp"

#include <cmath>

#include "at.hpp"

namespace ergotic::physics {

std::vector<InterpolationStep> interpolationSteps(int steps) {
  const double n = steps;
  std::vector<InterpolationStep> all;
  for (int r = 0; r < steps; ++r) {
    const double gone = (r + 1.0) * (r + 2.0) / (2.0 * n * n);
    const double gone_last =
        (n + 1.0) / (2.0 * n) + (2.0 * (n - 1.0) * (r + 1.0) - r * (r + 1.0)) / (2.0 * n * n);
    all.push_back({1.0 - gone, 1.0 - gone_last, (r + 1.0) / (n * n), (n - 1.0 - r) / (n * n)});
  }
  return all;
}

InterpolationResponse interpolationResponse(int steps) {
  constexpr std::size_t kTicks = 6;
  const std::vector<InterpolationStep> step_weights = interpolationSteps(steps);
  const double position[kTicks] = {1.0};
  const double change[kTicks] = {1.0, -1.0};
  InterpolationResponse answer{std::vector<double>(kTicks), std::vector<double>(kTicks)};
  double spring = 0.0;  // forces of the step before
  double damper = 0.0;
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    const double last = tick == 0 ? 0.0 : change[tick - 1];
    for (const InterpolationStep& step : step_weights) {
      const double x = position[tick] - step.behind * change[tick] - step.behind_last * last;
      const double d = steps * (step.share * change[tick] + step.share_last * last);
      const auto give = [&](std::vector<double>& to, double force) {
        to[tick] += 0.5 * step.share_last * force;
        if (tick + 1 < kTicks) {
          to[tick + 1] += 0.5 * step.share * force;
        }
      };
      give(answer.spring, spring + x);
      give(answer.damper, damper + d);
      spring = x;
      damper = d;
    }
  }
  return answer;
}

double heardSteps(scene::Coupling coupling, double turn) {
  constexpr double kLeftByChaplets = 0.025;  // at least 32 dB less
  const double held = 2.0 * 3.14159265358979323846 / std::sqrt(12.0) * turn;
  switch (coupling) {
    case scene::Coupling::kSmooth:
      return 1.4265 * turn * turn * turn;
    case scene::Coupling::kChaplet:
      return kLeftByChaplets * held;
    default:
      return held;
  }
}

bool isInterpolated(const scene::Scene& scene, const Rates& rates, int mat, int section) {
  const scene::Mat& m = scene.mats[at(mat)];
  return m.type == scene::MatType::kSlice && m.coupling == scene::Coupling::kSmooth &&
         divisorOf(scene.sections[at(section)], rates) < divisorOf(scene.sectionOf(m), rates);
}

}  // namespace ergotic::physics
