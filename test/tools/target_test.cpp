// SPDX-License-Identifier: BSD-3-Clause
// What is proposed for a target, played and measured.
#include "ergotic/advice/target.hpp"

#include "ergotic/advice/accuracy.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/measure.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

using scene::readYaml;
using scene::Scene;
using test::kRates;

Scene stringOf(int masses, const std::string& more = "") {
  return readYaml(
      "ergotic: 1\nsections: {s: {}}\ngenerators:\n  - {type: string, name: a, masses: " +
          std::to_string(masses) + ", mass: " + std::to_string(0.002 / masses) +
          ", frequency: 98, to: [0.65, 0], pluck: {at: 0.13, height: 0.001}" + more +
          "}\noutputs: {o: {at: a@0.957, quantity: velocity, channel: 1}}\n",
      "string.yaml");
}

/// The worst of ten partials of what is played, cents.
double heardCents(const Scene& scene, const Rates& rates, Precision precision) {
  test::Player player(scene, rates, precision);
  player.ticks(static_cast<int>(0.52 * rates.gesturalHz()));
  const scene::StringCut cut = scene::cutOf(scene.strings[0]);
  double worst = 0.0;
  double ideal_hz = 0.0;
  for (const double partial : partialsOf(cut, 98.0 / rates.audio_hz, true)) {
    ideal_hz += 98.0;
    const double guess_hz = partial * rates.audio_hz;
    const double heard_hz = test::partialNear(player.heard[0], guess_hz, rates.audio_hz);
    worst = std::max(worst, std::abs(test::cents(heard_hz, ideal_hz)));
  }
  return worst;
}

Proposal proposalFor(const Scene& scene, const std::string& target, const Freedom& freedom = {}) {
  return propose(scene, kRates, Precision::kFloat, targetOf(target), freedom);
}

double errorOf(const scene::StringCut& cut, double rate_hz) {
  return 1200.0 * std::log2(1.0 + stringError(cut, 98.0 / rate_hz, true));
}

TEST(TargetTest, StringIsAsGoodAsAskedForWhenItIsPlayed) {
  for (const double asked : {20.0, 3.0, 1.0}) {
    const Proposal proposal = proposalFor(stringOf(300), std::to_string(asked) + " cents");
    EXPECT_TRUE(proposal.is_reached);
    EXPECT_LT(proposal.cost, 0.5 * proposal.present_cost);
    const double heard = heardCents(proposal.scene, proposal.rates, proposal.precision);
    EXPECT_LE(heard, asked * 1.02) << proposal.advice[0].change;
  }
}

TEST(TargetTest, NothingCheaperIsGoodEnough) {
  const double asked = 3.0;
  const Proposal proposal = proposalFor(stringOf(300), "3 cents");
  const scene::StringCut chosen = scene::cutOf(proposal.scene.strings[0]);
  for (const double rate_hz : {22050.0, 44100.0, 96000.0}) {
    for (int masses = kJudgedPartials; masses <= 200; ++masses) {
      const double elements[] = {2.0 * masses + 1.0, 4.0 * masses + 6.0};
      for (const bool coarse : {false, true}) {
        const double cost = rate_hz * elements[coarse ? 1 : 0];
        if (errorOf({masses, coarse}, rate_hz) <= asked) {
          EXPECT_GE(cost, 0.98 * proposal.cost) << masses << " " << coarse << " " << rate_hz;
        }
      }
    }
  }
  EXPECT_LE(errorOf(chosen, proposal.rates.audio_hz), asked);
  EXPECT_GT(errorOf({chosen.masses - 1, chosen.coarse}, proposal.rates.audio_hz), asked);
}

TEST(TargetTest, PitchThatAParameterChangesIsNotFitted) {
  const Scene scene = readYaml(
      "ergotic: 1\nparameters: {k: {value: 20000, range: [10000, 30000]}}\nsections: {s: {}}\n"
      "generators:\n  - {type: string, name: a, masses: 60, mass: 1e-4, stiffness: $k, "
      "to: [0.65, 0]}\n",
      "tuned.yaml");
  const Proposal proposal = proposalFor(scene, "50 cents");
  EXPECT_TRUE(proposal.is_reached);
  EXPECT_FALSE(scene::cutOf(proposal.scene.strings[0]).coarse);
  EXPECT_EQ(proposal.scene.strings[0].stiffness.parameter, 0);
}

