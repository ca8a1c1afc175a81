// SPDX-License-Identifier: BSD-3-Clause
// Strings and bars that ask for a pitch and decays: against closed forms, the poles of the settled
// equations, and what is heard.
#include <functional>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/settling/steps.hpp"
#include "scene/generate/bar.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::BodyPoles;
using test::cents;
using test::frequencyOf;
using test::t60Of;

/// A scene of one generator `b`. \param keys  of it, after its name
scene::Scene settledBody(const std::string& keys, double rate_hz = kRate) {
  const std::string yaml =
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n  - {name: b, to: [1, 0], " + keys +
      "}\noutputs: {o: {at: b@0.37, quantity: position, channel: 1}}\n";
  return settle(scene::readYaml(yaml, "body.yaml"), {rate_hz, 14}).scene;
}

/// Of masses and springs of 1 in a row, from one to the next of which the phase grows by t.
double chainEigenvalue(double t) {
  return 2.0 - 2.0 * std::cos(t);
}

TEST(BodyTuningTest, AStiffStringHasTheEigenvaluesOfItsClosedForm) {
  constexpr int kMasses = 24;
  const scene::Scene scene =
      settledBody("type: string, masses: 24, pitch: 261.6 Hz, inharmonicity: 3.5e-4, mass: 1e-4");
  const double unit = 1.0 / (1e-4 * kRate * kRate);
  const double kappa = scene.lias[0].stiffness.factor * unit;
  const double bending = scene.bends[0].stiffness.factor * unit;
  EXPECT_NEAR(kappa, 0.088, 5e-4);
  EXPECT_NEAR(bending, 0.0099, 5e-5);
  const std::vector<double> found = BodyPoles(scene, kRate).eigenvalues();
  ASSERT_EQ(found.size(), std::size_t{kMasses});
  for (int j = 1; j <= kMasses; ++j) {
    const double one = chainEigenvalue(j * kPi / (kMasses + 1));
    const double expected = kappa * one + bending * one * one;
    EXPECT_NEAR(found[at(j - 1)] / expected, 1.0, 1e-9) << j;
  }
}

struct StiffString {
  double hz;
  double inharmonicity;
  int masses;
  std::vector<std::pair<int, double>> most_cents;  ///< partial, by how much it may be off
};

TEST(BodyTuningTest, PartialsOfStiffStringsLieWhereTheirInharmonicityPutsThem) {
  for (const StiffString& string :
       {StiffString{65.406, 1.4e-4, 40, {{2, 0.45}, {7, 0.45}, {10, 1.6}, {12, 4.9}}},
        StiffString{65.406, 1.4e-4, 80, {{2, 0.05}, {7, 0.05}, {10, 0.18}, {12, 0.55}}},
        StiffString{261.626, 3.5e-4, 60, {{2, 0.09}, {7, 0.09}, {10, 0.32}, {12, 0.98}}}}) {
    const scene::Scene scene =
        settledBody("type: string, masses: " + std::to_string(string.masses) +
                    ", mass: 1e-4, pitch: " + number(string.hz) + ", inharmonicity: " +
                    number(string.inharmonicity) + ", t60: [[1, 8], [20, 1.5]]");
    const auto poles = BodyPoles(scene, kRate).poles();
    const auto off = [&](int j) {
      const double b = string.inharmonicity;
      return cents(frequencyOf(poles[at(j - 1)], kRate),
                   j * string.hz * std::sqrt((1.0 + b * j * j) / (1.0 + b)));
    };
    EXPECT_NEAR(off(1), 0.0, 1e-6);
    EXPECT_NEAR(off(8), 0.0, 1e-6);
    for (const auto& [partial, most] : string.most_cents) {
      EXPECT_LT(std::abs(off(partial)), most) << string.masses << " masses, partial " << partial;
    }
    EXPECT_NEAR(t60Of(poles[0], kRate), 8.0, 1e-7);
    EXPECT_NEAR(t60Of(poles[19], kRate), 1.5, 1e-7);
  }
}

/// The places where a bar of equal masses swings, lambda = kappa chainEigenvalue(t)^2: roots of the
/// equations of docs/physics/bodies.md, Bars and plates, with its lengths a and b.
std::vector<double> rootsOfBar(double a, double b, int count) {
  std::vector<double> roots;
  for (int j = 0; j < count; ++j) {
    const auto error = [&](double t) {
      const double p = std::acosh(2.0 - std::cos(t));
      return j % 2 == 0 ? std::cos(t * a) * std::cosh(p * b) - std::cos(t * b) * std::cosh(p * a)
                        : std::sin(t * a) * std::sinh(p * b) - std::sin(t * b) * std::sinh(p * a);
    };
    const double guess = (j + 1.5) * kPi / (a + b);
    double low = 0.9 * guess;
    double high = 1.1 * guess;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (error(low) * error(middle) <= 0.0 ? high : low) = middle;
    }
    roots.push_back(low);
  }
  return roots;
}

