// SPDX-License-Identifier: BSD-3-Clause
// Bodies that move freely: which they are, and that they play in double precision.
#include "ergotic/physics/certificate/precision.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "constants.hpp"
#include "physics/certificate/certified_scene.hpp"
#include "support/bars.hpp"

namespace ergotic::physics {
namespace {

using Edge = test::Bars::Edge;

std::size_t freeBodiesOf(const std::string& text) {
  return bodiesThatMoveFreely(Certified(text).scene).size();
}

/// Four masses on one another; `links` beside.
std::string fourMasses(const std::string& links, const std::string& more = "") {
  return kOfAudio +
         "  m0: {type: mass, mass: 0.001, v: -0.3}\n  m1: {type: mass, mass: 0.001, v: -0.1}\n"
         "  m2: {type: mass, mass: 0.001, v: 0.1}\n  m3: {type: mass, mass: 0.001, v: 0.3}\n" +
         more + "lias:\n" + links + "outputs: {o: {at: m0, quantity: velocity, channel: 1}}\n";
}

const std::string kTwoBends =
    "  a: {type: bend, between: [m0, m1, m2], weights: [1, -2, 1], stiffness: 3e5}\n"
    "  b: {type: bend, between: [m1, m2, m3], weights: [1, -2, 1], stiffness: 3e5}\n";
const std::string kThreeSprings =
    "  s0: {type: spring, between: [m0, m1], stiffness: 1e5}\n"
    "  s1: {type: spring, between: [m1, m2], stiffness: 1e5}\n"
    "  s2: {type: spring, between: [m2, m3], stiffness: 1e5}\n";

std::string springToGround(const char* mass, const char* stiffness) {
  return std::string("  to_") + mass + ": {type: spring, between: [" + mass +
         ", g], stiffness: " + stiffness + "}\n";
}

TEST(PrecisionTest, ABodyThatNothingHoldsMovesFreely) {
  EXPECT_EQ(freeBodiesOf(fourMasses(kTwoBends)), 1U);
  EXPECT_EQ(freeBodiesOf(fourMasses(kThreeSprings)), 1U);
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).bar(12, Edge::kFree, Edge::kFree)), 1U);
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).freePlate(4, 0.3)), 1U);
}

TEST(PrecisionTest, ABarThatIsHeldAtOnePlaceTurnsFreely) {
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).bar(12, Edge::kHinged, Edge::kFree)), 1U);
  EXPECT_EQ(freeBodiesOf(fourMasses(kTwoBends + springToGround("m1", "1000"))), 1U);
}

TEST(PrecisionTest, WhatIsHeldPlaysInSinglePrecision) {
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).bar(12, Edge::kHinged, Edge::kHinged)), 0U);
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).bar(12, Edge::kClamped, Edge::kFree)), 0U);
  EXPECT_EQ(freeBodiesOf(test::Bars(0.05).supportedPlate(4)), 0U);
  EXPECT_EQ(freeBodiesOf(fourMasses(kThreeSprings + springToGround("m1", "1"))), 0U);
  EXPECT_EQ(
      freeBodiesOf(fourMasses(kTwoBends + springToGround("m0", "10") + springToGround("m3", "10"))),
      0U);
}

/// The slowest motion decides: 4 g on springs that bring it back within a second, or not.
TEST(PrecisionTest, ASoftSpringHoldsABarIfItBringsItBackWithinASecond) {
  const auto held = [](double hz) {
    const double each = 0.002 * std::pow(2.0 * kPi * hz, 2.0);
    const std::string stiffness = std::to_string(each);
    return fourMasses(kTwoBends + springToGround("m0", stiffness.c_str()) +
                      springToGround("m3", stiffness.c_str()));
  };
  EXPECT_EQ(freeBodiesOf(held(0.9)), 1U);
  EXPECT_EQ(freeBodiesOf(held(1.1)), 0U);
}

