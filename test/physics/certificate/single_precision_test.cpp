// SPDX-License-Identifier: BSD-3-Clause
// Scenes whose numbers single precision does not hold.
#include <string>
#include <tuple>
#include <utility>

#include "physics/certificate/certified_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

TEST(SinglePrecisionTest, NumbersThatSinglePrecisionDoesNotHoldAreRefused) {
  const auto contact = [](const char* stiffness, const char* mass) {
    return kOfAudio + "  m: {type: mass, mass: " + mass + ", x: 0.001, v: -1}\nlias:\n" +
           "  c: {type: contact, between: [g, m], stiffness: " + stiffness + "}\n" +
           "  s: {type: spring, between: [g, m], stiffness: 1e-20}\n" +
           "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n";
  };
  EXPECT_THAT(
      complaintOf([&] { const Certified none(contact("1e39", "0.01")); }),
      HasSubstr("'stiffness' of link 'c' = 1e+39 N/m is out of range, allowed: >= 0 N/m, up "
                "to 1e30 in size"));
  EXPECT_FALSE(Certified(contact("1e30", "1e-12")).isCertified());
  EXPECT_THAT(
      complaintOf([&] { const Certified none(contact("1", "1e-48")); }),
      HasSubstr(
          "'mass' of module 'm' = 1e-48 kg is out of range, allowed: > 0 kg, at least 1e-30"));
  const Certified largest(contact("1e30", "0.01"));
  EXPECT_TRUE(largest.isCertified());
  EXPECT_LT(largest.fastestOf(1.0, Precision::kFloat), 10.0);
}

TEST(SinglePrecisionTest, ForcesThatSinglePrecisionDoesNotHoldAreNotCertified) {
  const auto far = [](const char* x) {
    return Certified(kOfAudio + "  m: {type: mass, mass: 1e29, x: " + x +
                     "}\nlias:\n  k: {type: spring, between: [g, m], stiffness: 1e30}\n"
                     "outputs: {o: {at: m, quantity: position, channel: 1}}\n");
  };
  EXPECT_FALSE(far("1e10").isCertified());
  EXPECT_TRUE(far("1e5").isCertified());
  EXPECT_LT(far("1e5").fastestOf(2.0, Precision::kFloat), 1.1e5);
}

TEST(SinglePrecisionTest, NorAreNumbersOfLawsThatComeToSuchForces) {
  const auto link = [](const std::string& law) {
    return Certified(
        "ergotic: 1\nsections: {a: {rate: audio}}\nmats:\n  g: {type: ground}\n"
        "  m: {type: mass, mass: 0.01, x: 1e-3, v: 1}\nlias:\n"
        "  k: {type: spring_damper, between: [m, g], stiffness: 1000, damping: 0.01}\n"
        "  l: {between: [m, g], " +
        law + "}\noutputs: {o: {at: m, quantity: velocity, channel: 1}}\n");
  };
  for (const auto& [usual, far] :
       {std::pair("type: contact, stiffness: 1e4, threshold: 1e3",
                  "type: contact, stiffness: 1e4, threshold: 1e19"),
        std::pair("type: power_contact, stiffness: 1e6, exponent: 2.5, threshold: 1",
                  "type: power_contact, stiffness: 1e6, exponent: 2.5, threshold: 1e12"),
        std::pair("type: power_contact, stiffness: 1e9, exponent: 2.5, threshold: 1e-3",
                  "type: power_contact, stiffness: 1e27, exponent: 2.5, threshold: 1e-3"),
        std::pair("type: felt, stiffness: 1e6, exponent: 2.5, damping: 1e2, threshold: 1e-3",
                  "type: felt, stiffness: 1e6, exponent: 2.5, damping: 1e27, threshold: 1e-3"),
        std::pair("type: pluck, stiffness: 1000, width: 1e3",
                  "type: pluck, stiffness: 1000, width: 1e20")}) {
    EXPECT_TRUE(link(usual).isCertified()) << usual;
    EXPECT_TRUE(std::isfinite(link(usual).fastestOf(0.1, Precision::kFloat))) << usual;
    EXPECT_FALSE(link(far).isCertified()) << far;
  }
}

