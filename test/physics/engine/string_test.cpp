// SPDX-License-Identifier: BSD-3-Clause
// Strings sound where closed forms say, cut coarsely or finely, in every geometry, stretched or
// not.

#include <complex>

#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::cents;
using test::partialNear;

constexpr double kPitch = 110.0;
constexpr double kMass = 1e-4;

/// Of `masses` masses with h^2 K/M = kappa between fixed ends.
double closedFormHz(int masses, double kappa, int partial = 1) {
  const double s = std::sin(kPi * partial / (2.0 * (masses + 1)));
  return std::asin(std::sqrt(kappa) * s) / kPi * kRate;
}

/// The springs of an ideal string of 110 Hz, cut into N masses.
double kappaOf(int masses) {
  return std::pow(2.0 * kPitch * (masses + 1) / kRate, 2.0);
}

/// What is heard near one end of a string that was pulled near the other.
std::vector<double> pluckedString(int masses) {
  SceneBuilder b;
  const int first = b.chain(masses, kMass, kappaOf(masses) * kMass * kRate * kRate);
  const double pulled = 0.13 * (masses + 1);
  for (int i = 1; i <= masses; ++i) {
    b.scene.mats[at(first + i)].position.x() =
        1e-3 * (i < pulled ? i / pulled : (masses + 1 - i) / (masses + 1 - pulled));
  }
  b.hear(first + masses - masses / 20);
  Player player(b.scene, {kRate, 14});
  player.ticks(1600);
  return player.heard[0];
}

TEST(StringTest, PartialsSoundAtTheFrequenciesOfTheClosedFormNearerTheIdealWithMoreMasses) {
  struct Row {
    int masses;
    double cents[3];  // of partials 1, 5, 10 from the ideal string
    double tolerance;
  };
  for (const Row& row : {Row{20, {-1.6, -40.0, -163.0}, 0.5}, Row{50, {-0.26, -6.41, -25.74}, 0.05},
                         Row{80, {-0.1, -2.3, -9.1}, 0.05}, Row{160, {0.0, -0.24, -1.0}, 0.05},
                         Row{199, {0.0, 0.0, -0.01}, 0.01}}) {
    const std::vector<double> sound = pluckedString(row.masses);
    for (int partial = 1; partial <= 10; ++partial) {
      const double expected = closedFormHz(row.masses, kappaOf(row.masses), partial);
      const double heard = partialNear(sound, expected, kRate);
      EXPECT_LT(std::abs(cents(heard, expected)), 0.01) << row.masses << ", partial " << partial;
      if (partial % 5 == 0 || partial == 1) {
        EXPECT_NEAR(cents(heard, kPitch * partial), row.cents[partial / 5], row.tolerance)
            << row.masses << ", partial " << partial;
      }
    }
  }
}

struct Stretched {
  Geometry geometry = Geometry::kSpace;
  double ratio = 0.0;      ///< rest length over length of a link
  double amplitude = 0.0;  ///< over the length of the string
};
constexpr int kStretchedMasses = 39;
constexpr double kStretchedKappa = 0.5;

/// A string of 1 m along x in the shape of its first mode across, heard in its middle.
std::vector<double> playStretched(const Stretched& string, int ticks) {
  SceneBuilder b;
  const bool scalar = string.geometry == Geometry::kScalar;
  b.scene.sections[0].geometry = string.geometry;
  constexpr int kLinks = kStretchedMasses + 1;
  const int first = b.chain(kStretchedMasses, kMass, kStretchedKappa * kMass * kRate * kRate);
  const int across = scalar ? 0 : 2;
  for (int i = 0; i <= kLinks; ++i) {
    scene::Mat& mat = b.scene.mats[at(first + i)];
    mat.rest.x() = scalar ? 0.0 : static_cast<double>(i) / kLinks;
    mat.position = mat.rest;
    mat.position[across] += string.amplitude * std::sin(kPi * i / kLinks);
  }
  for (Lia& lia : b.scene.lias) {
    lia.rest_length = string.ratio / kLinks;
  }
  b.hear(first + kLinks / 2);
  b.scene.outputs[0].axis = across;
  Player player(b.scene, {kRate, 14});
  player.ticks(ticks);
  return player.heard[0];
}

