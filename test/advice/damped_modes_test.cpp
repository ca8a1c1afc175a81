// SPDX-License-Identifier: BSD-3-Clause
#include "advice/mode_scenes.hpp"

namespace ergotic::physics {
namespace {

/// Poles by the companion matrix, which knows nothing of modes.
TEST(DampedModesTest, WithLossesOfTheirOwnAreThePolesOfTheQuadraticProblem) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    SceneBuilder b;
    Nets nets(b);
    nets.random.seed(seed);
    nets.kappa = 0.3;
    nets.zeta = 0.0;
    nets.scatter = 0.5;
    const int first = nets.string(60);
    for (int i = 0; i < 3; ++i) {
      const int m = first + 1 + static_cast<int>(nets.any(0.0, 57.0));
      b.spring(m, b.ground(), 0.0, nets.any(0.02, 0.5) * 1e-3 * kRate);
    }
    const scene::Scene settled = settle(b.scene, kRates).scene;
    std::vector<std::complex<double>> poles = test::BodyPoles(settled, kRate).poles();
    const SceneModes found = modesOf(b.scene, lowest(12));
    for (const SceneMode& mode : found.modes) {
      const auto nearest = std::min_element(poles.begin(), poles.end(), [&](auto x, auto y) {
        return std::abs(test::frequencyOf(x, kRate) - mode.frequency_hz) <
               std::abs(test::frequencyOf(y, kRate) - mode.frequency_hz);
      });
      EXPECT_LT(mode.error, 1e-9) << "the whole problem is solved";
      if (mode.kind == SceneMode::Kind::kRings) {
        EXPECT_NEAR(mode.frequency_hz, test::frequencyOf(*nearest, kRate),
                    1e-8 * mode.frequency_hz);
        EXPECT_NEAR(mode.t60_s, test::t60Of(*nearest, kRate), 1e-7 * mode.t60_s) << seed;
        poles.erase(nearest);  // none is told twice
      }
    }
  }
}

/// r +- sqrt(r^2 - (delta/2)^2), r = 2 f0 Z0/R (Weinreich 1977): double decay.
TEST(DampedModesTest, OfTwoMistunedStringsOnAResistanceDecayAtTwoRates) {
  constexpr int kMasses = 200;
  const double k = 0.5e-3 * kRate * kRate;
  const double wave = std::sqrt(k * 1e-3);  // Z0
  constexpr double kResistance = 400.0;     // Z0
  SceneBuilder b;
  const int first = b.chain(kMasses, 1e-3, k);
  const int second = b.chain(kMasses, 1e-3 * (1.0 - 4e-4), k);
  const int bridge = b.mass(1e-6);
  for (scene::Lia& lia : b.scene.lias) {
    for (int* end : {&lia.a, &lia.b}) {
      *end = *end == first || *end == second ? bridge : *end;
    }
  }
  b.spring(bridge, b.ground(), 0.0, kResistance * wave);
  const double f0 = hertz(0.5 * hinged(1, kMasses));
  const double delta = 2.0 * kPi * f0 * 2e-4;
  const double r = 2.0 * f0 / kResistance;
  ASSERT_LT(delta, 2.0 * r);
  const SceneModes found = modesOf(b.scene, lowest(4));
  std::vector<double> rates;
  for (const SceneMode& mode : found.modes) {
    if (mode.kind == SceneMode::Kind::kRings && mode.frequency_hz < 1.5 * f0) {
      rates.push_back(std::log(1000.0) / mode.t60_s);
    }
  }
  ASSERT_EQ(rates.size(), 2U);
  std::sort(rates.begin(), rates.end());
  const double root = std::sqrt(r * r - 0.25 * delta * delta);
  EXPECT_NEAR(rates[0], r - root, 0.02 * (r - root));
  EXPECT_NEAR(rates[1], r + root, 0.02 * (r + root));
}

TEST(DampedModesTest, SayHowMuchOutputsAndPointsSeeOfThem) {
  constexpr int kMasses = 30;
  constexpr double kMass = 1e-3;
  SceneBuilder b;
  const int first = b.chain(kMasses, kMass, 0.5 * kMass * kRate * kRate);
  b.hear(first + 10);
  b.hear(first, 1, Quantity::kForce);
  const int grid = b.grid(first, kMasses + 2);
  b.point(grid, 0.25);
  const SceneModes found = modesOf(b.scene, lowest(kMasses));
  const double stiffness = 0.5 * kMass * kRate * kRate;
  for (int j = 1; j <= kMasses; ++j) {
    const double root = std::sqrt(2.0 / (kMass * (kMasses + 1)));
    const auto shape = [&](double place) {
      return root * std::sin(j * kPi * place / (kMasses + 1));
    };
    const SceneMode& mode = found.modes[at(j - 1)];
    EXPECT_NEAR(std::abs(mode.at_outputs[0]), std::abs(shape(10.0)), 1e-9);
    EXPECT_NEAR(std::abs(mode.at_outputs[1]), std::abs(stiffness * shape(1.0)),
                1e-9 * stiffness * root);
    const double place = 0.25 * (kMasses + 1);
    const double low = std::floor(place);
    const double between = (1.0 - (place - low)) * shape(low) + (place - low) * shape(low + 1.0);
    EXPECT_NEAR(std::abs(mode.at_points.at(0)), std::abs(between), 1e-9);
  }
}

