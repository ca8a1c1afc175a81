// SPDX-License-Identifier: BSD-3-Clause
// Frets, barriers and bridges: pitches and decays against closed forms.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/generate/cut_string.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/settling/steps.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

scene::Scene sceneOf(const std::string& text) {
  return scene::readYaml("ergotic: 1\nsections: {a: {}}\n" + text, "stops.yaml");
}

/// A string of 98 Hz that something presses down behind fret k: what it sounds like.
std::vector<double> frettedSound(const std::string& string, int k, bool is_from_last) {
  constexpr double kAtNut = 5e-4;
  constexpr double kAtBridge = 5e-3;
  const auto along = [&](double sounding) {
    return number(is_from_last ? sounding : 1.0 - sounding);
  };
  const double behind = 0.5 * (std::exp2(-k / 12.0) + std::exp2(-(k - 1) / 12.0));
  const double fret = kAtNut + (1.0 - std::exp2(-k / 12.0)) * (kAtBridge - kAtNut);
  const scene::Scene scene =
      sceneOf("mats: {finger: {type: ground, x: " + number(-fret - 3e-4) +
              "}}\ngenerators:\n  - {type: string, name: s, masses: 120, to: [0.65, 0], " + string +
              "}\n  - {type: frets, name: f, along: s, count: 20, height: [" + number(kAtNut) +
              ", " + number(kAtBridge) + "], nut: " + (is_from_last ? "last" : "first") +
              "}\nlias: {press: {type: contact, between: ['s@" + along(behind) +
              "', finger], stiffness: 2e4, damping: 0.5}}\noutputs: {o: {at: 's@" +
              along(0.13 * std::exp2(-k / 12.0)) + "', quantity: velocity, channel: 1}}\n");
  Player player(scene, kRates);
  player.ticks(6300);  // 2 s
  return {player.heard[0].end() - static_cast<std::ptrdiff_t>(0.7 * kRate), player.heard[0].end()};
}

TEST(StopsTest, FretsSoundTheirSemitones) {
  for (const std::string string : {"pitch: 98, impedance: 0.3, t60: [[1, 1.5], [10, 0.5]]",
                                   "frequency: 98, mass: 1.5e-5, damping: 6e-4, loss: 1e-4"}) {
    for (const bool is_from_last : {false, true}) {
      for (const int k : is_from_last ? std::vector<int>{5} : std::vector<int>{1, 5, 12, 15}) {
        const std::vector<double> sound = frettedSound(string, k, is_from_last);
        const double expected = 98.0 * std::exp2(k / 12.0);
        EXPECT_NEAR(test::cents(test::partialNear(sound, expected, kRate), expected), 0.0, 2.0)
            << string << ", fret " << k << (is_from_last ? " from the last end" : "");
      }
    }
  }
}

TEST(StopsTest, AreAsStiffAsTheRateBearsAndCertified) {
  const std::string text =
      "generators:\n"
      "  - {type: string, name: s, masses: 99, pitch: 98, impedance: 0.3, to: [0.65, 0]}\n"
      "  - {type: frets, name: f, along: s, count: 19, height: 1 mm, damping: 0.01}\n"
      "  - {type: barrier, name: b, along: s, curve: [[0.95, -3e-4], [1, 0]]}\n";
  for (const double rate : {44100.0, 96000.0}) {
    const Rates rates{rate, 14};
    const Settled settled = settle(sceneOf(text), rates);
    EXPECT_EQ(certify(settled.scene, rates).verdict, Verdict::kPassive) << rate;
    const double mass = settled.scene.mats[3].mass.factor;
    int contacts = 0;
    for (const Lia& lia : settled.scene.lias) {
      if (lia.type == LiaType::kContact) {
        ++contacts;
        const double share = lia.stiffness.factor / (mass * rate * rate);
        // A place between two masses meets up to both of them.
        EXPECT_GE(share, 2.0) << lia.name;
        EXPECT_LE(share, 6.0) << lia.name;
      }
    }
    EXPECT_EQ(contacts, 19 + 5);  // masses 95 ... 99 of 100 intervals
    EXPECT_TRUE(settled.scene.tunings.empty());
  }
}

/// Under a string that leaves them nothing they are soft, not unstable.
TEST(StopsTest, LeaveTheStringItsShare) {
  const std::string text =
      "generators:\n"
      "  - {type: string, name: s, masses: 99, mass: 1e-4, stiffness: 1.9e5, to: [0.65, 0]}\n"
      "  - {type: frets, name: f, along: s, count: 5, height: 1 mm}\n";
  EXPECT_EQ(certify(settle(sceneOf(text), kRates).scene, kRates).verdict, Verdict::kPassive);
}

TEST(StopsTest, FollowAMassThatIsAParameter) {
  const std::string text =
      "parameters: {m: {value: 1e-4, range: [5e-5, 2e-4]}}\n"
      "generators:\n"
      "  - {type: string, name: s, masses: 60, mass: $m, frequency: 110, to: [0.65, 0]}\n"
      "  - {type: frets, name: f, along: s, count: 3, height: 1 mm}\n";
  const scene::Scene scene = settle(sceneOf(text), kRates).scene;
  EXPECT_EQ(scene.lias.back().stiffness.parameter, 0);
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive);
}

