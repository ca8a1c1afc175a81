// SPDX-License-Identifier: BSD-3-Clause
// Membranes and plates that harden: how far the pitch of mode 1 rises, and what is certified.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr int kCells = 11;
constexpr double kSheetPitch = 200.0;

scene::Scene sheet(const std::string& keys) {
  return scene::readYaml(
      "ergotic: 1\nsections: {a: {}}\ngenerators: [{name: b, mass: 0.2, cells: 11, "
      "pitch: 200, spacing: 0.01, " +
          keys + "}]\noutputs: {x: {at: 'b@0.5:0.5', quantity: position, channel: 1}}\n",
      "hard.yaml");
}

/// In mode (1, 1), of which it is heard where it is largest.
double pitchAt(const std::string& keys, double amplitude, Precision precision) {
  scene::Scene scene = sheet(keys);
  const double side = kCells + 1.0;
  for (int row = 1; row <= kCells; ++row) {
    for (int column = 1; column <= kCells; ++column) {
      scene.mats[at(row * (kCells + 2) + column)].position.x() =
          amplitude * std::sin(kPi * row / side) * std::sin(kPi * column / side);
    }
  }
  Player player(scene, kEveryFrame, precision);
  player.ticks(12000);
  const std::vector<double>& x = player.heard[0];
  double first = -1.0;
  double last = 0.0;
  int periods = -1;
  for (std::size_t n = 1; n < x.size(); ++n) {
    if (x[n - 1] < 0.0 && x[n] >= 0.0) {
      last = static_cast<double>(n) - x[n] / (x[n] - x[n - 1]);
      first = first < 0.0 ? last : first;
      ++periods;
    }
  }
  return kRate * periods / (last - first);
}

/// V = k A^2/2 + q A^4/4 swings 3 q A^2/(8 k) faster. By Berger's mean a square plate between
/// hinges has q/k = 1.5/t^2; a membrane of strain e and side L has q/k = pi^2/(8 e L^2).
TEST(HardSheetsTest, ModesGlideByTheFormula) {
  constexpr double kThickness = 2e-3;
  constexpr double kStrain = 5e-3;
  const double length = 0.01 * (kCells + 1);
  // Of a grid: the mean square of the slopes is less by that.
  const double step = kPi / (kCells + 1);
  const double coarse = std::pow(2.0 * std::sin(0.5 * step) / step, 2);
  const std::string plate = "type: plate, edges: supported, hardening: global, thickness: 2 mm";
  const std::string skin = "type: membrane, neighbours: 4, hardening: global, strain: 5e-3";
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    for (const double share : {0.1, 0.2}) {
      const double by_plate = 0.375 * 1.5 * share * share;
      EXPECT_NEAR((pitchAt(plate, share * kThickness, precision) / kSheetPitch - 1.0) / by_plate,
                  1.0, 0.04)
          << share;
      const double amplitude = 0.05 * share * length;
      const double by_skin =
          0.375 * kPi * kPi / 8.0 / kStrain * coarse * std::pow(amplitude / length, 2);
      EXPECT_NEAR((pitchAt(skin, amplitude, precision) / kSheetPitch - 1.0) / by_skin, 1.0, 0.04)
          << share;
    }
  }
}

TEST(HardSheetsTest, LocalLinksStoreWhatStretchingStores) {
  for (const char* const edges : {"supported", "clamped", "free"}) {
    const scene::Scene scene =
        settle(sheet(std::string(
                         "type: plate, hardening: local, thickness: 2 mm, t60: [[1, 2], [6, 1]], "
                         "edges: ") +
                     edges),
               kEveryFrame)
            .scene;
    // The crosses of held plates, and of free ones the bends along rows in the middle, K (1 - 0.3).
    double bending = 0.0;
    for (const scene::Bend& bend : scene.bends) {
      if (bend.ends.size() == 5) {
        bending =
            std::string(edges) == "free" ? bend.stiffness.factor / 0.3 : bend.stiffness.factor;
      }
    }
    int links = 0;
    for (const Lia& lia : scene.lias) {
      if (lia.type == LiaType::kCubic) {
        ++links;
        EXPECT_NEAR(lia.law->nonlinearity.factor / (6.0 * bending / 4e-6), 1.0, 1e-9) << lia.name;
      }
    }
    EXPECT_EQ(links, std::string(edges) == "free" ? 2 * 11 * 10 : 2 * 11 * 12) << edges;
  }
}

/// Energy never grows, however hard it is hit.
TEST(HardSheetsTest, ArePassive) {
  for (const std::string keys :
       {"type: plate, edges: supported, thickness: 0.5 mm, hardening: ",
        "type: plate, thickness: 0.5 mm, hardening: ",
        "type: membrane, shape: round, cells: 6, strain: 1e-4, hardening: ",
        "type: membrane, strain: 1e-4, hardening: "}) {
    for (const char* const how : {"local", "global"}) {
      std::string text = keys + how;
      scene::Scene scene = scene::readYaml(
          "ergotic: 1\nsections: {a: {}}\ngenerators: [{name: b, mass: 0.2, " +
              (keys.find("cells") == std::string::npos ? std::string("cells: 8, ") : "") +
              "pitch: 200, spacing: 0.01, t60: 2, " + text + "}]\n",
          "hard.yaml");
      EXPECT_EQ(certify(settle(scene, kEveryFrame).scene, kEveryFrame).verdict, Verdict::kPassive)
          << text;
      for (scene::Mat& mat : scene.mats) {
        if (mat.type == scene::MatType::kCell && mat.rest.y() < 0.03) {
          setVelocity(mat, {10.0, 0.0, 0.0});
        }
      }
      Player player(scene, {kRate, 14});
      player.tick();
      const double start = energiesOf(player).stored;
      for (int n = 0; n < 1000; ++n) {
        player.tick();
        ASSERT_LT(energiesOf(player).stored, start * (1.0 + 1e-9)) << text << n;
      }
      EXPECT_GT(start, 0.0);
    }
  }
}

TEST(HardSheetsTest, RefuseWhatCannotBe) {
  using ::testing::HasSubstr;
  const auto refusal = [](const std::string& keys) -> std::string {
    try {
      sheet(keys);
    } catch (const Exception& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(refusal("type: plate, hardening: local"), HasSubstr("without 'thickness'"));
  EXPECT_THAT(refusal("type: plate, thickness: 1 mm"), HasSubstr("without 'hardening'"));
  EXPECT_THAT(refusal("type: plate, thickness: 0, hardening: local"), HasSubstr("allowed: 1e-06"));
  EXPECT_THAT(refusal("type: membrane, strain: 2, hardening: local"), HasSubstr("allowed: 1e-06"));
  EXPECT_THAT(refusal("type: plate, as: modes, thickness: 1 mm, hardening: local"),
              HasSubstr("allowed as: network"));
  const auto without_spacing = [] {
    scene::readYaml(
        "ergotic: 1\nsections: {a: {}}\ngenerators: [{type: membrane, name: b, mass: 1, cells: 4, "
        "pitch: 100, hardening: local, strain: 0.01}]\n",
        "hard.yaml");
  };
  EXPECT_THROW(without_spacing(), TextError);
}

}  // namespace
}  // namespace ergotic::physics
