// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::physics {
namespace {

struct StringCase {
  const char* section;
  const char* fields;
  const char* to;
  const char* axis;
};

/// The pitch of the scene's string, let go in the shape of its first mode: when one mode moves
/// alone, x[n+1] = p x[n] - q x[n-1] for every mass and frame.
double playedPitchHz(scene::Scene scene, const Rates& rates) {
  const scene::StringInfo& string = scene.strings[0];
  const int axis = scene.outputs[0].axis;
  for (int i = 0; i < string.count; ++i) {
    scene.mats[static_cast<std::size_t>(string.first + i)].position[axis] +=
        1e-5 * std::sin(M_PI * i / (string.count - 1));
  }
  const auto instrument = compile(settle(scene, rates).scene, rates, Precision::kDouble);
  std::vector<double> x(static_cast<std::size_t>(rates.ratio));
  TickIo io;
  io.outputs = x.data();
  instrument->tick(io);
  for (double& position : x) {
    position -= scene.mats[static_cast<std::size_t>(scene.outputs[0].point.mat)].rest[axis];
  }
  const double determinant = x[2] * x[2] - x[1] * x[3];
  const double p = (x[2] * x[3] - x[1] * x[4]) / determinant;
  const double q = (x[3] * x[3] - x[2] * x[4]) / determinant;
  return std::acos(p / (2.0 * std::sqrt(q))) / (2.0 * M_PI) * rates.audio_hz;
}

TEST(StringPitchTest, IsWhatTheInstrumentPlaysInEveryGeometry) {
  constexpr std::array<StringCase, 9> kCases{{
      {"", "frequency: 880, damping: 1e-3, loss: 1e-2", "[1, 0]", "x"},
      {"medium: 0.02", "frequency: 880", "[1, 0]", "x"},
      {"medium: 0.02", "frequency: 880, loss: 0.01", "[1, 0]", "x"},
      {"", "frequency: 880, coarse: true, damping: 1e-3", "[1, 0]", "x"},
      {"geometry: line", "frequency: 880, rest_length_ratio: 0.7, damping: 1e-3", "[1]", "x"},
      {"geometry: plane", "frequency: 880, damping: 1e-3", "[1, 0]", "y"},
      {"geometry: plane", "frequency: 880, rest_length_ratio: 0.7, loss: 0.01", "[1, 0]", "y"},
      {"geometry: plane, medium: 0.02", "stiffness: 1e4, rest_length_ratio: 0.5", "[1, 0]", "y"},
      {"geometry: space", "frequency: 880, rest_length_ratio: 0.7", "[1, 0, 0]", "z"},
  }};
  for (const StringCase& each : kCases) {
    const Rates rates;
    const Settled settled = settle(
        scene::readYaml("ergotic: 1\nsections: {a: {" + std::string(each.section) +
                            "}}\ngenerators: [{type: string, name: s, masses: 9, mass: 1e-4, " +
                            each.fields + ", to: " + each.to +
                            "}]\noutputs: {o: {at: s.5, quantity: position, channel: 1, " +
                            "axis: " + each.axis + "}}\n",
                        "string.yaml"),
        rates);
    const double expected = stringPitchHz(settled.scene, settled.scene.strings[0], rates.audio_hz);
    EXPECT_NEAR(playedPitchHz(settled.scene, rates), expected, 1e-7 * expected)
        << each.section << " " << each.fields;
  }
}

}  // namespace
}  // namespace ergotic::physics