TEST(StringTest, WithoutRestLengthInSpaceIsTheScalarOneAtAnyAmplitude) {
  const auto space = playStretched({Geometry::kSpace, 0.0, 0.5}, 300);
  const auto scalar = playStretched({Geometry::kScalar, 0.0, 0.5}, 300);
  for (std::size_t n = 0; n < scalar.size(); ++n) {
    ASSERT_NEAR(space[n], scalar[n], 1e-13) << n;
  }
}

/// Small motion across is held by the tension alone: kappa (1 - r).
TEST(StringTest, OfRestLengthSwingsAcrossAsAScalarOneOfItsTension) {
  const double angle = std::arg(test::poleOf(playStretched({Geometry::kSpace, 0.9, 1e-7}, 300)));
  const double expected = closedFormHz(kStretchedMasses, 0.1 * kStretchedKappa);
  EXPECT_NEAR(angle / (2.0 * kPi) * kRate / expected, 1.0, 1e-7);
}

TEST(StringTest, PitchRisesWithTheAmplitudeAsThePullFormulaSays) {
  const auto pull = [](double r) {
    const double still = closedFormHz(kStretchedMasses, (1.0 - r) * kStretchedKappa);
    return cents(partialNear(playStretched({Geometry::kSpace, r, 0.01}, 1600), still, kRate),
                 still);
  };
  for (const double r : {0.9, 0.99}) {
    EXPECT_NEAR(pull(r) / (1602.0 * r / (1.0 - r) * 1e-4), 1.0, 0.05) << r;
  }
  EXPECT_LT(std::abs(pull(0.0)), 1e-6);
}

/// The pitch of the scene's string, let go in the shape of its first mode: when one mode moves
/// alone, x[n+1] = p x[n] - q x[n-1] for every mass and frame.
double playedPitchHz(scene::Scene scene, const Rates& rates) {
  const scene::StringInfo& string = scene.strings[0];
  const int axis = scene.outputs[0].axis;
  for (int i = 0; i < string.count; ++i) {
    scene.mats[at(string.first + i)].position[axis] +=
        1e-5 * std::sin(kPi * i / (string.count - 1));
  }
  Player player(scene, rates);
  player.tick();
  std::vector<double> x = player.heard[0];
  for (double& position : x) {
    position -= scene.mats[at(scene.outputs[0].point.mat)].rest[axis];
  }
  const double determinant = x[2] * x[2] - x[1] * x[3];
  const double p = (x[2] * x[3] - x[1] * x[4]) / determinant;
  const double q = (x[3] * x[3] - x[2] * x[4]) / determinant;
  return std::acos(p / (2.0 * std::sqrt(q))) / (2.0 * kPi) * rates.audio_hz;
}

