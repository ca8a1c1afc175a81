// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "fuzz/fuzz.hpp"

namespace ergotic::fuzz {

constexpr std::size_t kMaxPlayed = 40;  ///< modules and links: eigenvalues of more are slow

using SceneReader = scene::Scene (*)(const std::string&,
                                     const std::string&,
                                     const scene::Overrides&);

inline void play(physics::Instrument& instrument) {
  const auto count = [](int channels) { return static_cast<std::size_t>(channels); };
  const std::size_t frames = count(instrument.rates().ratio);
  std::vector<double> positions(count(instrument.ports()), 0.01);
  std::vector<double> forces(positions.size());
  std::vector<double> inputs(frames * count(instrument.inputChannels()), 0.5);
  std::vector<double> outputs(frames * count(instrument.outputChannels()));
  for (int tick = 0; tick < 3; ++tick) {
    instrument.tick({positions.data(), forces.data(), inputs.data(), outputs.data()});
  }
}

/// Agents want to be somewhere at any time.
inline void follow(const scene::Scene& scene) {
  for (const scene::Agent& agent : scene.agents) {
    for (const double time_s : {0.0, 1e-9, 0.5, 1e9}) {
      if (!std::isfinite(agent.at(time_s))) {
        fail("agent " + agent.name + " wants to be nowhere");
      }
    }
  }
}

/// Settles a scene; one that is small is certified and played, whatever the verdict.
inline void tryScene(const scene::Scene& scene) {
  follow(scene);
  const physics::Rates rates = physics::chooseRates(scene, 48000.0);
  const physics::Settled settled = physics::settle(scene, rates);
  if (settled.scene.mats.size() + settled.scene.lias.size() <= kMaxPlayed) {
    physics::certify(settled.scene, rates);
    play(*physics::compile(settled.scene, rates, physics::Precision::kFloat));
  }
}

/// Reads a scene, and again the text that it keeps, and tries it.
inline void readScene(const std::string& text, SceneReader read) {
  const auto scene = readOrRefuse(text, [&] { return read(text, kFile, {}); });
  if (!scene) {
    return;
  }
  if (read(scene->text, kFile, {}).mats.size() != scene->mats.size()) {
    fail("the text that the scene keeps is of another scene:\n" + scene->text);
  }
  try {
    tryScene(*scene);
  } catch (const Exception&) {  // rates that do not go together, and the like
  }
}

}  // namespace ergotic::fuzz
