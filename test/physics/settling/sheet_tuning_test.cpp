// SPDX-License-Identifier: BSD-3-Clause
// Membranes and plates that ask for a pitch: against closed forms and tables.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::BodyPoles;
using test::cents;

scene::Scene settledSheet(const std::string& keys) {
  const std::string yaml =
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n  - {name: b, mass: 0.5, " + keys + "}\n";
  return settle(scene::readYaml(yaml, "sheet.yaml"), {kRate, 14}).scene;
}

/// w h of the modes, by frequency, without the rigid motions.
std::vector<double> frequencies(const std::string& keys, int rigid = 0) {
  std::vector<double> all;
  for (const double lambda : BodyPoles(settledSheet(keys), kRate).eigenvalues()) {
    all.push_back(std::sqrt(std::max(0.0, lambda)));
  }
  all.erase(all.begin(), all.begin() + rigid);
  return all;
}

/// 2 - 2 cos of the j-th of `masses` between hinges.
double hinged(int j, int masses) {
  return 2.0 - 2.0 * std::cos(j * kPi / (masses + 1));
}

/// Square roots of all values of a form over the modes (j, k) of columns and rows, by size.
template <class Form>
std::vector<double> formOver(int columns, int rows, const Form& form) {
  std::vector<double> all;
  for (int j = 1; j <= columns; ++j) {
    for (int k = 1; k <= rows; ++k) {
      all.push_back(std::sqrt(form(hinged(j, columns), hinged(k, rows))));
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

void expectAlike(const std::vector<double>& found, const std::vector<double>& form) {
  ASSERT_EQ(found.size(), form.size());
  for (std::size_t j = 0; j < form.size(); ++j) {
    EXPECT_NEAR(found[j] / found[0] / (form[j] / form[0]), 1.0, 1e-9) << j;
  }
  // The first one sounds at the pitch: 2 asin(w h/2).
  EXPECT_NEAR(cents(std::asin(0.5 * found[0]) / kPi * kRate, 100.0), 0.0, 1e-7);
}

TEST(SheetTuningTest, RectangularMembranesHaveTheModesOfTheirClosedForm) {
  expectAlike(frequencies("type: membrane, cells: [11, 7], neighbours: 4, pitch: 100"),
              formOver(11, 7, [](double x, double y) { return x + y; }));
  expectAlike(
      frequencies("type: membrane, cells: [11, 7], pitch: 100"),
      formOver(11, 7, [](double x, double y) { return x + y + 0.25 * (2 * x + 2 * y - x * y); }));
}

TEST(SheetTuningTest, SupportedPlatesHaveTheModesOfTheirClosedForm) {
  expectAlike(frequencies("type: plate, edges: supported, cells: [10, 8], pitch: 100"),
              formOver(10, 8, [](double x, double y) { return (x + y) * (x + y); }));
}

/// Ratios to the first, each within so many cents.
void expectRatios(const std::vector<double>& found,
                  const std::vector<double>& ratios,
                  double within) {
  for (std::size_t j = 0; j < ratios.size(); ++j) {
    EXPECT_NEAR(cents(found[j] / found[0], ratios[j]), 0.0, within) << j;
  }
}

TEST(SheetTuningTest, RoundMembranesComeNearTheZerosOfBesselFunctions) {
  // j_mn/j_01: (01), (11) twice, (21) twice, (02), (31) twice, (12) twice.
  const std::vector<double> ideal{1.0,    1.5933, 1.5933, 2.1355, 2.1355,
                                  2.2954, 2.6531, 2.6531, 2.9173, 2.9173};
  expectRatios(frequencies("type: membrane, shape: round, cells: 6, pitch: 100"), ideal, 90.0);
  expectRatios(frequencies("type: membrane, shape: round, cells: 12, pitch: 100"), ideal, 23.0);
  expectRatios(frequencies("type: membrane, shape: round, cells: 20, pitch: 100"), ideal, 9.0);
}

TEST(SheetTuningTest, PairsOfModesOfRoundMembranesStayPairsWhereTheGridAllowsIt) {
  const std::vector<double> found =
      frequencies("type: membrane, shape: round, cells: 9, pitch: 100");
  EXPECT_NEAR(found[2] / found[1], 1.0, 1e-9);       // (11)
  EXPECT_NEAR(cents(found[4], found[3]), 0.0, 8.0);  // (21): along the grid and across it
}

TEST(SheetTuningTest, AKettledrumHasAnAlmostHarmonicSeries) {
  // (11), (21), (31), (41) as 1 : 1.5 : 1.98 : 2.44; (01), (02) ... lie between.
  const std::vector<double> found = frequencies(
      "type: membrane, shape: round, cells: 16, pitch: 147, pitch_of: 2, "
      "load: {ratio: 6.018, power: 10.52}");
  const double one = found[1];
  EXPECT_NEAR(cents(std::asin(0.5 * one) / kPi * kRate, 147.0), 0.0, 1e-7);
  for (const double ratio : {1.4986, 1.9823, 2.4388}) {
    const double nearest = *std::min_element(found.begin(), found.end(), [&](double a, double b) {
      return std::abs(a / one - ratio) < std::abs(b / one - ratio);
    });
    EXPECT_NEAR(cents(nearest / one, ratio), 0.0, 25.0) << ratio;
  }
}

TEST(SheetTuningTest, FreePlatesComeNearTheConvergedValues) {
  const std::vector<double> converged{13.468, 19.596, 24.270, 34.801, 34.801, 61.09};
  std::vector<double> ratios;
  for (const double value : converged) {
    ratios.push_back(value / converged.front());
  }
  expectRatios(frequencies("type: plate, cells: 12, pitch: 100", 3), ratios, 30.0);
  expectRatios(frequencies("type: plate, cells: 20, pitch: 60", 3), ratios, 10.0);
}

TEST(SheetTuningTest, ClampedPlatesAreALittleLow) {
  // 35.99 : 73.41 : 73.41 : 108.27 : 131.64 (Leissa 1969), the grid of 23 31 cents low at most.
  const std::vector<double> found =
      frequencies("type: plate, edges: clamped, cells: 23, pitch: 40");
  expectRatios(found, {1.0, 73.41 / 35.99, 73.41 / 35.99, 108.27 / 35.99, 131.64 / 35.99}, 32.0);
}

TEST(SheetTuningTest, SheetsDecayAsAskedAndAreCertified) {
  for (const std::string keys :
       {"type: membrane, cells: 8, pitch: 200, t60: [[1, 2], [6, 1.2]]",
        "type: membrane, shape: round, cells: 5, pitch: 200, t60: [[1, 2], [6, 1.2]]",
        "type: plate, edges: clamped, cells: 7, pitch: 150, t60: [[1, 2], [6, 1.2]]",
        "type: plate, cells: 8, pitch: 150, t60: [[1, 2], [6, 1.2]]"}) {
    const scene::Scene scene = settledSheet(keys);
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict, Verdict::kPassive) << keys;
    const BodyPoles body(scene, kRate);
    const std::vector<double> lambda = body.eigenvalues();
    const std::size_t rigid =
        keys.find("edges: clamped") == std::string::npos && keys.find("plate") != std::string::npos
            ? 3
            : 0;
    const auto poles = body.poles();
    for (const auto& [partial, seconds] : {std::pair{0, 2.0}, std::pair{5, 1.2}}) {
      const double hz = std::asin(0.5 * std::sqrt(lambda[rigid + at(partial)])) / kPi * kRate;
      const auto nearest =
          *std::min_element(poles.begin(), poles.end(), [&](const auto& a, const auto& b) {
            return std::abs(test::frequencyOf(a, kRate) - hz) <
                   std::abs(test::frequencyOf(b, kRate) - hz);
          });
      EXPECT_NEAR(test::t60Of(nearest, kRate) / seconds, 1.0, 0.02) << keys << partial;
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
