// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {

/// Coefficients by which a module moves in one step without forces: d <- d - (lose d + pull x).
struct OscillatorCoefficients {
  double lose = 0.0;
  double pull = 0.0;
};

/// Plain: lose = h Z/M, pull = h^2 K/M (first order). Matched: the samples of the continuous
/// oscillator, lose = 1 - e^(-2sh), pull = 2 - lose - 2 e^(-sh) cos(wd h), with s = Z/2M,
/// wd^2 = K/M - s^2. Masses in a medium are matched. Realtime: yes. Source:
/// docs/physics/elements.md, "Cells"
OscillatorCoefficients oscillatorOf(
    double stiffness, double damping, double mass, double step, bool matched) noexcept;

/// Coefficients of a mass or a cell of a scene, its section's medium included. Realtime: yes
OscillatorCoefficients oscillatorOf(const scene::Scene& scene,
                                    const scene::Mat& mat,
                                    const StepUnits& units) noexcept;

}  // namespace ergotic::physics