/// A contact holds nothing, and a mass by itself has no springs that could see its place.
TEST(PrecisionTest, ContactsDoNotHoldAndSingleMassesAreNoBodies) {
  const std::string contact = "  c: {type: contact, between: [m1, g], stiffness: 1e4}\n";
  EXPECT_EQ(freeBodiesOf(fourMasses(kTwoBends + contact)), 1U);
  EXPECT_EQ(freeBodiesOf(fourMasses(contact)), 0U);
}

TEST(PrecisionTest, TheUserIsToldWhichBodyAskedForDoublePrecision) {
  const Certified turning(fourMasses(kTwoBends));
  EXPECT_EQ(withPrecision(Precision::kAuto, turning.scene).precision, Precision::kDouble);
  EXPECT_EQ(withPrecision(Precision::kFloat, turning.scene).precision, Precision::kFloat);
  EXPECT_THAT(notesOnPrecision(turning.scene),
              testing::ElementsAre(HasSubstr("rounding.yaml:5:3: note: nothing holds the body of "
                                             "'m0' in its place")));
  const Certified held(fourMasses(kThreeSprings + springToGround("m1", "1")));
  EXPECT_EQ(withPrecision(Precision::kAuto, held.scene).precision, Precision::kFloat);
  EXPECT_TRUE(notesOnPrecision(held.scene).empty());
}

TEST(PrecisionTest, InSinglePrecisionABodyThatMovesFreelyIsUnproven) {
  const Certified turning(fourMasses(kTwoBends));
  const Certificate certificate = certify(turning.scene, turning.rates);
  EXPECT_EQ(certificate.verdict, Verdict::kPassive);
  const Certificate in_float = inPrecision(certificate, turning.scene, Precision::kFloat);
  EXPECT_EQ(in_float.verdict, Verdict::kUnproven);
  EXPECT_THAT(in_float.findings.front(), HasSubstr("precision: auto or double"));
  EXPECT_EQ(inPrecision(certificate, turning.scene, Precision::kDouble).verdict, Verdict::kPassive);
}

/// m/s, as kAuto plays it.
double fastestOf(const Certified& scene, double seconds) {
  return scene.fastestOf(seconds, withPrecision(Precision::kAuto, scene.scene).precision);
}

/// A minute of turning: single precision made 4,276 J of 1e-4 J.
TEST(PrecisionTest, ATurningBarTurnsOnEvenly) {
  const Certified bar(fourMasses(kTwoBends));
  EXPECT_NEAR(fastestOf(bar, 60.0), 0.3, 1e-3);
}

/// The stiffest that the rate bears, turning away: 8e10 m/s in single precision.
TEST(PrecisionTest, ABendNearItsLimitDoesNotGrow) {
  const Certified bend(
      kOfAudio +
      "  m0: {type: mass, mass: 0.00281, v: -0.247}\n  m1: {type: mass, mass: 0.00968, v: -0.587}\n"
      "  m2: {type: mass, mass: 0.00325, v: -0.392}\n  m3: {type: mass, mass: 0.0164, v: -0.037}\n"
      "lias:\n  l: {type: bend, between: [m0, m1, m2, m3], weights: [1, -1, -1, 1], "
      "stiffness: 9390000, rest_length: 0.000386}\n"
      "outputs: {o: {at: m0, quantity: velocity, channel: 1}}\n");
  EXPECT_TRUE(bend.isCertified());
  const double soon = fastestOf(bend, 1.0);
  EXPECT_LT(fastestOf(bend, 60.0), 1.01 * soon);
}

