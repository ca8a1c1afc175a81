// SPDX-License-Identifier: BSD-3-Clause
// What single precision makes of scenes whose numbers, as they are written, do not grow.
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/certificate/certified_scene.hpp"
#include "physics/certificate/rounding_noise.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A slow mass of 1 kg and a fast one, each on a spring, and one between them.
struct TwoRates {
  double rate_hz;
  double mass;
  double slow;
  double between;
  double fast;

  std::string text() const {
    char text[600];
    std::snprintf(
        text, sizeof text,
        "ergotic: 1\ngestural_rate: %g\nsections: {a: {rate: audio}, g: {rate: gestural}}\n"
        "mats:\n  w: {type: ground, section: a}\n  v: {type: ground, section: g}\n"
        "  s: {type: mass, section: g, mass: 1, v: 0.1}\n"
        "  m: {type: mass, section: a, mass: %.17g, v: 0.05}\nlias:\n"
        "  k0: {type: spring, between: [v, s], stiffness: %.17g}\n"
        "  c: {type: spring, between: [s, m], stiffness: %.17g}\n"
        "  k2: {type: spring, between: [m, w], stiffness: %.17g}\n"
        "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n",
        rate_hz, mass, slow, between, fast);
    return text;
  }
};

/// Two modes that are about to meet; rounded, they have met.
TEST(RoundingTest, ModesOfTwoRatesMayMeet) {
  TwoRates masses{14700.0, 0.95104052612866596, 176471579.09136432, 622786170.55229306,
                  6446979860.1201553};
  const Certified near(masses.text());
  EXPECT_GT(near.fastestOf(1.0, Precision::kFloat), 1e4);
  EXPECT_LT(near.fastestOf(1.0, Precision::kDouble), 1e3);
  EXPECT_THAT(certify(near.scene, near.rates).findings,
              Contains(HasSubstr("so near to one another that rounding")));
  masses.between = 5e8;
  EXPECT_TRUE(Certified(masses.text()).isCertified());
}

/// A mode meets itself at half the slower rate, or comes back to where it was; and a weak link
/// opens a narrow tongue, whose edge is near where its modes still lie apart.
TEST(RoundingTest, ModesMayMeetWhereTheySeemToLieApart) {
  for (const TwoRates& masses : {TwoRates{7350.0, 0.10721421816044466, 40013308.134939604,
                                          18303741.013012707, 35804142.70452252},
                                 TwoRates{8820.0, 0.060710044819306273, 79558840.834081396,
                                          22891920.351789311, -17776877.658830639},
                                 TwoRates{14700.0, 0.54114155065623715, 634963618.00678289,
                                          48753.639355702573, 1763486273.5239983}}) {
    EXPECT_FALSE(Certified(masses.text()).isCertified()) << masses.mass;
  }
}

/// A fast mode makes whole turns in a tick, and hardly anything of its pull is left for the slow
/// mass: rounded, that may push.
TEST(RoundingTest, WholeTurnsInATickLeaveADifferenceOfLargeForces) {
  const auto freePair = [](double gestural_hz, double mass, double slow, double stiffness) {
    char text[400];
    std::snprintf(
        text, sizeof text,
        "ergotic: 1\ngestural_rate: %.17g\nsections: {a: {rate: audio}, g: {rate: gestural}}\n"
        "mats:\n  s: {type: mass, section: g, mass: %.17g, x: 0.01}\n"
        "  m: {type: mass, section: a, mass: %.17g}\nlias:\n"
        "  c: {type: spring, between: [s, m], stiffness: %.17g}\n"
        "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n",
        gestural_hz, slow, mass, stiffness);
    return Certified(text);
  };
  const Certified turning =
      freePair(4009.090909090909, 0.0016446230878211844, 1.0, 10586076.054260574);
  EXPECT_GT(turning.fastestOf(10.0, Precision::kFloat),
            100.0 * turning.fastestOf(10.0, Precision::kDouble));
  EXPECT_FALSE(turning.isCertified());
  EXPECT_TRUE(freePair(4009.090909090909, 0.0016446230878211844, 1.0, 1.0e7).isCertified());
  EXPECT_FALSE(freePair(11025.0, 0.017862855732460367, 0.25428376636417033, 69479721.879332632)
                   .isCertified());
}

