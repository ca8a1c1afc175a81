// SPDX-License-Identifier: BSD-3-Clause
// Bodies that are played by their modes: bars, strings, membranes, plates, and tables of partials.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::cents;

scene::Scene read(const std::string& generators, const std::string& rest = "") {
  return scene::readYaml(
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n  - {name: b, " + generators + "}\n" + rest,
      "modal.yaml");
}

struct Mode {
  double hz;
  double t60_s;
};

/// What the cells of a scene are as oscillators.
std::vector<Mode> modesOf(const scene::Scene& scene) {
  std::vector<Mode> modes;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.type == scene::MatType::kCell) {
      const double sigma = 0.5 * mat.damping.factor / mat.mass.factor;
      const double omega = std::sqrt(mat.stiffness.factor / mat.mass.factor - sigma * sigma);
      modes.push_back({omega / (2.0 * kPi), std::log(1000.0) / sigma});
    }
  }
  return modes;
}

void expectRatios(const std::vector<Mode>& modes,
                  const std::vector<double>& ratios,
                  double within) {
  ASSERT_GE(modes.size(), ratios.size());
  for (std::size_t j = 0; j < ratios.size(); ++j) {
    EXPECT_NEAR(cents(modes[j].hz / modes[0].hz, ratios[j]), 0.0, within) << j;
  }
}

TEST(ModalBodyTest, BarsHaveThePartialsOfBeams) {
  const std::string bar = "type: bar, as: modes, mass: 0.2, pitch: 440, ";
  expectRatios(modesOf(read(bar + "ends: free")), {1.0, 2.7565, 5.4039, 8.9330, 13.3443}, 1.5);
  expectRatios(modesOf(read(bar + "ends: [clamped, free]")), {1.0, 6.2669, 17.5475, 34.3861}, 2.0);
  expectRatios(modesOf(read(bar + "ends: hinged")), {1.0, 4.0, 9.0, 16.0}, 2.0);
  expectRatios(modesOf(read(bar + "ratios: [4, 10]")), {1.0, 4.0, 10.0}, 0.01);
  expectRatios(modesOf(read(bar + "ratios: [3, 6]")), {1.0, 3.0, 6.0}, 0.01);
  EXPECT_NEAR(modesOf(read(bar + "ends: free"))[0].hz, 440.0, 1e-9);
}

TEST(ModalBodyTest, StringsHaveThePartialsOfTheirInharmonicity) {
  const std::vector<Mode> modes =
      modesOf(read("type: string, as: modes, mass: 1e-4, pitch: C4, inharmonicity: 3.5e-4, "
                   "partials: 16, t60: [[1, 13], [16, 1]], to: [0.6, 0]"));
  ASSERT_EQ(modes.size(), 16U);
  for (int j = 1; j <= 16; ++j) {
    EXPECT_NEAR(modes[at(j - 1)].hz,
                j * 261.6255653 * std::sqrt((1.0 + 3.5e-4 * j * j) / (1.0 + 3.5e-4)), 1e-6 * j);
  }
  EXPECT_NEAR(modes[0].t60_s, 13.0, 1e-9);
  EXPECT_NEAR(modes[15].t60_s, 1.0, 1e-9);
}

TEST(ModalBodyTest, RoundMembranesAreNearlyIdeal) {
  expectRatios(modesOf(read("type: membrane, as: modes, shape: round, cells: 30, mass: 0.05, "
                            "pitch: 100, partials: 10")),
               {1.0, 1.5933, 1.5933, 2.1355, 2.1355, 2.2954, 2.6531, 2.6531, 2.9173, 2.9173}, 5.0);
}

TEST(ModalBodyTest, TablasComeNearTheModelOfRamakrishnaAndSondhi) {
  // To the lowest, 1.033 of their unit: 2.000, 3.043, 3.152, 4.096.
  const std::vector<Mode> modes =
      modesOf(read("type: membrane, as: modes, shape: round, cells: 40, mass: 0.05, pitch: 100, "
                   "load: {ratio: 9.765625, radius: 0.4}, partials: 9"));
  for (const double ratio : {2.0 / 1.033, 3.043 / 1.033, 3.152 / 1.033, 4.096 / 1.033}) {
    const auto nearest =
        *std::min_element(modes.begin(), modes.end(), [&](const Mode& a, const Mode& b) {
          return std::abs(a.hz - ratio * 100.0) < std::abs(b.hz - ratio * 100.0);
        });
    EXPECT_NEAR(cents(nearest.hz, ratio * 100.0), 0.0, 15.0) << ratio;
  }
}

TEST(ModalBodyTest, KettledrumsAreAlmostHarmonic) {
  const std::vector<Mode> modes =
      modesOf(read("type: membrane, as: modes, shape: round, cells: 40, mass: 0.2, pitch: 147, "
                   "pitch_of: 2, load: {ratio: 6.018, power: 10.52}, partials: 24"));
  for (const double ratio : {1.0, 1.5, 1.98, 2.44}) {
    const auto nearest =
        *std::min_element(modes.begin(), modes.end(), [&](const Mode& a, const Mode& b) {
          return std::abs(a.hz - ratio * 147.0) < std::abs(b.hz - ratio * 147.0);
        });
    EXPECT_NEAR(cents(nearest.hz, ratio * 147.0), 0.0, 15.0) << ratio;
  }
}