TEST(StringTest, PitchThatIsToldIsWhatTheInstrumentPlaysInEveryGeometry) {
  constexpr struct {
    const char* section;
    const char* fields;
    const char* to;
    const char* axis;
  } kCases[] = {
      {"", "frequency: 880, damping: 1e-3, loss: 1e-2", "[1, 0]", "x"},
      {"medium: 0.02", "frequency: 880", "[1, 0]", "x"},
      {"medium: 0.02", "frequency: 880, loss: 0.01", "[1, 0]", "x"},
      {"", "frequency: 880, coarse: true, damping: 1e-3", "[1, 0]", "x"},
      {"geometry: line", "frequency: 880, rest_length_ratio: 0.7, damping: 1e-3", "[1]", "x"},
      {"geometry: plane", "frequency: 880, damping: 1e-3", "[1, 0]", "y"},
      {"geometry: plane", "frequency: 880, rest_length_ratio: 0.7, loss: 0.01", "[1, 0]", "y"},
      {"geometry: plane, medium: 0.02", "stiffness: 1e4, rest_length_ratio: 0.5", "[1, 0]", "y"},
      {"geometry: space", "frequency: 880, rest_length_ratio: 0.7", "[1, 0, 0]", "z"},
      {"geometry: plane", "frequency: 870, rest_length_ratio: 0.35, scheme: energy_stable",
       "[1, 0]", "y"},
  };
  for (const auto& each : kCases) {
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

/// Across, the tension alone holds them, and that is not energy-stable.
TEST(StringTest, EnergyStableStringsAreInTune) {
  const Rates rates;
  for (const char* frequency : {"165", "440", "870"}) {
    const Settled settled =
        settle(scene::readYaml(
                   "ergotic: 1\nsections: {a: {geometry: plane}}\ngenerators: [{type: string, "
                   "name: s, masses: 20, mass: 1e-4, scheme: energy_stable, to: [0.65, 0], "
                   "rest_length_ratio: 0.9, frequency: " +
                       std::string(frequency) +
                       "}]\noutputs: {o: {at: s.10, quantity: position, channel: 1, axis: y}}\n",
                   "string.yaml"),
               rates);
    const double foretold = stringPitchHz(settled.scene, settled.scene.strings[0], rates.audio_hz);
    const double played = playedPitchHz(settled.scene, rates);
    EXPECT_NEAR(played, foretold, 1e-6 * foretold) << frequency;
  }
}

struct Chain {
  int masses = 1;
  double kappa = 0.6;  ///< of a link, h^2 K/M
  double zeta = 0.0;   ///< of a link, h Z/M

  double eigenvalue(int mode) const {
    const double s = std::sin(kPi * mode / (2.0 * (masses + 1)));
    return 4.0 * s * s;
  }
  /// lambda^2 - (2 - kappa_j - zeta_j) lambda + (1 - zeta_j) = 0
  std::complex<double> expectedPole(int mode) const {
    const double kj = kappa * eigenvalue(mode);
    const double zj = zeta * eigenvalue(mode);
    const double b = 2.0 - kj - zj;
    return (b + std::sqrt(std::complex<double>(b * b - 4.0 * (1.0 - zj)))) / 2.0;
  }
};

/// The chain is let go in the shape of a mode; heard where that moves most.
std::complex<double> playedPole(const Chain& chain, int mode) {
  SceneBuilder b;
  const double m = 1e-4;
  const int first =
      b.chain(chain.masses, m, chain.kappa * m * kRate * kRate, chain.zeta * m * kRate);
  int loudest = 1;
  for (int i = 1; i <= chain.masses; ++i) {
    const double shape = std::sin(kPi * mode * i / (chain.masses + 1));
    b.scene.mats[at(first + i)].position.x() = shape;
    const double most = std::sin(kPi * mode * loudest / (chain.masses + 1));
    loudest = std::abs(shape) > std::abs(most) ? i : loudest;
  }
  b.hear(first + loudest);
  Player player(b.scene, {kRate, 14});
  player.ticks(60);
  return test::poleOf(player.heard[0]);
}

TEST(ChainModesTest, EveryModeTurnsByTheAngleOfTheExplicitScheme) {
  for (const int masses : {1, 3, 10, 50}) {
    for (int mode = 1; mode <= masses; ++mode) {
      const Chain chain{masses, 0.9, 0.0};
      const std::complex<double> pole = playedPole(chain, mode);
      const double omega = 2.0 * std::asin(std::sqrt(0.9 * chain.eigenvalue(mode)) / 2.0);
      EXPECT_NEAR(std::arg(pole), omega, 1e-9) << masses << " masses, mode " << mode;
      EXPECT_NEAR(std::abs(pole), 1.0, 1e-9) << masses << " masses, mode " << mode;
    }
  }
}

TEST(ChainModesTest, EveryDampedModeHasThePoleOfTheExplicitScheme) {
  for (const int masses : {1, 3, 10, 50}) {
    for (int mode = 1; mode <= masses; ++mode) {
      const Chain chain{masses, 0.6, 0.02};
      const std::complex<double> error = playedPole(chain, mode) - chain.expectedPole(mode);
      EXPECT_LT(std::abs(error), 1e-9) << masses << " masses, mode " << mode;
    }
  }
}

TEST(ChainModesTest, HighestModeAlternatesAtTheStabilityLimit) {
  // One mass between two springs: kappa = 2 per spring would be 4 in all.
  const std::complex<double> pole = playedPole({1, 1.98, 0.0}, 1);
  EXPECT_NEAR(std::arg(pole), 2.0 * std::asin(std::sqrt(0.99)), 1e-9);
}

TEST(ChainModesTest, BeyondTheStabilityLimitItGrows) {
  SceneBuilder b;
  const int first = b.chain(1, 1.0, 2.02 * kRate * kRate);
  b.scene.mats[at(first + 1)].position.x() = 1e-3;
  b.hear(first + 1);
  Player player(b.scene, {kRate, 14});
  player.ticks(10);
  EXPECT_GT(std::abs(player.heard[0].back()), 1e6);
}

}  // namespace
}  // namespace ergotic::physics