/// A body that a hammer strikes and that flies off: what is heard over and above the flight.
class FlyingBody {
 public:
  /// Of a generator of a body `b`, struck at `hit`, heard at `ear`.
  FlyingBody(const std::string& generator, const std::string& hit, const std::string& ear)
      : scene_(
            "ergotic: 1\nsections: {a: {rate: audio}}\nmats:\n"
            "  h: {type: mass, section: a, mass: 0.02, x: -0.0001, v: 2}\ngenerators:\n  - {" +
            generator + ", name: b, section: a}\nlias:\n  f: {type: felt, between: [h, '" + hit +
            "'], stiffness: 1e7, exponent: 2, damping: 0.2}\noutputs: {o: {at: '" + ear +
            "', quantity: velocity, channel: 1}}\n") {
    Player player(
        compile(scene_.scene, scene_.rates, withPrecision(Precision::kAuto, scene_.scene)));
    for (int n = 0; n < kSeconds * scene_.rates.gesturalHz(); ++n) {
      player.tick();
    }
    // The flight is slow: a second difference leaves nothing of it.
    const std::vector<double>& heard = player.heard.at(0);
    for (std::size_t i = 1; i + 1 < heard.size(); ++i) {
      sound_.push_back(heard[i - 1] - 2.0 * heard[i] + heard[i + 1]);
    }
  }

  double levelAt(double seconds) const {  // dB re the strike
    double most = 0.0;
    for (std::size_t i = frameAt(seconds); i < frameAt(seconds + 0.2); ++i) {
      most = std::max(most, std::abs(sound_.at(i)));
    }
    return 20.0 * std::log10(most / *std::max_element(sound_.begin(), sound_.end()));
  }

  /// Of one partial, from its level at two times, s.
  double t60(double hz, double from, double to) const {
    const double fall = partialAt(hz, from) - partialAt(hz, to);
    return 60.0 * (to - from) / fall;
  }

 private:
  static constexpr double kSeconds = 8.0;

  std::size_t frameAt(double seconds) const {
    return static_cast<std::size_t>(seconds * scene_.rates.audio_hz);
  }

  double partialAt(double hz, double seconds) const {  // dB
    const std::size_t count = frameAt(0.2);
    const std::size_t first = frameAt(seconds);
    double re = 0.0;
    double im = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double window =
          1.0 - std::cos(2.0 * kPi * static_cast<double>(i) / static_cast<double>(count));
      const double phase = 2.0 * kPi * hz * static_cast<double>(i) / scene_.rates.audio_hz;
      re += window * sound_.at(first + i) * std::cos(phase);
      im += window * sound_.at(first + i) * std::sin(phase);
    }
    return 10.0 * std::log10(re * re + im * im);
  }

  Certified scene_;
  std::vector<double> sound_;
};

/// In single precision it droned at -33 dB for ever, and its partials seemed to ring for 1.9, 2.4
/// and 3.8 s.
TEST(PrecisionTest, AStruckBarThatFliesOffFallsSilent) {
  const FlyingBody bar(
      "type: bar, masses: 12, mass: 0.3, pitch: C3, ratios: [4, 10], t60: [[1, 1.5], [3, 0.6]], "
      "to: [0.4, 0], places: {hit: 0.03, ear: 0.97}",
      "b.hit", "b.ear");
  EXPECT_LT(bar.levelAt(4.0), -100.0);
  EXPECT_NEAR(bar.t60(130.8, 0.3, 1.3), 1.5, 0.03);
  EXPECT_NEAR(bar.t60(10.0 * 130.8, 0.2, 0.6), 0.6, 0.012);
}

/// In single precision it drones at -30 dB. Its third partial is at 24.27/13.468 of the first.
TEST(PrecisionTest, AStruckPlateThatFliesOffFallsSilent) {
  const FlyingBody plate("type: plate, cells: 8, mass: 0.3, pitch: C3, t60: [[1, 1.5], [3, 0.9]]",
                         "b@0.06:0.06", "b@0.94:0.94");
  EXPECT_LT(plate.levelAt(4.0), -100.0);
  EXPECT_NEAR(plate.t60(130.8, 0.3, 1.3), 1.5, 0.03);
  EXPECT_NEAR(plate.t60(24.27 / 13.468 * 130.8, 0.2, 0.6), 0.9, 0.018);
}

}  // namespace
}  // namespace ergotic::physics
