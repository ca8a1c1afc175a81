// SPDX-License-Identifier: BSD-3-Clause
// The hands of the shipped strings: how they sound at the gestural rate of the models, against the
// same hands known in every frame.
#include <algorithm>
#include <array>
#include <complex>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"

namespace ergotic::physics {
namespace {

constexpr int kComparedPartials = 10;
constexpr double kFaint = 40.0;  // dB below the strongest: near a node of what excites or is heard
constexpr double kSeconds = 1.6;
constexpr std::size_t kWindow = 40000;

/// From one place to another, at rest at both, as a hand moves.
struct Move {
  double from_s;
  double to_s;
  int port;
  double way;
};

double eased(double share) {
  return 0.5 - 0.5 * std::cos(kPi * std::clamp(share, 0.0, 1.0));
}

struct Gesture {
  const char* model;
  const char* what;
  double pitch;  // Hz
  double heard_from_s;
  std::vector<Move> moves;
};

const Gesture kGestures[] = {
    {"models/string.yaml", "hammer", 110.0, 0.35, {{0.1, 0.14, 1, 0.032}, {0.14, 0.2, 1, -0.032}}},
    {"models/string.yaml", "pluck", 110.0, 0.35, {{0.1, 0.25, 0, 0.024}}},
    {"models/duet.yaml", "hammer", 110.0, 0.35, {{0.1, 0.14, 1, 0.032}, {0.14, 0.2, 1, -0.032}}},
    {"models/fretted_string.yaml", "pluck", 98.0, 0.35, {{0.1, 0.25, 0, 0.02}}},
    {"models/fretted_string.yaml", "finger", 116.5, 0.3, {{0.1, 0.14, 1, -0.0115}}},
};

using ComparedLevels = std::array<double, kComparedPartials>;

double handAt(const Gesture& gesture, int port, double time) {
  double place = 0.0;
  for (const Move& move : gesture.moves) {
    if (move.port == port) {
      place += move.way * eased((time - move.from_s) / (move.to_s - move.from_s));
    }
  }
  return place;
}

/// Of bands of a quarter tone around the partials, dB.
ComparedLevels levelsOf(const std::vector<double>& heard, const Gesture& gesture) {
  const auto from = static_cast<std::size_t>(gesture.heard_from_s * kRate);
  ComparedLevels levels{};
  for (int k = 1; k <= kComparedPartials; ++k) {
    double power = 0.0;
    const double reach = 0.015 * k * gesture.pitch;
    const double step = kRate / kWindow;
    for (double hz = k * gesture.pitch - reach; hz <= k * gesture.pitch + reach; hz += step) {
      std::complex<double> line;
      const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * hz / kRate);
      std::complex<double> phase = 1.0;
      for (std::size_t i = 0; i < kWindow; ++i) {
        const double hann = 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / kWindow);
        line += hann * heard[from + i] * phase;
        phase *= turn;
      }
      power += std::norm(line);
    }
    levels[at(k - 1)] = 10.0 * std::log10(power);
  }
  return levels;
}

ComparedLevels played(const Gesture& gesture, int ratio) {
  const scene::Scene scene = scene::readSceneFile(repository(gesture.model));
  Player player(scene, {kRate, ratio});  // with a chaplet as soft as this ratio needs it
  const double tick = ratio / kRate;
  for (int n = 0; n < static_cast<int>(kSeconds / tick); ++n) {
    for (std::size_t port = 0; port < player.positions.size(); ++port) {
      player.positions[port] = handAt(gesture, static_cast<int>(port), n * tick);
    }
    player.tick();
  }
  return levelsOf(player.heard[0], gesture);
}

TEST(DefaultHandsTest, SoundAsIfTheyWereKnownInEveryFrame) {
  for (const Gesture& gesture : kGestures) {
    SCOPED_TRACE(testing::Message() << gesture.model << ", " << gesture.what);
    const ComparedLevels wanted = played(gesture, 1);
    const ComparedLevels found = played(gesture, 14);
    const double most = *std::max_element(wanted.begin(), wanted.end());
    EXPECT_GT(most, 0.0) << "nothing is heard";
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (wanted[k] > most - kFaint) {
        EXPECT_NEAR(found[k], wanted[k], 0.5) << "partial " << k + 1;
      }
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
