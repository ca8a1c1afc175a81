// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lab/lib/plain_network.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

/// For test programs that are linked with the tools.
namespace ergotic::test {

/// Every coordinate of every module on a channel of its own; the other outputs go.
inline scene::Scene hearEverything(scene::Scene scene) {
  scene.outputs.clear();
  for (std::size_t i = 0; i < scene.mats.size(); ++i) {
    for (int c = 0; c < scene::dimensionsOf(scene.sectionOf(scene.mats[i]).geometry); ++c) {
      scene::Output output;
      output.point.mat = static_cast<int>(i);
      output.axis = c;
      output.channel = static_cast<int>(scene.outputs.size());
      scene.outputs.push_back(output);
    }
  }
  return scene;
}

/// Largest difference of any coordinate after any tick between the instrument and the plain
/// implementation in double precision, over the largest motion. \pre the plain one can play it
inline double differenceFromPlain(const scene::Scene& scene,
                                  const physics::CompileOptions& options,
                                  const physics::Rates& rates,
                                  int ticks) {
  const scene::Scene heard = hearEverything(scene);
  Player player(physics::compile(heard, rates, options));
  const auto plain = tools::makePlainNetwork(scene, rates, physics::Precision::kDouble);
  std::vector<double> displacements(heard.outputs.size());
  double difference = 0.0;
  double motion = 0.0;
  for (int tick = 0; tick < ticks; ++tick) {
    player.tick();
    plain->step(rates.ratio);
    plain->readDisplacements(displacements.data());
    for (std::size_t i = 0; i < displacements.size(); ++i) {
      const scene::Output& output = heard.outputs[i];
      const scene::Mat& mat = heard.mats[static_cast<std::size_t>(output.point.mat)];
      const double moved = player.heard[i].back() - mat.rest[output.axis];
      difference = std::max(difference, std::abs(moved - displacements[i]));
      motion = std::max(motion, std::abs(displacements[i]));
    }
  }
  return difference / motion;
}

}  // namespace ergotic::test
