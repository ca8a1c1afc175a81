// SPDX-License-Identifier: BSD-3-Clause
// Strings that end on bodies, by their sound: in tune with them, and out of tune if nobody tunes
// them together; and two on one bridge.
#include <algorithm>
#include <cmath>
#include <complex>

#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "tools/lib/truths.hpp"

namespace ergotic::tools {
namespace {

using test::kRates;

struct Body {
  std::string mats;  // with a module `end`
  std::string lias;
};

const Body kMass{
    "  end: {type: mass, section: a, mass: 5 g}\n",
    "  hold: {type: spring_damper, between: [end, rock], stiffness: 1e5, damping: 0.1}\n"};
const Body kSpring{
    "  end: {type: mass, section: a, mass: 0.1 g}\n",
    "  hold: {type: spring_damper, between: [end, rock], stiffness: 3e4, damping: 0}\n"};
const Body kResonator{"  end: {type: cell, section: a, mass: 0.1 kg, stiffness: 6e4, damping: 6}\n",
                      ""};

/// How far off the string is on a body, cents: of what is heard after the body has come to rest.
double centsOff(const Body& body, const std::string& string, const std::string& end) {
  const std::string text =
      "ergotic: 1\nsections: {a: {rate: audio}}\nmats:\n"
      "  rock: {type: ground, section: a}\n" +
      body.mats + "lias:\n  ease: {type: damper, between: [end, rock], damping: 1e-6}\n" +
      body.lias + "generators:\n  - {type: string, name: s, section: a, masses: 60, " + string +
      ", to: [0.65, 0]" + (end == "ends" ? ", ends: [ground, end]}\n" : "}\n") +
      (end == "tied" ? "  - {type: bridge, name: b, of: [s], end: last, mat: end}\n" : "") +
      "outputs: {out: {at: s@0.2, quantity: velocity, channel: 1}}\ntruths:\n"
      "  - {what: pitch, of: out, play: {pluck: 0.2 N, at: s@0.15}, after: 0.6 s, "
      "expect: A2, within: 0.05 cents}\n";
  const scene::ClaimingScene claims = scene::readTruths(text, "coupled.yaml");
  const JudgedTruth judged = judgeTruths(claims, kRates, physics::Precision::kDouble).at(0);
  EXPECT_EQ(judged.trouble, "");
  return judged.off;
}

const std::string kTuned = "pitch: A2, impedance: 0.3, t60: [[1, 6 s], [10, 2 s]]";
const std::string kLimp = "frequency: 110, mass: 2.2e-5, loss: 2e-5";

TEST(CoupledStringsTest, AreInTuneOnMassesSpringsAndResonators) {
  for (const Body& body : {kMass, kSpring, kResonator}) {
    for (const std::string& string : {kTuned, kLimp}) {
      EXPECT_LT(centsOff(body, string, "ends"), 0.05) << body.mats << string;
      EXPECT_GT(centsOff(body, string, "tied"), 1.0) << body.mats << string;
    }
  }
}

TEST(CoupledStringsTest, AreInTuneOnAPlateThatIsANetwork) {
  const std::string scene = R"(ergotic: 1
sections: {a: {rate: audio}}
generators:
  - {type: plate, name: board, section: a, edges: clamped, cells: 10, mass: 300 g, pitch: 170 Hz,
     t60: [[1, 0.2 s], [8, 0.1 s]]}
  - {type: string, name: s, section: a, masses: 60, pitch: A2, impedance: 0.3, t60: 6 s, to: [0.65, 0],
     ends: ['board@0.5:0.5', ground]}
outputs: {out: {at: s@0.2, quantity: velocity, channel: 1}}
truths:
  - {what: pitch, of: out, play: {pluck: 0.2 N, at: s@0.15}, after: 0.3 s, expect: A2, within: 0.05 cents}
)";
  EXPECT_TRUE(
      judgeTruths(scene::readTruths(scene, "plate.yaml"), kRates, physics::Precision::kDouble)
          .at(0)
          .holds);
}

/// It would be tuned to another mode than its first.
TEST(CoupledStringsTest, WithAFreeEndAreLeftAsTheyWereAndSayWhy) {
  const std::string head = R"(ergotic: 1
sections: {a: {rate: audio}}
mats: {end: {type: cell, section: a, mass: 1e-5, damping: 1e-6}}
generators:
  - {type: string, name: s, section: a, masses: 60, frequency: 110, mass: 2.2e-5, to: [0.65, 0])";
  const auto stiffness_of = [&](const std::string& more) {
    const physics::Settled settled =
        physics::settle(scene::readYaml(head + more + "}\n", "free.yaml"), kRates);
    const auto warns = std::any_of(
        settled.scene.warnings.begin(), settled.scene.warnings.end(), [](const auto& warning) {
          return warning.find("string 's' cannot be tuned to ") != std::string::npos;
        });
    EXPECT_EQ(warns, !more.empty());
    return settled.scene.lias.front().stiffness.factor;
  };
  EXPECT_EQ(stiffness_of(", ends: [ground, end]"), stiffness_of(""));
}

/// Two strings that share a bridge: what moves it dies soon, what does not goes on (Weinreich 1977,
/// Journal of the Acoustical Society of America 62). Each by itself loses `own`, 1/s; both in step
/// lose mu more, by what a bridge of this impedance reflects of their waves; and they are `apart`,
/// rad/s: lambda = -own - mu/2 +- sqrt(mu^2 - apart^2)/2.
TEST(CoupledStringsTest, OfAPairDecayTwiceAsWeinreichSays) {
  constexpr double kHz = 110.0;
  constexpr double kImpedance = 0.3;    // N s/m
  constexpr double kResistance = 60.0;  // N s/m, of the bridge
  constexpr double kMass = 1e-3;
  constexpr double kStiffness = 2000.0;
  constexpr double kOwnT60 = 30.0;
  const double omega = 2.0 * M_PI * kHz;
  const std::complex<double> bridge(kResistance, omega * kMass - kStiffness / omega);
  const std::complex<double> mu =
      kHz * std::log((bridge + 2.0 * kImpedance) / (bridge - 2.0 * kImpedance));
  for (const double apart_hz : {0.0, 0.1, 0.2}) {
    const std::string string =
        "  - {type: string, section: a, masses: 60, impedance: 0.3, t60: 30 s, "
        "to: [0.65, 0], ";
    const std::string text =
        "ergotic: 1\nsections: {a: {rate: audio}}\ngenerators:\n" + string +
        "name: low, pitch: 110 Hz}\n" + string +
        "name: high, pitch: " + std::to_string(kHz + apart_hz) +
        "}\n  - {type: bridge, name: b, of: [low, high], section: a, end: last, mass: 1 g, "
        "stiffness: 2000, resistance: 60}\n"
        "outputs: {out: {at: low@0.2, quantity: velocity, channel: 1}}\ntruths:\n"
        "  - {what: double_decay, of: out, play: {pluck: 0.2 N, at: low@0.15}, near: A2, "
        "after: 0.3 s, seconds: 15 s, expect: [1, 10], within: 1 s}\n";
    const JudgedTruth judged =
        judgeTruths(scene::readTruths(text, "pair.yaml"), kRates, physics::Precision::kDouble)
            .at(0);
    ASSERT_EQ(judged.measured.size(), 2U) << judged.trouble;
    const double own = 3.0 * std::log(10.0) / kOwnT60;
    const double apart = 2.0 * M_PI * apart_hz;
    const std::complex<double> split = 0.5 * std::sqrt(mu * mu - apart * apart);
    const double fast = 3.0 * std::log(10.0) / (own + (0.5 * mu + split).real());
    const double slow = 3.0 * std::log(10.0) / (own + (0.5 * mu - split).real());
    EXPECT_NEAR(judged.measured[0], fast, 0.005 * fast) << apart_hz;
    EXPECT_NEAR(judged.measured[1], slow, 0.005 * slow) << apart_hz;
    EXPECT_GT(judged.measured[1], 4.0 * judged.measured[0]);
  }
}

}  // namespace
}  // namespace ergotic::tools