TEST(StopsTest, ABarrierFollowsItsCurve) {
  const scene::Scene scene = sceneOf(
      "generators:\n"
      "  - {type: string, name: s, masses: 9, mass: 1e-4, stiffness: 100, to: [1, 0]}\n"
      "  - {type: barrier, name: b, along: s, curve: [[0, 0], [0.2, -2e-3], [0.4, -8e-3]]}\n");
  std::vector<double> heights;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.name.str().rfind("b.", 0) == 0) {
      heights.push_back(mat.position.x());
    }
  }
  ASSERT_EQ(heights.size(), 4U);  // none under the ground that is its end
  for (const auto& [index, height] : {std::pair{0, -1e-3}, {1, -2e-3}, {2, -5e-3}, {3, -8e-3}}) {
    EXPECT_NEAR(heights[at(index)], height, 1e-12) << index;
  }
}

struct TwoDecays {
  double slow = 0.0;  // 1/s
  double fast = 0.0;
  double apart_hz = 0.0;
};

/// Two strings that are mistuned by delta rad/s, on one resistance.
TwoDecays onABridge(double delta, const std::string& bridge) {
  const auto string = [](const char* name, double hz) {
    return "  - {type: string, name: " + std::string(name) +
           ", masses: 60, impedance: 0.3, to: [1, 0], pitch: " + number(hz) + "}\n";
  };
  const scene::Scene scene =
      settle(sceneOf("generators:\n" + string("s", 200.0 + 0.25 * delta / kPi) +
                     string("t", 200.0 - 0.25 * delta / kPi) + bridge),
             kRates)
          .scene;
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive);
  const auto poles = test::BodyPoles(scene, kRate).poles();
  std::vector<std::pair<double, double>> found;  // 1/s, Hz
  for (const auto& pole : poles) {
    const double hz = test::frequencyOf(pole, kRate);
    if (std::abs(hz - 200.0) < 20.0) {
      found.emplace_back(-std::log(std::abs(pole)) * kRate, hz);
    }
  }
  EXPECT_EQ(found.size(), 2U);
  std::sort(found.begin(), found.end());
  return {found[0].first, found[1].first, std::abs(found[0].second - found[1].second)};
}

/// Weinreich 1977: r +- sqrt(r^2 - (delta/2)^2), r = 2 f Z/R; beyond 2 r both r, and beats.
TEST(BridgeTest, TwoStringsOnOneResistanceDecayTwice) {
  const std::string bridge = "  - {type: bridge, name: b, of: [s, t], mass: 2 g, resistance: 60}\n";
  const double r = 2.0 * 200.0 * 0.3 / 60.0;
  for (const double delta : {0.0, 1.0, 2.0, 3.0}) {
    const TwoDecays found = onABridge(delta, bridge);
    const double root = std::sqrt(r * r - 0.25 * delta * delta);
    EXPECT_NEAR(found.fast / (r + root), 1.0, 0.02) << delta;
    EXPECT_NEAR(found.slow, r - root, 0.02 * r) << delta;
  }
  for (const double delta : {6.0, 12.0}) {
    const TwoDecays found = onABridge(delta, bridge);
    EXPECT_NEAR(found.fast / r, 1.0, 0.05) << delta;
    EXPECT_NEAR(found.slow / r, 1.0, 0.05) << delta;
    EXPECT_NEAR(found.apart_hz / (std::sqrt(0.25 * delta * delta - r * r) / kPi), 1.0, 0.02);
  }
}

/// sigma = 2 f Z/R, at either end, and on a module that is there.
TEST(BridgeTest, AStringOnAResistanceLosesByIt) {
  const std::string string =
      "generators:\n"
      "  - {type: string, name: s, masses: 60, impedance: 0.3, to: [1, 0], pitch: 200, ";
  const std::string own = "inharmonicity: 1e-4}\n  - {type: bridge, name: b, of: [s], ";
  const std::string mats =
      "mats: {m: {type: mass, mass: 2 g}, g: {type: ground}}\n"
      "lias: {r: {type: damper, between: [m, g], damping: 30}}\n";
  for (const std::string& text : {string + own + "mass: 2 g, resistance: 30}\n",
                                  string + own + "end: last, mass: 2 g, resistance: 30}\n",
                                  mats + string + own + "mat: m}\n"}) {
    const scene::Scene scene = settle(sceneOf(text), kRates).scene;
    EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive) << text;
    const auto pole = test::BodyPoles(scene, kRate).poles().front();
    EXPECT_NEAR(-std::log(std::abs(pole)) * kRate / (2.0 * 200.0 * 0.3 / 30.0), 1.0, 0.02) << text;
    EXPECT_NEAR(test::cents(test::frequencyOf(pole, kRate), 200.0), 0.0, 3.0) << text;
  }
}

TEST(BridgeTest, AStringOnABridgeIsNotCutAnew) {
  const std::string string =
      "generators:\n  - {type: string, name: s, masses: 20, mass: 1e-4, frequency: 200, to: [1, "
      "0]}\n";
  EXPECT_EQ(scene::reasonAgainstCutting(sceneOf(string), 0), "");
  for (const char* const end : {"first", "last"}) {
    const scene::Scene scene = sceneOf(string + "  - {type: bridge, name: b, of: [s], end: " + end +
                                       ", mass: 1 g, resistance: 3}\n");
    EXPECT_EQ(scene::reasonAgainstCutting(scene, 0), "it ends on a bridge") << end;
  }
}

}  // namespace
}  // namespace ergotic::physics