/// Relative error of the duration of a contact of 1 ms, worst over the phase of the impact.
double playedDurationError(Scene scene, const Rates& rates) {
  double worst = 0.0;
  for (int phase = 0; phase < 8; ++phase) {
    const double step = 1.0 / rates.audio_hz;  // way of a step, at 1 m/s
    const double start = -(5.0 + phase / 8.0) * step;
    scene.mats[0].position.x() = start - step;
    test::Player player(scene, rates);
    player.ticks(static_cast<int>(1.5e-3 * rates.gesturalHz()) + 10);
    const double frames = static_cast<double>(player.heard[0].size()) - 1.0;
    const double velocity = player.heard[1].back() / rates.audio_hz;
    const double out = frames - player.heard[0].back() / velocity;
    worst = std::max(worst, std::abs((out + start / step) / (1e-3 * rates.audio_hz) - 1.0));
  }
  return worst;
}

/// A ball of 5 g that stays for 1 ms.
Scene ballOn(const std::string& scheme) {
  const double stiffness = 5e-3 * std::pow(M_PI / 1e-3, 2);
  return readYaml(
      "ergotic: 1\nsections: {room: {}}\nmats:\n  ball: {type: mass, mass: 0.005, v: 1}\n"
      "  wall: {type: ground}\nlias:\n  touch: {type: contact, between: [ball, wall], stiffness: " +
          std::to_string(stiffness) + ", scheme: " + scheme +
          "}\noutputs:\n  x: {at: ball, quantity: position, channel: 1}\n"
          "  v: {at: ball, quantity: velocity, channel: 2}\n",
      "ball.yaml");
}

TEST(TargetTest, ContactIsAsGoodAsAskedForWhenItIsPlayed) {
  for (const char* asked : {"5 cents", "1 cent", "0.05 cents"}) {
    const Target target = targetOf(asked);
    const Proposal proposal = proposalFor(ballOn("explicit"), asked);
    EXPECT_TRUE(proposal.is_reached) << asked;
    const double played = playedDurationError(proposal.scene, proposal.rates);
    EXPECT_LE(played, 1.5 * target.relative()) << asked;
    const double foretold = proposal.advice[0].proposed;
    EXPECT_LE(played, 3.0 * foretold) << asked;
    EXPECT_GE(played, foretold / 3.0) << asked;
  }
}

TEST(TargetTest, ExplicitContactIsEnergyStableOnlyWhereItHasToBe) {
  const Freedom here{false, false, true};
  const Proposal coarse = proposalFor(ballOn("explicit"), "1 cent", here);
  EXPECT_EQ(coarse.scene.lias[0].scheme, scene::Scheme::kExplicit);
  EXPECT_EQ(coarse.advice[0].change, "");
  const Proposal fine = proposalFor(ballOn("explicit"), "0.05 cents", here);
  EXPECT_EQ(fine.scene.lias[0].scheme, scene::Scheme::kEnergyStable);
  EXPECT_EQ(fine.rates.audio_hz, 44100.0);
  EXPECT_GT(fine.cost, coarse.cost);
}

const char* const kHand =
    "ergotic: 1\ngestural_rate: 1575\nsections: {s: {}, h: {rate: gestural}}\nmats:\n"
    "  key: {type: slice, section: h}\n"
    "generators:\n  - {type: string, name: a, section: s, masses: 80, mass: 1e-5, frequency: 220,\n"
    "     loss: 1e-5, to: [0.65, 0]}\n"
    "lias: {press: {type: spring, between: [key, a.40], stiffness: 300}}\n"
    "ports: {k: {mat: key, slice: 0}}\n";