TEST(ModalBodyTest, TheEndOfAFreeBarMovesTwiceAsFarAsTheBarDoesOnAverage) {
  const scene::Scene scene = read(
      "type: bar, as: modes, mass: 0.2, pitch: 440, partials: 3, places: {end: 1, node: 0.2242}");
  ASSERT_EQ(scene.taps.size(), 2U);
  for (const scene::Tap::Share& share : scene.taps[0].shares) {
    EXPECT_NEAR(std::abs(share.weight), 2.0, 0.1);  // of the last mass, half a spacing before it
    EXPECT_NEAR(scene.mats[at(share.mat)].mass.factor, 0.2, 1e-12);
  }
  EXPECT_NEAR(scene.taps[1].shares[0].weight, 0.0, 0.02);
}

/// Where a 10 g hammer is that comes with 1 m/s onto the place `hit` of a body.
std::vector<double> hammerOn(const std::string& body) {
  const scene::Scene scene =
      read(body + ", places: {hit: 0.3}",
           "mats: {h: {type: mass, mass: 10 g, x: -1e-3, v: 1}}\n"
           "lias: {c: {type: contact, between: [h, b.hit], stiffness: 50 kN/m}}\n"
           "outputs: {o: {at: h, quantity: velocity, channel: 1}}\n");
  const scene::Scene settled = settle(scene, {kRate, 14}).scene;
  EXPECT_NE(certify(settled, {kRate, 14}).verdict, Verdict::kUnstable);
  Player player(settled, {kRate, 14}, Precision::kDouble);
  player.ticks(40);
  return player.heard[0];
}

TEST(ModalBodyTest, AHammerFeelsTheSameBodyAsANetworkAndAsItsModes) {
  const std::string body = "type: bar, ends: hinged, mass: 0.3, pitch: 200, t60: 1, masses: 10";
  const std::vector<double> network = hammerOn(body);
  const std::vector<double> modes = hammerOn(body + ", as: modes, partials: 10");
  ASSERT_EQ(network.size(), modes.size());
  EXPECT_LT(network.back(), 0.5);  // it was held up
  for (std::size_t n = 0; n < network.size(); ++n) {
    EXPECT_NEAR(network[n], modes[n], 0.03) << n;
  }
}

/// The lowest that is heard of a scene, which has one output.
Mode heard(
    scene::Scene scene, std::size_t index, double guess_hz, double rate_hz, Precision precision) {
  std::size_t cell = 0;
  for (scene::Mat& mat : scene.mats) {
    if (mat.type == scene::MatType::kCell && cell++ == index) {
      mat.position.x() = 1e-3;
    }
  }
  Player player(settle(scene, {rate_hz, 14}).scene, {rate_hz, 14}, precision);
  player.ticks(static_cast<int>(30.0 / guess_hz * rate_hz / 14.0) + 10);
  const auto every =
      static_cast<std::size_t>(std::max(1L, std::lround(rate_hz / (6.0 * guess_hz))));
  std::vector<double> steps;
  for (std::size_t n = 0; n < player.heard[0].size(); n += every) {
    steps.push_back(player.heard[0][n]);
  }
  const std::complex<double> pole = std::pow(test::poleOf(steps), 1.0 / static_cast<double>(every));
  return {std::arg(pole) / (2.0 * kPi) * rate_hz,
          -std::log(1000.0) / (std::log(std::abs(pole)) * rate_hz)};
}

TEST(ModalBodyTest, BarsOfModesSoundWhereTheyWereAskedToFromA0ToC8) {
  for (const double rate_hz : {44100.0, 48000.0, 96000.0}) {
    for (const double hz : {27.5, 110.0, 440.0, 1760.0, 4186.0}) {
      const double t60 = 0.5 + 20.0 / hz;
      const scene::Scene scene = read("type: bar, as: modes, mass: 0.01, pitch: " + number(hz) +
                                          ", t60: " + number(t60) + ", partials: 2, places: {o: 0}",
                                      "outputs: {o: {at: b.o, quantity: position, channel: 1}}\n");
      for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
        const Mode mode = heard(scene, 0, hz, rate_hz, precision);
        EXPECT_NEAR(cents(mode.hz, hz), 0.0, precision == Precision::kDouble ? 1e-3 : 0.5)
            << hz << " at " << rate_hz;
        EXPECT_NEAR(mode.t60_s / t60, 1.0, 0.02) << hz << " at " << rate_hz;
      }
    }
  }
}

TEST(ModalBodyTest, ABellHasThePartialsOfItsTable) {
  // Hum, prime, tierce, quint, nominal; s: Rossing, Science of Percussion Instruments.
  const std::vector<std::pair<double, double>> table{
      {0.5, 52.0}, {1.0, 16.0}, {1.183, 16.0}, {1.506, 6.0}, {2.0, 3.0}};
  std::string rows;
  for (const auto& [ratio, seconds] : table) {
    rows += "[" + number(ratio) + ", " + number(seconds) + ", 5, 1, 0.5], ";
  }
  const scene::Scene scene =
      read("type: resonator, pitch: 440, places: [rim, waist], partials: [" + rows + "]",
           "outputs: {o: {at: b.waist, quantity: position, channel: 1}}\n");
  EXPECT_EQ(certify(settle(scene, {kRate, 14}).scene, {kRate, 14}).verdict, Verdict::kPassive);
  for (std::size_t j = 0; j < table.size(); ++j) {
    const double hz = 440.0 * table[j].first;
    const Mode mode = heard(scene, j, hz, kRate, Precision::kDouble);
    EXPECT_NEAR(cents(mode.hz, hz), 0.0, 1e-3);
    EXPECT_NEAR(mode.t60_s / table[j].second, 1.0, 0.02);
  }
}

}  // namespace
}  // namespace ergotic::physics
