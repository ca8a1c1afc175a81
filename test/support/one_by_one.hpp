// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>

#include "physics/layout/layout.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

/// The same scene with and without blocks (physics/blocks.hpp).
namespace ergotic::test {

/// The scene with linear links that follow an audio input, which is to be 1: no block takes these.
inline scene::Scene oneByOne(scene::Scene scene) {
  const int channel = scene.inputChannels();
  const auto index = static_cast<int>(scene.audio_parameters.size());
  scene.audio_parameters.push_back({"one", channel, 1.0, {}});
  for (scene::Lia& lia : scene.lias) {
    if (lia.type == scene::LiaType::kSpringDamper && lia.stiffness.parameter < 0 &&
        lia.stiffness.audio < 0) {
      lia.stiffness.audio = index;
    }
  }
  return scene;
}

/// One array of numbers of an instrument's state, in the order of its slots.
template <class Real>
std::vector<Real> numbersOf(const physics::Instrument& instrument, const std::string& name) {
  std::vector<unsigned char> state(instrument.stateSize());
  instrument.saveState(state.data());
  for (const physics::StateEntry& entry : instrument.stateEntries()) {
    if (entry.name == name) {
      std::vector<Real> numbers(entry.size / sizeof(Real));
      std::memcpy(numbers.data(), state.data() + entry.offset, numbers.size() * sizeof(Real));
      return numbers;
    }
  }
  throw Exception("no state entry '" + name + "'");
}

/// Displacement from rest of every module of a scalar scene, m.
inline std::vector<double> displacementsOf(const physics::Instrument& instrument) {
  const bool is_float = instrument.precision() == physics::Precision::kFloat;
  std::vector<double> x;
  if (is_float) {
    const std::vector<float> numbers = numbersOf<float>(instrument, "x");
    x.assign(numbers.begin(), numbers.end());
  } else {
    x = numbersOf<double>(instrument, "x");
  }
  std::vector<double> displacements;
  for (const int slot : physics::makeLayout(instrument.scene(), instrument.rates()).slot_of_mat) {
    displacements.push_back(x[static_cast<std::size_t>(slot)]);
  }
  return displacements;
}

/// Largest difference, over the largest number of `b`.
inline double relativeDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    // Not std::max: this lets nothing pass that is not a number.
    difference = std::abs(a[i] - b[i]) <= difference ? difference : std::abs(a[i] - b[i]);
    largest = std::max(largest, std::abs(b[i]));
  }
  return largest > 0.0 ? difference / largest : difference;
}

/// Plays a scene in blocks as `options` say, and one by one in double precision. \return the
/// largest relative difference of the displacements in the end and of any channel
inline double differenceOneByOne(const scene::Scene& scene,
                                 const physics::CompileOptions& options,
                                 const physics::Rates& rates,
                                 int ticks) {
  Player blocks(physics::compile(scene, rates, options));
  Player single(physics::compile(oneByOne(scene), rates, physics::Precision::kDouble));
  const int channels = blocks.instrument->inputChannels();
  std::fill(blocks.inputs.begin(), blocks.inputs.end(), 0.01);
  for (int r = 0; r < rates.ratio; ++r) {
    for (int c = 0; c <= channels; ++c) {
      single.inputs[static_cast<std::size_t>(r * (channels + 1) + c)] = c < channels ? 0.01 : 1.0;
    }
  }
  blocks.ticks(ticks);
  single.ticks(ticks);
  double difference =
      relativeDifference(displacementsOf(*blocks.instrument), displacementsOf(*single.instrument));
  for (std::size_t c = 0; c < single.heard.size(); ++c) {
    difference = std::max(difference, relativeDifference(blocks.heard[c], single.heard[c]));
  }
  return difference;
}

}  // namespace ergotic::test