/// The same among modules that do nothing: whichever numbers are there, none are rounded alike in
/// all cases.
TEST(RoundingTest, NoNumbersAreRoundedAlike) {
  std::string text =
      "ergotic: 1\ngestural_rate: 4009.090909090909\n"
      "sections: {a: {rate: audio}, g: {rate: gestural}}\nmats:\n";
  for (int i = 0; i < 27; ++i) {
    const std::string idle = "  d" + std::to_string(i) + ": {type: ground, section: a}\n";
    text += i == 1    ? "  s: {type: mass, section: g, mass: 1, x: 0.01}\n"
            : i == 23 ? "  m: {type: mass, section: a, mass: 0.0016446230878211844}\n"
                      : idle;
  }
  const Certified scene(
      text +
      "lias: {c: {type: spring, between: [s, m], stiffness: 10586076.054260574}}\n"
      "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n");
  EXPECT_GT(scene.fastestOf(10.0, Precision::kFloat),
            100.0 * scene.fastestOf(10.0, Precision::kDouble));
  EXPECT_FALSE(scene.isCertified());
}

/// Fast masses make nearly whole turns in a tick: 0.05 m/s become 60, in double, too, and come
/// back after seconds.
TEST(RoundingTest, WhatBecomesAThousandTimesAsLargeIsNotCertified) {
  const Certified scene(
      "ergotic: 1\ngestural_rate: 1470\nsections: {a: {rate: audio}, c: {rate: gestural}}\nmats:\n"
      "  m0: {type: mass, section: a, mass: 3.8037751663184009e-05, v: 0.05}\n"
      "  m1: {type: mass, section: a, mass: 5.6824164402537729e-05, v: 0.06}\n"
      "  m2: {type: mass, section: c, mass: 0.036240692695251916, v: 0.07}\n"
      "  m3: {type: mass, section: c, mass: 0.0058381114174321106, v: 0.08}\nlias:\n"
      "  l0: {type: spring, between: [m1, m0], stiffness: 3102.324677720243}\n"
      "  l1: {type: spring, between: [m2, m0], stiffness: 70475.512925410352}\n"
      "  l2: {type: spring, between: [m3, m1], stiffness: 75868.358480854266}\n"
      "outputs: {o: {at: m0, quantity: velocity, channel: 1}}\n");
  EXPECT_GT(scene.fastestOf(10.0, Precision::kDouble), 50.0);
  EXPECT_FALSE(scene.isCertified());
}

TEST(RoundingTest, WhatANegativeSpringLeavesMayBeLess) {
  const auto held = [](double left) {
    const double a = 341302181.43452132;
    const double b = 1169473578.3015051;
    char text[400];
    std::snprintf(text, sizeof text,
                  "  m: {type: mass, mass: 1, x: 1e-3}\nlias:\n"
                  "  l: {type: spring, between: [g, m], stiffness: %.17g}\n"
                  "  q: {type: spring, between: [g, m], stiffness: %.17g}\n"
                  "  n: {type: spring, between: [g, m], stiffness: %.17g}\n"
                  "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n",
                  a, b, -(a + b) * (1.0 - left));
    return Certified(kOfAudio + text);
  };
  const Certified less = held(3e-9);
  EXPECT_GT(less.fastestOf(2.0, Precision::kFloat), 1e3);
  EXPECT_LT(less.fastestOf(2.0, Precision::kDouble), 1.0);
  EXPECT_FALSE(less.isCertified());
  EXPECT_TRUE(held(1e-5).isCertified());
}

/// Its pole becomes a double one.
TEST(RoundingTest, ACellAtHalfTheRateIsNone) {
  const auto cell = [](double frequency) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "  m: {type: cell, mass: 0.01, stiffness: %.17g, matched: true, v: 1}\n"
                  "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n",
                  0.01 * std::pow(2.0 * kPi * frequency, 2));
    return Certified(kOfAudio + text);
  };
  EXPECT_FALSE(cell(22049.5).isCertified());
  EXPECT_FALSE(cell(22050.0).isCertified());
  EXPECT_TRUE(cell(22000.0).isCertified());
}

/// It has 12 binary digits of the stiffness of a bend, here 2048.51, half a digit less than it
/// plays.
TEST(RoundingTest, ABendAtTheLimitIsNoneEither) {
  const auto bar = [](double limit) {
    const double stiffness = 2048.51 * 4096.0;
    const double mass = 1.5 * stiffness / (kRate * kRate * limit);
    char text[400];
    std::snprintf(text, sizeof text,
                  "  a: {type: mass, mass: %.17g, v: 0.1}\n  b: {type: mass, mass: %.17g}\n"
                  "  c: {type: mass, mass: %.17g}\nlias:\n  l: {type: bend, between: [a, b, c], "
                  "weights: [1, -2, 1], stiffness: %.17g}\n"
                  "outputs: {o: {at: b, quantity: velocity, channel: 1}}\n",
                  mass, mass, mass, stiffness);
    return Certified(kOfAudio + text);
  };
  EXPECT_GT(bar(0.9999).fastestOf(1.0, Precision::kFloat), 1e3);
  EXPECT_LT(bar(0.9999).fastestOf(1.0, Precision::kDouble), 10.0);
  EXPECT_FALSE(bar(0.9999).isCertified());
  EXPECT_TRUE(bar(0.9997).isCertified());
  EXPECT_LT(bar(0.9997).fastestOf(1.0, Precision::kFloat), 10.0);
}

