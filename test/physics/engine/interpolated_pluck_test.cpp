// SPDX-License-Identifier: BSD-3-Clause
// A stiff plectrum in a hand that faster sections see interpolated, against one that moves in every
// frame.
#include <array>
#include <complex>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using scene::Coupling;
using scene::LiaType;
using test::SceneBuilder;

constexpr int kMasses = 60;
constexpr int kPlucked = 8;
constexpr int kPartials = 10;
constexpr double kMassKg = 1e-3;
constexpr double kStiffness = 3e4;  // N/m, of the plectrum
constexpr double kWidth = 1e-3;     // m, that it bends by
constexpr double kSpeed = 0.05;     // m/s: 20 ms for the width
constexpr double kApart = 1.1e-3;   // m, of hand and string at the start

constexpr double kKappa = 0.2;

/// Of a partial in a frame.
double turnOf(int partial) {
  return 2.0 * std::asin(std::sqrt(kKappa) * std::sin(partial * kPi / (2.0 * (kMasses + 1))));
}

using Levels = std::array<double, kPartials>;

/// Of a hand that comes from below, starts over 20 ms, and goes on evenly.
double placeAt(double time) {
  constexpr double kStart = 0.02;  // s
  if (time <= 0.0) {
    return -kApart;
  }
  const double way = time < kStart
                         ? 0.5 * kSpeed * (time - std::sin(kPi * time / kStart) * kStart / kPi)
                         : kSpeed * (time - 0.5 * kStart);
  return way - kApart;
}

/// Of the partials that ring after the plectrum has let go, dB. \param late  of the hand, in ticks
Levels partialsOf(int ratio, Coupling coupling, double late) {
  SceneBuilder b;
  const int hand = b.slice(0);
  const int first = b.chain(kMasses, kMassKg, kKappa * kMassKg * kRate * kRate);
  b.link(LiaType::kPluck, hand, first + kPlucked, kStiffness);
  b.scene.lias.back().law.edit().width = {kWidth};
  b.scene.mats[at(hand)].coupling = coupling;
  b.hear(first + 2);
  Player player(b.scene, {kRate, ratio});
  const double tick = ratio / kRate;
  for (int n = 0; n < static_cast<int>(1.2 / tick); ++n) {
    player.positions[0] = placeAt((n - late) * tick);
    player.tick();
  }
  constexpr std::size_t kFrom = 8820;
  constexpr std::size_t kWindow = 40000;
  Levels levels{};
  for (int k = 1; k <= kPartials; ++k) {
    std::complex<double> line;
    for (std::size_t i = 0; i < kWindow; ++i) {
      const auto frame = static_cast<double>(i);
      const double hann = 0.5 - 0.5 * std::cos(2.0 * kPi * frame / kWindow);
      line += hann * player.heard[0][kFrom + i] * std::polar(1.0, -turnOf(k) * frame);
    }
    levels[at(k - 1)] = 20.0 * std::log10(std::abs(line));
  }
  return levels;
}

struct Difference {
  double rms = 0.0;
  double most = 0.0;
};

Difference differenceOf(const Levels& a, const Levels& b) {
  Difference difference;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference.rms += (a[k] - b[k]) * (a[k] - b[k]) / kPartials;
    difference.most = std::max(difference.most, std::abs(a[k] - b[k]));
  }
  difference.rms = std::sqrt(difference.rms);
  return difference;
}

/// At R = 44 the hand is known once a millisecond, and half of the partials lie above that.
TEST(InterpolatedPluckTest, SoundsAsIfTheHandMovedInEveryFrame) {
  struct Expected {
    int ratio;
    double held_rms;  // at least
    double most;
  };
  const Levels wanted = partialsOf(1, Coupling::kHold, 0.0);
  for (const Expected& e : {Expected{4, 0.03, 0.06}, {14, 0.4, 0.06}, {44, 7.0, 0.3}}) {
    for (const double late : {0.0, 0.3, 0.7}) {
      SCOPED_TRACE(testing::Message() << "R = " << e.ratio << ", " << late << " ticks late");
      const Difference held = differenceOf(partialsOf(e.ratio, Coupling::kHold, late), wanted);
      EXPECT_GT(held.rms, e.held_rms);
      const Difference interpolated =
          differenceOf(partialsOf(e.ratio, Coupling::kSmooth, late), wanted);
      EXPECT_LT(interpolated.rms, 0.1);
      EXPECT_LT(interpolated.most, e.most);
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