/// What comes to numbers that single precision does not hold, though it begins at 0.
TEST(SinglePrecisionTest, NorDoesItHelpToBeginWhereALawIsFlat) {
  const auto scene = [](const std::string& mass, const std::string& link) {
    return Certified(kOfAudio + "  m: {type: mass, " + mass + "}\nlias:\n" + link +
                     "outputs: {o: {at: m, quantity: velocity, channel: 1}}\n");
  };
  const std::string held =
      "  k: {type: spring_damper, between: [m, g], stiffness: 1000, damping: 0.01}\n";
  for (const auto& [mass, usual, far] :
       {std::tuple("mass: 0.01, v: 1",
                   held + "  l: {type: felt, between: [m, g], stiffness: 1e6, exponent: 2.5, "
                          "damping: 1e2}\n",
                   held + "  l: {type: felt, between: [m, g], stiffness: 1e6, exponent: 2.5, "
                          "damping: 1e27}\n"),
        std::tuple("mass: 1e-20, v: 1e10",
                   std::string("  l: {type: cubic, between: [m, g], stiffness: 0, nonlinearity: "
                               "1e-20, tank: t}\n"),
                   std::string("  l: {type: cubic, between: [m, g], stiffness: 0, nonlinearity: "
                               "1e30, tank: t}\n")),
        std::tuple("mass: 0.01",
                   std::string("  l: {type: table, between: [m, g], elastic: {points: [[-1e-6, "
                               "-1e4], [0, 0], [1e-6, 2e4]], interpolation: monotone}}\n"),
                   std::string("  l: {type: table, between: [m, g], elastic: {points: [[-1e-12, "
                               "-1e4], [0, 0], [1e-12, 2e4]], interpolation: monotone}}\n")),
        std::tuple("mass: 1, v: 1e14",
                   std::string("  k: {type: spring, between: [m, g], stiffness: 1e8}\n"),
                   std::string("  k: {type: spring, between: [m, g], stiffness: 1e8}\n  l: {type: "
                               "felt, between: [g, m], stiffness: 1e-38, exponent: 4.9, damping: "
                               "1e-17}\n")),
        std::tuple("mass: 1e-3, v: -1e10",
                   std::string("  l: {type: contact, between: [g, m], stiffness: 1e4}\n"),
                   std::string("  l: {type: contact, between: [g, m], stiffness: 1e30}\n"))}) {
    EXPECT_TRUE(scene(mass, usual).isCertified()) << usual;
    EXPECT_TRUE(std::isfinite(scene(mass, usual).fastestOf(0.1, Precision::kFloat))) << usual;
    EXPECT_FALSE(scene(mass, far).isCertified()) << far;
  }
}

TEST(SinglePrecisionTest, NorWhereASectionIsFarAway) {
  const auto apart = [](const std::string& metres) {
    return Certified(
        "ergotic: 1\nsections:\n  a: {rate: audio, geometry: space}\n"
        "  b: {rate: audio, geometry: space, pose: {position: [" +
        metres +
        ", 0, 0]}}\nmats:\n  m: {type: mass, section: a, mass: 1, v: [1, 0, 0]}\n"
        "  g: {type: ground, section: b}\nlias: {l: {type: spring, between: [m, g], stiffness: 1, "
        "rest_length: 0.01}}\noutputs: {o: {at: m, quantity: velocity, channel: 1}}\n");
  };
  EXPECT_TRUE(apart("1").isCertified());
  EXPECT_FALSE(apart("1e20").isCertified());
}