TEST(DampedModesTest, SayHowFarBodiesAreFromWhatTheyAsked) {
  const scene::Scene scene = read(
      "ergotic: 1\nsections: {s: {}}\ngenerators:\n"
      "  - {type: bar, name: bar, section: s, masses: 24, mass: 1, pitch: A2, ratios: [3, 6]}\n"
      "  - {type: string, name: string, section: s, masses: 40, mass: 1e-5, frequency: 220,\n"
      "     from: [0, 0], to: [1, 0]}\n"
      "  - {type: resonator, name: bell, section: s, places: [rim],\n"
      "     partials: [[500, 2, 1, 1], [800, 1, 1, 1]]}\n");
  const SceneModes found = modesOf(scene, lowest(40));
  std::map<std::string, double> cents;
  for (const SceneMode& mode : found.modes) {
    if (mode.asked >= 0) {
      const AskedPitch& asked = found.asked[at(mode.asked)];
      cents[asked.body + " " + std::to_string(asked.partial)] = mode.cents;
      EXPECT_TRUE(asked.is_found);
    }
  }
  EXPECT_EQ(cents.size(), found.asked.size());
  EXPECT_EQ(cents.size(), 6U);
  for (const auto& [name, off] : cents) {
    EXPECT_NEAR(off, 0.0, 1e-4) << name;  // as near as the shape of the bar is found
  }
}

TEST(DampedModesTest, LeaveContactsOpenAndHoldSlices) {
  SceneBuilder b;
  const int m = b.mass(1e-3);
  const int hand = b.slice(0);
  b.spring(m, hand, 1e3);
  b.link(LiaType::kContact, m, b.ground(), 1e6);
  const SceneModes found = modesOf(b.scene);
  ASSERT_EQ(found.modes.size(), 1U);
  EXPECT_NEAR(found.modes[0].frequency_hz, hertz(1e3 / 1e-3 / kRate / kRate), 1e-7);
  EXPECT_TRUE(found.notes.empty());
}

TEST(DampedModesTest, TellWhatCreepsAndWhatGrows) {
  SceneBuilder b;
  b.cell(1e-3, 10.0, 1.0);  // zeta h = 0.0227, kappa 5e-6
  b.spring(b.mass(1e-3), b.ground(), 4.5e-3 * kRate * kRate);
  const SceneModes found = modesOf(b.scene);
  ASSERT_EQ(found.modes.size(), 2U);
  EXPECT_EQ(found.modes[0].kind, SceneMode::Kind::kCreeps);
  EXPECT_EQ(found.modes[0].frequency_hz, 0.0);
  // Its slow root: K/Z, to a hundredth of Z/M.
  EXPECT_NEAR(std::log(1000.0) / found.modes[0].t60_s, 10.0, 0.3);
  EXPECT_EQ(found.modes[1].kind, SceneMode::Kind::kUnstable);
  EXPECT_LT(found.modes[1].t60_s, 0.0);
}

TEST(DampedModesTest, OfSectionsOfSeveralRatesAreThoseOfEach) {
  SceneBuilder b;
  const int slow = b.mass(1e-3, 0.0, 0.0, SceneBuilder::kGestural);
  const int fast = b.mass(1e-3);
  b.spring(slow, fast, 1e3);
  const SceneModes found = modesOf(b.scene);
  ASSERT_EQ(found.modes.size(), 2U);
  EXPECT_EQ(found.notes.size(), 1U);
  for (const SceneMode& mode : found.modes) {
    const double rate = kRate / mode.rate_divisor;
    const double angle = 2.0 * std::asin(0.5 * std::sqrt(1e6) / rate);
    EXPECT_NEAR(mode.frequency_hz, angle * rate / (2.0 * kPi), 1e-7);
  }
  EXPECT_NE(found.modes[0].rate_divisor, found.modes[1].rate_divisor);
}

}  // namespace
}  // namespace ergotic::physics
