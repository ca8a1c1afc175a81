// SPDX-License-Identifier: BSD-3-Clause
// A plate that hardens where it is bent far: struck weakly its sound grows darker, struck hard it
// climbs before it does.
#include <complex>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/bars.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr int kSide = 20;
constexpr double kFundamental = 60.0;  // Hz
constexpr double kThickness = 1e-3;    // m
constexpr double kModuleKg = 1e-3;     // kg, of each module
constexpr double kBlow = 0.002;        // s

std::string at2(int row, int column) {
  return "m" + std::to_string(row) + "_" + std::to_string(column);
}

/// h^2 K/M of its bends.
double plateKappa() {
  const double s = 2.0 - 2.0 * std::cos(kPi / (kSide + 1));
  return std::pow(std::sin(kPi * kFundamental / kRate) / s, 2.0);
}

/// Masses of 1 g between hinges, with losses that grow with the pitch.
scene::Scene plate() {
  const double k = plateKappa() * kModuleKg * kRate * kRate;
  std::string text =
      test::Bars(plateKappa(), ", damping: " + number(0.002 * k / kRate)).supportedPlate(kSide);
  for (int i = 1; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      for (const auto& [a, b] :
           {std::pair{at2(i, j), at2(i, j + 1)}, std::pair{at2(j, i), at2(j + 1, i)}}) {
        text += "  q_" + a + "_" + b + ": {type: cubic, between: [" + a + ", " + b +
                "], stiffness: 0, nonlinearity: " + number(5.46 * k / (kThickness * kThickness)) +
                ", tank: plate}\n";
      }
    }
  }
  text += "inputs:\n";
  for (const auto& [row, column] : {std::pair{8, 9}, {9, 9}, {8, 10}, {9, 10}}) {
    text += "  f_" + at2(row, column) + ": {mat: " + at2(row, column) +
            ", quantity: force, channel: 1}\n";
  }
  return scene::readYaml(text + "outputs: {v: {at: m13_7, quantity: velocity, channel: 1}}\n",
                         "gong.yaml");
}

/// Of the power around so many seconds, Hz.
double centroidAt(const std::vector<double>& sound, double seconds) {
  constexpr int kWindow = 2048;
  const auto first = static_cast<std::size_t>(seconds * kRate) - kWindow / 2;
  double sum = 0.0;
  double weighted = 0.0;
  for (int bin = 1; bin < kWindow / 4; ++bin) {
    std::complex<double> line = 0.0;
    for (int i = 0; i < kWindow; ++i) {
      const double hann = 0.5 - 0.5 * std::cos(2.0 * kPi * i / kWindow);
      line += hann * sound[first + at(i)] * std::polar(1.0, -2.0 * kPi * bin * i / kWindow);
    }
    sum += std::norm(line);
    weighted += std::norm(line) * bin * kRate / kWindow;
  }
  return weighted / sum;
}

/// The sound of a blow of so many N on each of four modules. Its energy never rises after it.
std::vector<double> struck(double newton) {
  Player player(plate(), kRates);
  double start = 0.0;
  double last = 0.0;
  for (int frame = 0; frame < static_cast<int>(0.65 * kRate); frame += kRates.ratio) {
    for (int r = 0; r < kRates.ratio; ++r) {
      const double s = std::sin(kPi * (frame + r) / (kRate * kBlow));
      player.inputs[at(r)] = frame + r < kBlow * kRate ? newton * s * s : 0.0;
    }
    player.tick();
    if (frame > kBlow * kRate) {
      const double stored = energiesOf(player).stored;
      start = start == 0.0 ? stored : start;
      EXPECT_LT(stored, (last == 0.0 ? stored : last) + 1e-10 * start);
      last = stored;
    }
  }
  EXPECT_GT(start, 0.0);
  return player.heard[0];
}

TEST(GongTest, GrowsDarkerStruckWeaklyAndClimbsStruckHard) {
  const std::vector<double> weak = struck(0.39);
  EXPECT_LT(centroidAt(weak, 0.6), 0.95 * centroidAt(weak, 0.05));
  EXPECT_LT(centroidAt(weak, 0.1), 1.01 * centroidAt(weak, 0.03));
  const std::vector<double> hard = struck(38.9);
  EXPECT_GT(centroidAt(hard, 0.1), 1.4 * centroidAt(hard, 0.025));
  EXPECT_LT(centroidAt(hard, 0.6), 0.8 * centroidAt(hard, 0.1));
  EXPECT_GT(centroidAt(hard, 0.1), 4.0 * centroidAt(weak, 0.1));
}

}  // namespace
}  // namespace ergotic::physics