TEST(SinglePrecisionTest, ACurveOfFrictionMayBeAsNarrowAsNumbersGo) {
  for (const char* const width : {"1e-6", "1e-21", "1e-30"}) {
    const Certified narrow(
        std::string("ergotic: 1\nsections: {a: {geometry: plane}}\nmats:\n  g: {type: ground}\n"
                    "  m: {type: mass, mass: 0.01, at: [1e-3, 2e-3], v: [1, -1]}\nlias:\n"
                    "  k: {type: spring_damper, between: [m, g], stiffness: 1000, damping: 0}\n"
                    "  l: {type: smooth_bow, damping: 1, between: [m, g], width: ") +
        width + "}\noutputs: {o: {at: m, quantity: velocity, channel: 1}}\n");
    EXPECT_LT(narrow.fastestOf(0.2, Precision::kFloat), 2.0) << width;
  }
}

TEST(SinglePrecisionTest, NorIsWhatMovesTooFast) {
  const auto moving = [](const std::string& geometry, const std::string& mass,
                         const std::string& link) {
    return Certified("ergotic: 1\nsections: {a: {geometry: " + geometry +
                     "}}\nmats:\n  g: {type: ground}\n  m: {type: mass, mass: " + mass +
                     "}\nlias:\n  k: {between: [g, m], " + link +
                     "}\noutputs: {o: {at: m, quantity: position, channel: 1}}\n");
  };
  const std::string spring = "type: spring, stiffness: 1e30";
  const Certified fast = moving("scalar", "1e24, v: 1e17", spring);
  Player player(compile(fast.scene, fast.rates, Precision::kFloat));
  player.tick();
  EXPECT_FALSE(std::isfinite(player.heard.at(0).back()));
  EXPECT_FALSE(fast.isCertified());
  EXPECT_TRUE(moving("scalar", "1e24, v: 1e7", spring).isCertified());
  EXPECT_FALSE(moving("scalar", "1e22, v: 1e20", "type: damper, damping: 1e20").isCertified());
  EXPECT_FALSE(moving("line", "1, v: 1e24", "type: spring, stiffness: 1e4").isCertified());
  EXPECT_TRUE(moving("line", "1, v: 1e6", "type: spring, stiffness: 1e4").isCertified());
  const std::string contact = "type: contact, stiffness: ";
  EXPECT_FALSE(moving("scalar", "1, v: 1e24", contact + "1e4").isCertified());
  EXPECT_FALSE(moving("scalar", "1e20, x: 1e9", contact + "1e30").isCertified());
  EXPECT_TRUE(moving("scalar", "1, v: 1e6", contact + "1e4").isCertified());
}

TEST(SinglePrecisionTest, NorIsWhatFallsTooFarOrIsPushedTooHard) {
  const auto pulled = [](const std::string& section, const std::string& link,
                         const std::string& gain) {
    return Certified("ergotic: 1\nsections: {a: {" + section +
                     "}}\nmats:\n  g: {type: ground}\n  m: {type: mass, mass: 0.01}\nlias:\n"
                     "  k: {between: [g, m], " +
                     link + "}\ninputs: {i: {mat: m, quantity: force, channel: 1, gain: " + gain +
                     "}}\noutputs: {o: {at: m, quantity: position, channel: 1}}\n");
  };
  const std::string cubic = "type: cubic, stiffness: 1000, nonlinearity: 1e6";
  const Certified falling = pulled("gravity: -1e29", cubic, "1");
  Player player(compile(falling.scene, falling.rates, Precision::kFloat));
  player.ticks(2);
  EXPECT_FALSE(std::isfinite(player.heard.at(0).back()));
  EXPECT_FALSE(falling.isCertified());
  EXPECT_FALSE(pulled("gravity: 0", cubic, "1e28").isCertified());
  EXPECT_TRUE(pulled("gravity: -9.81", cubic, "1000").isCertified());
  const std::string held = "type: contact, stiffness: 1000";
  EXPECT_FALSE(pulled("geometry: line, gravity: -1e20", held, "1").isCertified());
  EXPECT_TRUE(pulled("geometry: line, gravity: -9.81", held, "1000").isCertified());
}

}  // namespace
}  // namespace ergotic::physics
