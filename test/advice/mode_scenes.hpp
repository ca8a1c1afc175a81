// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "at.hpp"
#include "ergotic/advice/modes.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/bars.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/nets.hpp"
#include "support/physics.hpp"

/// What tests of the modes of a scene share.
namespace ergotic::physics {

using test::Bars;
using test::Nets;

inline SceneModes modesOf(const scene::Scene& scene, const ModeWindow& window = {}) {
  return physics::modesOf(settle(scene, kRates).scene, kRates, window, scene);
}

inline ModeWindow lowest(int most) {
  ModeWindow window;
  window.most = most;
  return window;
}

inline scene::Scene read(const std::string& text) {
  return scene::readYaml(text, "modes.yaml");
}

/// Of h^2 w^2 without losses.
inline double hertz(double lambda) {
  return 2.0 * std::asin(0.5 * std::sqrt(lambda)) * kRate / (2.0 * kPi);
}

/// 2 - 2 cos of the j-th of `masses` between hinges.
inline double hinged(int j, int masses) {
  const double half = std::sin(0.5 * j * kPi / (masses + 1));
  return 4.0 * half * half;
}

/// The lowest that a closed form gives, as often as it gives them.
inline void expectFrequencies(const SceneModes& found, std::vector<double> hz, double relative) {
  std::sort(hz.begin(), hz.end());
  ASSERT_LE(found.modes.size(), hz.size());
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    EXPECT_NEAR(found.modes[i].frequency_hz, hz[i], relative * hz[i]) << i;
  }
  EXPECT_TRUE(found.is_certain);
}

inline scene::Scene chainOf(int masses, double kappa, double zeta = 0.0) {
  SceneBuilder b;
  b.chain(masses, 1e-3, kappa * 1e-3 * kRate * kRate, zeta * 1e-3 * kRate);
  return b.scene;
}

}  // namespace ergotic::physics