TEST(TargetTest, StepsOfAHandAreFiltered) {
  const Freedom here{false, false, true};
  const Proposal proposal = propose(readYaml(kHand, "hand.yaml"), {44100.0, 28}, Precision::kFloat,
                                    targetOf("0.1 dB"), here);
  EXPECT_TRUE(proposal.is_reached);
  EXPECT_TRUE(proposal.scene.lias.back().filtered);
  EXPECT_THAT(proposal.advice[0].change, HasSubstr("chaplet"));
}

TEST(TargetTest, WallStaysAsSilentAsItWas) {
  const Scene scene = readYaml(kHand, "hand.yaml");
  const Proposal proposal = proposalFor(scene, "3 cents");
  const Certificate certificate = certify(scene, kRates);
  ASSERT_EQ(certificate.ports.size(), 1U);
  const double higher = proposal.rates.gesturalHz() / kRates.gesturalHz();
  EXPECT_LE(certificate.ports[0].stiffness, 0.5 * higher * certificate.ports[0].stiffness_limit);
}

TEST(TargetTest, OutOfReachIsSaidAndTheBestIsProposed) {
  const Scene scene = stringOf(8, ", loss: 1e-5");
  Scene damped = readYaml(
      "ergotic: 1\nsections: {s: {medium: 1e-5}}\ngenerators:\n  - {type: string, name: a, "
      "masses: 20, mass: 1e-4, frequency: 98, to: [0.65, 0]}\n",
      "damped.yaml");
  const Proposal proposal = proposalFor(damped, "1 cent");
  EXPECT_FALSE(proposal.is_reached);
  EXPECT_THAT(proposal.advice[0].remark, HasSubstr("medium"));
  EXPECT_EQ(proposal.scene.strings[0].count, 22);
  EXPECT_TRUE(proposalFor(scene, "1 cent").is_reached) << "it can be cut";
}

TEST(TargetTest, SinglePrecisionGoesAsFarAsItCan) {
  EXPECT_EQ(proposalFor(ballOn("auto"), "0.1 %").precision, Precision::kFloat);
  EXPECT_EQ(proposalFor(ballOn("auto"), "0.01 %").precision, Precision::kDouble);
  const Freedom kept{true, true, false};
  EXPECT_EQ(proposalFor(ballOn("auto"), "0.1 %", kept).precision, Precision::kFloat);
}

TEST(TargetTest, ReadsCentsDecibelsAndPercent) {
  EXPECT_NEAR(targetOf("1 cent").relative(), 5.7779e-4, 1e-8);
  EXPECT_NEAR(targetOf("12cents").relative(), 6.9555e-3, 1e-7);
  EXPECT_NEAR(targetOf("0.1 dB").relative(), 1.15795e-2, 1e-7);
  EXPECT_EQ(targetOf("0.5 %").relative(), 0.005);
  EXPECT_EQ(inUnit(targetOf("2 cents").relative(), Target::Unit::kCents), "2 cents");
  EXPECT_EQ(inUnit(1.0, Target::Unit::kPercent), "out of reach");
}

TEST(TargetTest, RefusesWhatIsNoAccuracyAndNamesWhatIs) {
  for (const char* text : {"", "1", "cent", "1 Hz", "0 cents", "-1 cent", "1000 cents", "9 dB",
                           "80 %", "nan cents", "1 cent or so"}) {
    EXPECT_THAT(complaintOf([&] { targetOf(text); }),
                AllOf(HasSubstr(text), HasSubstr("0.01...100 cent"), HasSubstr(" dB"),
                      HasSubstr("...50 %")));
  }
}

TEST(TargetTest, RefusesAUnitThatNothingCanBeJudgedIn) {
  EXPECT_THROW(proposalFor(stringOf(40), "0.1 dB"), Exception);
  const Scene idle =
      readYaml("ergotic: 1\nsections: {s: {}}\nmats: {m: {type: mass, mass: 1}}\n", "idle.yaml");
  EXPECT_THAT(complaintOf([&] { proposalFor(idle, "1 cent"); }),
              AllOf(HasSubstr("idle.yaml"), HasSubstr("cents")));
}

}  // namespace
}  // namespace ergotic::physics
