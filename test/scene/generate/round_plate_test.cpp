// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/round_plate.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

/// Leissa, NASA SP-160 (clamped), and Leissa and Narita, Journal of Sound and Vibration 70, 1980:
/// (k a)^2, the vibrations with diameters once.
TEST(RoundPlateTest, FrequenciesAreThoseOfThePublishedTables) {
  struct Row {
    PlateEdges edges;
    std::vector<std::pair<int, double>> modes;  // nodal diameters, k^2
  };
  const Row rows[] = {
      {PlateEdges::kClamped,
       {{0, 10.2158}, {1, 21.260}, {2, 34.877}, {0, 39.771}, {3, 51.030}, {1, 60.829}}},
      {PlateEdges::kSupported,
       {{0, 4.93515}, {1, 13.8982}, {2, 25.6133}, {0, 29.7200}, {3, 39.9573}, {1, 48.4789}}},
      {PlateEdges::kFree,
       {{2, 5.35833}, {0, 9.00314}, {3, 12.4390}, {1, 20.4746}, {4, 21.8352}, {5, 33.4949}}},
  };
  for (const Row& row : rows) {
    std::vector<RoundMode> modes = roundModes(row.edges, 0.3, 12);
    modes.erase(std::remove_if(modes.begin(), modes.end(),
                               [](const RoundMode& mode) { return mode.is_sine; }),
                modes.end());
    for (std::size_t i = 0; i < row.modes.size(); ++i) {
      EXPECT_EQ(modes[i].diameters, row.modes[i].first) << i;
      EXPECT_NEAR(modes[i].k * modes[i].k / row.modes[i].second, 1.0, 3e-5) << i;
    }
  }
}

TEST(RoundPlateTest, AllFortyPartialsAreThereInOrderAndInPairs) {
  for (const double poisson : {0.0, 0.3, 0.5}) {
    for (const PlateEdges edges :
         {PlateEdges::kClamped, PlateEdges::kSupported, PlateEdges::kFree}) {
      const std::vector<RoundMode> modes = roundModes(edges, poisson, kMaxPartials);
      ASSERT_EQ(modes.size(), std::size_t{kMaxPartials});
      for (std::size_t i = 1; i < modes.size(); ++i) {
        EXPECT_GE(modes[i].k, modes[i - 1].k);
        EXPECT_EQ(modes[i].is_sine, modes[i].diameters > 0 && modes[i].k == modes[i - 1].k);
      }
      // Weyl: k^2/4 vibrations below k, and of order k beside these.
      const double k = modes.back().k;
      EXPECT_NEAR(kMaxPartials, 0.25 * k * k, k);
    }
  }
}

/// By the midpoint rule over rings and spokes.
TEST(RoundPlateTest, ShapesAreOrthonormalOverThePlate) {
  constexpr int kRings = 400;
  constexpr int kSpokes = 32;
  for (const PlateEdges edges : {PlateEdges::kClamped, PlateEdges::kSupported, PlateEdges::kFree}) {
    const std::vector<RoundMode> modes = roundModes(edges, 0.3, 8);
    for (const RoundMode& a : modes) {
      for (const RoundMode& b : modes) {
        double sum = 0.0;
        for (int ring = 0; ring < kRings; ++ring) {
          const double r = (ring + 0.5) / kRings;
          for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double phi = 2.0 * M_PI * (spoke + 0.5) / kSpokes;
            sum += 2.0 * r / kRings / kSpokes * a.shapeAt(r, phi) * b.shapeAt(r, phi);
          }
        }
        EXPECT_NEAR(sum, &a == &b ? 1.0 : 0.0, 3e-5);
      }
    }
  }
}

/// A held edge does not move, nor turn if it is clamped.
TEST(RoundPlateTest, EdgesAreHeldAsTold) {
  constexpr double kStep = 1e-5;
  for (const PlateEdges edges : {PlateEdges::kClamped, PlateEdges::kSupported}) {
    for (const RoundMode& mode : roundModes(edges, 0.3, 10)) {
      const double phi = mode.is_sine ? 0.5 * M_PI / mode.diameters : 0.0;
      EXPECT_NEAR(mode.shapeAt(1.0, phi), 0.0, 1e-11);
      const double slope = mode.shapeAt(1.0 - kStep, phi) / kStep;
      if (edges == PlateEdges::kClamped) {
        EXPECT_NEAR(slope, 0.0, 0.5 * kStep * mode.k * mode.k * 4.0);
      } else {
        EXPECT_GT(std::abs(slope), 1.0);
      }
    }
  }
}

std::string sceneOf(const std::string& keys) {
  return "ergotic: 1\nsections: {a: {rate: audio}}\ngenerators:\n"
         "  - {type: plate, name: disc, section: a, mass: 2 kg, pitch: 220 Hz, " +
         keys + "}\n";
}

/// In the middle only vibrations without a diameter are felt; a place that moves by w feels of a
/// partial mass/w^2.
TEST(RoundPlateTest, IsABodyOfModesWithPlaces) {
  const Scene scene =
      readYaml(sceneOf("shape: round, as: modes, partials: 9, t60: 2 s, pitch_of: 3, "
                       "places: {middle: [0.5, 0.5], rim: [1, 0.5]}"),
               "disc.yaml");
  const std::vector<RoundMode> modes = roundModes(PlateEdges::kFree, 0.3, 9);
  ASSERT_EQ(scene.taps.size(), 2U);
  EXPECT_EQ(scene.taps[0].shares.size(), 1U);  // (0, 1)
  for (const Tap::Share& share : scene.taps[1].shares) {
    EXPECT_NEAR(share.weight, modes[static_cast<std::size_t>(share.mat)].shapeAt(1.0, 0.0), 1e-12);
  }
  for (std::size_t j = 0; j < modes.size(); ++j) {
    const Mat& cell = scene.mats[j];
    EXPECT_EQ(cell.mass.factor, 2.0);
    const double sigma = cell.damping.factor / (2.0 * 2.0);
    const double hz = std::sqrt(cell.stiffness.factor / 2.0 - sigma * sigma) / (2.0 * M_PI);
    EXPECT_NEAR(hz, 220.0 * std::pow(modes[j].k / modes[2].k, 2), 1e-9 * hz);
  }
}

TEST(RoundPlateTest, SaysWhatItCannotBe) {
  const auto refusal = [](const std::string& keys) {
    return complaintOf<TextError>([&] { readYaml(sceneOf(keys), "disc.yaml"); });
  };
  EXPECT_THAT(refusal("shape: round, cells: 10"), HasSubstr("is round, and a network, allowed with "
                                                            "as: modes"));
  EXPECT_THAT(refusal("shape: round, as: modes, cells: 10"), HasSubstr("'cells'"));
  EXPECT_THAT(refusal("shape: round, as: modes, places: {p: [0.9, 0.9]}"),
              HasSubstr("place 'p' of round plate 'disc' is 1.13"));
  EXPECT_THAT(refusal("shape: round, as: modes, edges: clamped, poisson: 0.2"),
              HasSubstr("it changes nothing, allowed with edges: free or supported"));
  EXPECT_THAT(refusal("shape: round, as: modes, partials: 6, t60: [[1, 4 s], [2, 2 s]]"),
              HasSubstr("names partials 1 and 2, which both sound at 220 Hz"));
  EXPECT_THAT(refusal("cells: 8, radius: 0.1"), HasSubstr("'radius'"));
}

}  // namespace
}  // namespace ergotic::scene
