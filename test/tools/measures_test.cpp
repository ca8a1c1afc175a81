// SPDX-License-Identifier: BSD-3-Clause
// What is measured of sounds that are known exactly.
#include "tools/lib/measures.hpp"

#include <random>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "support/measure.hpp"
#include "support/test.hpp"

namespace ergotic::tools {
namespace {

constexpr double kRate = 44100.0;

/// Adds A e^(-6.91 t/T60) cos(2 pi f t + phase).
void add(Sound& sound, double hz, double amplitude, double t60_s, double phase = 0.3) {
  for (std::size_t n = 0; n < sound.samples.size(); ++n) {
    const double t = static_cast<double>(n) / kRate;
    sound.samples[n] +=
        amplitude * std::pow(1000.0, -t / t60_s) * std::cos(2.0 * kPi * hz * t + phase);
  }
}

Sound silence(double seconds) {
  return {std::vector<double>(static_cast<std::size_t>(seconds * kRate)), kRate};
}

TEST(LineTest, IsWhereItIsAlsoIfItDecays) {
  for (const double hz : {31.7, 110.123, 440.0, 997.31, 4186.01, 12345.6}) {
    for (const double t60 : {0.2, 3.0, 1e9}) {  // what is short reaches over to its mirror
      Sound sound = silence(1.1);
      add(sound, hz, 0.5, t60);
      const Line line = lineNear(sound, 0.05, 1.0, hz * 1.004, 0.03);
      EXPECT_NEAR(cents(line.hz, hz), 0.0, t60 < 1.0 ? 0.1 : 1e-3) << hz << " " << t60;
    }
  }
}

TEST(LineTest, IsToldFromWhatIsLouderBesideIt) {
  Sound sound = silence(1.1);
  add(sound, 440.0, 0.01, 5.0);
  add(sound, 880.7, 1.0, 2.0);
  add(sound, 452.0, 0.005, 1e9);
  const Line line = lineNear(sound, 0.0, 1.0, 441.0, 0.02);
  EXPECT_NEAR(cents(line.hz, 440.0), 0.0, 0.05);
}

TEST(LineTest, HasTheAmplitudeOfWhatDoesNotDecay) {
  Sound sound = silence(1.1);
  add(sound, 523.25, 0.37, 1e12);
  EXPECT_NEAR(lineNear(sound, 0.0, 1.0, 520.0, 0.03).amplitude, 0.37, 1e-5);
}

TEST(LineTest, RefusesSilenceAndWhatIsTooShort) {
  EXPECT_THROW(lineNear(silence(1.0), 0.0, 0.9, 440.0, 0.03), Exception);
  EXPECT_THROW(lineNear(silence(1.0), 0.5, 0.9, 440.0, 0.03), Exception);
}

TEST(DecayTest, IsThatOfAnExponential) {
  for (const double t60 : {0.3, 1.0, 4.0, 12.0}) {
    Sound sound = silence(0.6 * t60 + 0.6);
    add(sound, 440.0, 1.0, t60);
    EXPECT_NEAR(decayOf(sound, 0.0, 0.0), t60, 2e-3 * t60);
    EXPECT_NEAR(decayOf(sound, 0.0, 440.0), t60, 1e-4 * t60);
  }
}

TEST(DecayTest, OfALineKnowsNothingOfOthers) {
  Sound sound = silence(4.0);
  add(sound, 440.0, 0.1, 1.5);
  add(sound, 880.0, 1.0, 6.0);
  add(sound, 220.0, 1.0, 9.0);
  EXPECT_NEAR(decayOf(sound, 0.05, 440.0), 1.5, 2e-3 * 1.5);
}

TEST(DecayTest, OfNoiseThatDecaysIsThatOfItsPower) {
  Sound sound = silence(2.5);
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  for (std::size_t n = 0; n < sound.samples.size(); ++n) {
    sound.samples[n] = noise(random) * std::pow(1000.0, -static_cast<double>(n) / kRate / 2.0);
  }
  EXPECT_NEAR(decayOf(sound, 0.0, 0.0), 2.0, 0.03 * 2.0);
}

TEST(DecayTest, RefusesWhatDoesNotDecay) {
  Sound sound = silence(2.0);
  add(sound, 440.0, 1.0, 1e9);
  EXPECT_THROW(decayOf(sound, 0.0, 0.0), Exception);
  EXPECT_THROW(decayOf(sound, 0.0, 440.0), Exception);
  EXPECT_THROW(decayOf(sound, 1.99, 440.0), Exception);
}

TEST(PolesTest, TellTwoThatBeat) {
  for (const double apart : {0.3, 1.0, 4.0}) {
    Sound sound = silence(std::max(1.0, 3.0 / apart));
    add(sound, 440.0, 1.0, 8.0);
    add(sound, 440.0 + apart, 0.6, 6.0, 1.0);
    add(sound, 880.3, 2.0, 3.0);
    const std::vector<Pole> poles = polesNear(sound, 0.02, 441.0, 2);
    EXPECT_NEAR(poles[1].hz - poles[0].hz, apart, 1e-3 * apart);
    EXPECT_NEAR(poles[0].t60_s, 8.0, 0.01 * 8.0);
    EXPECT_NEAR(poles[1].t60_s, 6.0, 0.01 * 6.0);
  }
}

TEST(PolesTest, TellTwoDecaysAtOnePitch) {
  Sound sound = silence(6.0);
  add(sound, 261.6, 1.0, 1.5);
  add(sound, 261.6, 0.1, 9.0, 1.2);
  std::vector<Pole> poles = polesNear(sound, 0.02, 261.6, 2);
  std::sort(poles.begin(), poles.end(),
            [](const Pole& a, const Pole& b) { return a.t60_s < b.t60_s; });
  EXPECT_NEAR(poles[0].t60_s, 1.5, 0.01 * 1.5);
  EXPECT_NEAR(poles[1].t60_s, 9.0, 0.01 * 9.0);
}

TEST(CentroidTest, IsTheMeanOfTheEnergy) {
  Sound sound = silence(0.2);
  add(sound, 500.0, 1.0, 1e9);
  add(sound, 3000.0, 0.5, 1e9);
  EXPECT_NEAR(centroidAt(sound, 0.05), (500.0 + 0.25 * 3000.0) / 1.25, 2.0);
  EXPECT_THROW(centroidAt(sound, 0.19), Exception);
  EXPECT_THROW(centroidAt(silence(0.2), 0.0), Exception);
}

TEST(LevelTest, IsWhatIsLeftOfTheHighest) {
  Sound sound = silence(1.0);
  sound.samples[100] = -2.0;
  sound.samples[30000] = 0.02;
  EXPECT_NEAR(levelAfter(sound, 0.5), 0.01, 1e-15);
  EXPECT_EQ(levelAfter(sound, 0.9), 0.0);
  EXPECT_THROW(levelAfter(silence(1.0), 0.5), Exception);
}

TEST(BelowTest, IsTheLongestTimeBetweenSamples) {
  // Half a sample before 2, a quarter behind 4; then a shorter one.
  EXPECT_NEAR(longestBelow({1.0, 1.0, -1.0, -1.0, -1.0, 3.0, -3.0, 1.0}, 10.0), 0.1 * 2.75, 1e-12);
  EXPECT_THROW(longestBelow({1.0, 1.0}, 10.0), Exception);
  EXPECT_THROW(longestBelow({1.0, -1.0}, 10.0), Exception);
}

}  // namespace
}  // namespace ergotic::tools