/// Two masses in a plane on prestressed springs of 7 MN/m.
std::string prestressed(double between, double damping) {
  char text[900];
  std::snprintf(text, sizeof text,
                "ergotic: 1\nsections: {a: {geometry: plane}}\nmats:\n"
                "  g1: {type: ground, section: a}\n"
                "  m1: {type: mass, section: a, mass: 0.01, at: [%g, 0], v: [1e-4, 0]}\n"
                "  m2: {type: mass, section: a, mass: 0.015, at: [%g, 0]}\n"
                "  g2: {type: ground, section: a, at: [%g, 0]}\nlias:\n"
                "  l1: {type: spring, between: [g1, m1], stiffness: 0.7e7}\n"
                "  l2: {type: spring, between: [m1, m2], stiffness: 0.7e7}\n"
                "  l3: {type: spring, between: [m2, g2], stiffness: 0.7e7}\n"
                "  z1: {type: damper, between: [m1, g1], damping: %g}\n"
                "outputs: {o: {at: m1, quantity: velocity, channel: 1}}\n",
                between, 2 * between, 3 * between, damping);
  return text;
}

/// The speed that a note on rounding tells, m/s; 0 without one.
double toldOf(const Certified& certified) {
  const std::vector<std::string> notes = notesOnRounding(certified.scene, certified.rates);
  if (notes.empty()) {
    return 0.0;
  }
  EXPECT_EQ(notes.size(), 1U);
  const std::string& note = notes.front();
  return std::stod(note.substr(note.find("up to about ") + 12));
}

TEST(RoundingTest, TellsHowFarNoiseHeatsWhatLosesNothing) {
  const Certified lossless(prestressed(1.0, 0.0));
  EXPECT_TRUE(lossless.isCertified());
  const double told = toldOf(lossless);
  const double played = lossless.fastestOf(60.0, Precision::kFloat);  // the rms times 3, about
  EXPECT_GT(told, 0.25 * played);
  EXPECT_LT(told, 2.0 * played);
  EXPECT_LT(lossless.fastestOf(10.0, Precision::kDouble), 3e-4);
  EXPECT_LT(toldOf(Certified(prestressed(0.1, 0.0))), 0.11 * told + 0.05);
}

/// Three masses that are thrown, or fall: positions grow, and with them what they are rounded by.
TEST(RoundingTest, TellsOfWhatNothingHolds) {
  const auto thrown = [](double gravity, double v) {
    char text[500];
    std::snprintf(text, sizeof text,
                  "ergotic: 1\nsections: {s: {gravity: %g}}\nmats:\n"
                  "  a: {type: mass, mass: 0.011, v: %g}\n  b: {type: mass, mass: 0.0087, v: %g}\n"
                  "  c: {type: mass, mass: 0.0137, v: %.4f}\nlias:\n"
                  "  ab: {type: spring, between: [a, b], stiffness: 5e6}\n"
                  "  bc: {type: spring, between: [b, c], stiffness: 6e6}\n"
                  "outputs: {o: {at: a, quantity: velocity, channel: 1}}\n",
                  gravity, v, v, v + 0.001);
    return Certified(text);
  };
  const Certified falling = thrown(-9.81, 0.0);
  EXPECT_LT(falling.fastestOf(10.0, Precision::kDouble), 98.2);
  EXPECT_GT(falling.fastestOf(10.0, Precision::kFloat), 110.0);
  EXPECT_GT(toldOf(falling), 100.0);
  EXPECT_GT(toldOf(thrown(0.0, 3.0)), 1.0);
  EXPECT_EQ(toldOf(thrown(0.0, 0.0)), 0.0);
}

TEST(RoundingTest, TellsNoneWhereALossOrShortDistancesKeepItSmall) {
  const Certified lossy(prestressed(1.0, 1.0));
  EXPECT_EQ(toldOf(lossy), 0.0);
  EXPECT_LT(lossy.fastestOf(10.0, Precision::kFloat), 0.15);
  EXPECT_EQ(toldOf(Certified(prestressed(0.01, 0.0))), 0.0);
}

}  // namespace
}  // namespace ergotic::physics