TEST(BodyTuningTest, BarsHaveThePartialsOfTheirClosedForms) {
  for (const bool is_free : {true, false}) {
    for (const int masses : {12, 24, 48}) {
      const scene::Scene scene =
          settledBody("type: bar, ends: " + std::string(is_free ? "free" : "clamped") +
                      ", masses: " + std::to_string(masses) + ", mass: 0.3, pitch: 20");
      std::vector<double> found = BodyPoles(scene, kRate).eigenvalues();
      found.erase(found.begin(), found.begin() + (is_free ? 2 : 0));
      const double a = 0.5 * (masses + (is_free ? -1 : 1));
      const std::vector<double> roots = rootsOfBar(a, a + 1.0, 4);
      for (std::size_t j = 1; j < roots.size(); ++j) {
        EXPECT_NEAR(std::sqrt(found[j] / found[0]) /
                        (chainEigenvalue(roots[j]) / chainEigenvalue(roots[0])),
                    1.0, 1e-9)
            << (is_free ? "free " : "clamped ") << masses << ", " << j;
      }
    }
  }
}

TEST(BodyTuningTest, TunedBarsHaveTheRatiosThatWereAskedFor) {
  for (const auto& [ratios, masses, next] :
       {std::tuple{"[4, 10]", 12, 17.4}, std::tuple{"[4, 10]", 48, 18.13},
        std::tuple{"[3, 6]", 12, 9.68}, std::tuple{"[3, 6]", 48, 9.94}}) {
    const scene::Scene scene = settledBody("type: bar, masses: " + std::to_string(masses) +
                                           ", mass: 0.3, pitch: 12, t60: 60, ratios: " + ratios);
    const auto poles = BodyPoles(scene, kRate).poles();
    const double one = frequencyOf(poles[0], kRate);
    EXPECT_NEAR(cents(one, 12.0), 0.0, 1e-3) << ratios << masses;
    const double second = ratios[1] == '4' ? 4.0 : 3.0;
    const double third = ratios[1] == '4' ? 10.0 : 6.0;
    EXPECT_NEAR(cents(frequencyOf(poles[1], kRate), second * one), 0.0, 0.01) << ratios << masses;
    EXPECT_NEAR(cents(frequencyOf(poles[2], kRate), third * one), 0.0, 0.01) << ratios << masses;
    EXPECT_NEAR(frequencyOf(poles[3], kRate) / one, next, 0.005 * next) << ratios << masses;
    double mass = 0.0;
    for (const scene::Mat& mat : scene.mats) {
      mass += mat.mass.factor;
    }
    EXPECT_NEAR(mass, 0.3, 1e-12);
  }
}

struct Played {
  double hz = 0.0;
  double t60_s = 0.0;
};

/// Let go in the shape of its mode `index` (rigid motions are modes, too) and heard six times a
/// period.
Played play(scene::Scene scene, int index, double guess_hz, double rate_hz, Precision precision) {
  const BodyPoles body(scene, rate_hz);
  const Eigen::VectorXd shape = body.shape(scene, index);
  for (std::size_t i = 0; i < body.mats.size(); ++i) {
    scene.mats[at(body.mats[i])].position.x() += 1e-4 * shape(static_cast<Eigen::Index>(i));
  }
  const auto every = std::max(1L, std::lround(rate_hz / (6.0 * guess_hz)));
  Player player(scene, {rate_hz, 14}, precision);
  player.ticks(static_cast<int>(30.0 / guess_hz * rate_hz / 14.0) + 10);
  std::vector<double> steps;
  for (std::size_t n = 0; n < player.heard[0].size(); n += static_cast<std::size_t>(every)) {
    steps.push_back(player.heard[0][n]);
  }
  const std::complex<double> pole = std::pow(test::poleOf(steps), 1.0 / static_cast<double>(every));
  return {frequencyOf(pole, rate_hz), t60Of(pole, rate_hz)};
}

