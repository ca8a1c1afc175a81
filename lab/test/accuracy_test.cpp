// SPDX-License-Identifier: BSD-3-Clause
// What is foretold against what is measured, in every setting of the chart.
#include "lab/lib/accuracy.hpp"

#include <map>

#include "ergotic/advice/accuracy.hpp"
#include "support/test.hpp"

namespace ergotic::tools {
namespace {

using physics::ContactFigure;
using scene::Scheme;

/// Relative error of a measurement.
double errorOf(const Measurement& m) {
  return m.unit == "cents" ? std::exp2(m.error / 1200.0) - 1.0 : m.error / 100.0;
}

bool isFloat(const Measurement& m) {
  return m.precision == physics::Precision::kFloat;
}

std::string describe(const Measurement& m) {
  return m.family + ", " + m.measure + ", " + std::to_string(m.rates.audio_hz) +
         " Hz, R = " + std::to_string(m.rates.ratio) + ", masses " + std::to_string(m.masses) +
         ", exponent " + std::to_string(m.exponent) + (isFloat(m) ? ", float" : ", double");
}

TEST(AccuracyTest, StringsAreAsWrongAsForetold) {
  int settings = 0;
  int refused = 0;
  measureStrings([&](const Measurement& m) {
    if (m.error == kNotPlayed) {
      EXPECT_GT(m.masses, 100) << "only the finest are too stiff: " << describe(m);
      ++refused;
      return;
    }
    const scene::StringCut cut{m.masses, m.family == "coarse"};
    const double foretold = physics::stringError(cut, 110.0 / m.rates.audio_hz, true);
    const double foretold_cents = 1200.0 * std::log2(1.0 + foretold);
    // A flat partial is foretold as a share, not as a ratio of frequencies.
    EXPECT_NEAR(m.error, foretold_cents, 0.02 + 0.1 * m.error) << describe(m);
    if (!cut.coarse) {
      EXPECT_EQ(m.cost.steps, m.rates.audio_hz * (2.0 * m.masses + 1.0)) << describe(m);
    }
    EXPECT_GT(m.cost.cpu_s, 0.0) << describe(m);
    ++settings;
  });
  EXPECT_GT(settings, 60);
  EXPECT_GT(refused, 0);
}

TEST(AccuracyTest, ContactsAreAsWrongAsForetold) {
  int settings = 0;
  measureBarriers([&](const Measurement& m) {
    if (m.measure == "rebound") {
      return;
    }
    const double steps = 1e-3 * m.rates.audio_hz;
    const ContactFigure figure =
        m.measure == "duration" ? ContactFigure::kDuration : ContactFigure::kPeakForce;
    const Scheme scheme = m.family == "energy_stable" ? Scheme::kEnergyStable : Scheme::kExplicit;
    const double foretold = physics::contactError(figure, scheme, m.exponent, steps);
    const double rounding = isFloat(m) ? physics::kFloatPitchError : 1e-12;
    EXPECT_LT(errorOf(m), 2.0 * foretold + rounding) << describe(m);
    EXPECT_GT(errorOf(m), foretold / 3.0 - rounding) << describe(m);
    ++settings;
  });
  EXPECT_GT(settings, 100);
}

TEST(AccuracyTest, BowsAreNoWorseThanForetold) {
  bool is_close = false;
  measureBows([&](const Measurement& m) {
    if (m.error == kNotPlayed) {
      return;
    }
    const bool is_stable = m.family.find("energy_stable") != std::string::npos;
    const double pitch_hz = m.family.find("string") != std::string::npos ? 196.0 : 143.0;
    const double foretold = physics::bowError(is_stable ? Scheme::kEnergyStable : Scheme::kExplicit,
                                              m.rates.audio_hz / pitch_hz);
    EXPECT_LT(errorOf(m), 1.5 * foretold) << describe(m);
    is_close = is_close || (!is_stable && errorOf(m) > 0.8 * foretold);
  });
  EXPECT_TRUE(is_close) << "the bound is near what is measured of explicit bows";
}

TEST(AccuracyTest, HeldHammersAreAsWrongAsForetold) {
  constexpr double kContactS = 0.0106;
  int settings = 0;
  measureHammers([&](const Measurement& m) {
    if (m.measure != "whole sound" || m.rates.ratio == 1) {
      return;
    }
    const double slow_steps = kContactS * m.rates.gesturalHz();
    const double foretold = physics::heldContactError(m.family == "chaplet", slow_steps);
    EXPECT_LT(errorOf(m), 1.5 * foretold + physics::kFloatSoundError) << describe(m);
    EXPECT_GT(errorOf(m), foretold / 1.5 - physics::kFloatSoundError) << describe(m);
    ++settings;
  });
  EXPECT_GT(settings, 5);
}

TEST(AccuracyTest, HandsThatGlideSoundAsIfTheyMovedInEveryFrame) {
  std::map<std::string, double> worst;  // by coupling
  measureHands([&](const Measurement& m) { worst[m.family] = std::max(worst[m.family], m.error); });
  EXPECT_LT(worst["smooth"], 0.1);
  EXPECT_GT(worst["hold"], 1.0);
  EXPECT_GT(worst["chaplet"], 1.0);
}

TEST(AccuracyTest, WallsAreAsStiffAsTheCertificateSays) {
  double played = 0.0;
  int walls = 0;
  measureWalls([&](const Measurement& m) {
    if (m.family == "played") {
      played = m.error;
    } else {
      EXPECT_NEAR(m.error / played, 1.0, 0.01) << describe(m);
      ++walls;
    }
  });
  EXPECT_EQ(walls, 14);
}

TEST(AccuracyTest, ImpossibleStringsHaveNoError) {
  EXPECT_TRUE(std::isinf(physics::stringError({9, false}, 0.001, true))) << "no tenth partial";
  EXPECT_TRUE(std::isinf(physics::stringError({40, false}, 0.06, true))) << "above half the rate";
  EXPECT_TRUE(std::isinf(physics::stringError({40, true}, 0.03, true))) << "not to be fitted";
  EXPECT_TRUE(std::isinf(physics::stringError({400, false}, 110.0 / 44100.0, true))) << "unstable";
}

}  // namespace
}  // namespace ergotic::tools
