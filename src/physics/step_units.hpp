// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "scene/laws/units.hpp"

namespace ergotic::physics {

/// The units of a step of sections with this divisor.
struct StepUnits : scene::Units {
  StepUnits(const scene::Scene& scene, const Rates& rates, int divisor)
      : Units{divisor / (rates.audio_hz * scene.time_unit_s)} {}
};

}  // namespace ergotic::physics