TEST(BodyTuningTest, StringsAndBarsSoundAndDecayAsAskedFromA0ToC8) {
  for (const double rate_hz : {44100.0, 48000.0, 96000.0}) {
    for (const double hz : {27.5, 110.0, 440.0, 1760.0, 4186.0}) {
      // The most masses that have room there, see docs/physics/bodies.md.
      const int bar = std::min(30, static_cast<int>(std::sqrt(5.0 / std::sin(kPi * hz / rate_hz))));
      const int hinged =
          std::min(30, static_cast<int>(std::sqrt(2.4 / std::sin(kPi * hz / rate_hz))) - 1);
      const int string = std::min(40, static_cast<int>(rate_hz / (4.0 * hz)) + 1);
      const std::string asked = ", mass: 1e-3, pitch: " + number(hz);
      const double high = 0.5 + 20.0 / hz;
      struct Body {
        std::string keys;
        int index;
      };
      for (const Body& body :
           {Body{"type: string, masses: " + std::to_string(string) + asked, 0},
            Body{"type: string, inharmonicity: 1e-4, masses: " + std::to_string(string) + asked, 0},
            Body{"type: bar, masses: " + std::to_string(bar) + asked, 2},
            Body{"type: bar, ends: hinged, masses: " + std::to_string(std::max(hinged, 4)) + asked,
                 0}}) {
        if (hinged < 4 && body.keys.find("hinged") != std::string::npos) {
          continue;
        }
        const scene::Scene scene = settledBody(body.keys + ", t60: " + number(high), rate_hz);
        EXPECT_NE(certify(scene, {rate_hz, 14}).verdict, Verdict::kUnstable)
            << body.keys << " at " << rate_hz;
        for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
          const Played played = play(scene, body.index, hz, rate_hz, precision);
          const double most = precision == Precision::kDouble ? 0.01 : 0.5;
          EXPECT_NEAR(cents(played.hz, hz), 0.0, most) << body.keys << " at " << rate_hz;
          EXPECT_NEAR(played.t60_s / high, 1.0, 0.02) << body.keys << " at " << rate_hz;
        }
      }
    }
  }
}

TEST(BodyTuningTest, ABarDecaysAsAskedAtTwoPartials) {
  const scene::Scene scene =
      settledBody("type: bar, masses: 20, mass: 0.2, pitch: 110, t60: [[1, 3], [3, 1]]");
  const auto poles = BodyPoles(scene, kRate).poles();
  // A drag on its turning, which is below what swings, comes with the dampers between neighbours.
  const auto near = [&](double hz) {
    return *std::min_element(poles.begin(), poles.end(), [&](const auto& a, const auto& b) {
      return std::abs(frequencyOf(a, kRate) - hz) < std::abs(frequencyOf(b, kRate) - hz);
    });
  };
  EXPECT_NEAR(cents(frequencyOf(near(110.0), kRate), 110.0), 0.0, 0.05);
  EXPECT_NEAR(t60Of(near(110.0), kRate), 3.0, 3.0 * 0.02);
  EXPECT_NEAR(t60Of(near(5.37 * 110.0), kRate), 1.0, 0.02);
}

std::string refusal(const std::string& keys) {
  try {
    settledBody(keys);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(BodyTuningTest, WhatCannotBeIsRefusedWithPlaceAndRange) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal("type: bar, masses: 8, mass: 1, pitch: 23000"),
              HasSubstr("body.yaml:4:12: error: body 'b' cannot sound at 23000 Hz, allowed below "
                        "half its rate, 22050 Hz"));
  EXPECT_THAT(refusal("type: bar, masses: 8, mass: 1, pitch: 100, t60: [[1, 1], [2, 2]]"),
              HasSubstr("cannot decay in 1 s at partial 1 and 2 s at partial 2, allowed there: "));
  EXPECT_THAT(refusal("type: bar, masses: 8, mass: 1, pitch: 100, t60: [[1, 10], [2, 1]]"),
              HasSubstr("allowed there: "));
  EXPECT_THAT(refusal("type: bar, masses: 8, mass: 1, pitch: 100, t60: [[1, 10], [9, 1]]"),
              HasSubstr("has 6 partials, but partial 9 is asked for, allowed: 1...6"));
  EXPECT_THAT(refusal("type: bar, masses: 8, mass: 1, pitch: 100, ratios: [9, 10]"),
              HasSubstr("none was found that has its 'ratios'"));
}

TEST(BodyTuningTest, SaysHowFewMassesCouldBeStepped) {
  const std::string yaml =
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n  - {type: bar, name: b, masses: 24, mass: 1, "
      "pitch: 400, "
      "to: [1, 0]}\n";
  const Settled settled = settle(scene::readYaml(yaml, "body.yaml"), {kRate, 14});
  const std::vector<std::string> findings = certify(settled.scene, {kRate, 14}).findings;
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_THAT(findings[0], ::testing::HasSubstr("cannot be stepped at 44100 Hz"));
  EXPECT_THAT(findings[0], ::testing::HasSubstr("times as many masses in a row"));
}

}  // namespace
}  // namespace ergotic::physics
