// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {

/// One section and the ground, to which more modules are added.
inline const std::string kOfAudio = "ergotic: 1\nsections: {a: {}}\nmats:\n  g: {type: ground}\n";

/// A scene that is judged and played; output 1 is heard.
struct Certified {
  scene::Scene scene;
  Rates rates;
  explicit Certified(const std::string& text)
      : scene(scene::readYaml(text, "rounding.yaml")), rates(chooseRates(scene, kRate)) {
    scene = settle(scene, rates).scene;
  }
  bool isCertified() const { return certify(scene, rates).verdict <= Verdict::kBounded; }
  /// m/s
  double fastestOf(double seconds, Precision precision) const {
    Player player(compile(scene, rates, precision));
    double most = 0.0;
    for (int n = 0; n < seconds * rates.gesturalHz(); ++n) {
      player.tick();
      most = std::max(most, std::abs(player.heard.at(0).back()));
    }
    return most;
  }
};

}  // namespace ergotic::physics
