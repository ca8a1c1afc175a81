// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/pitch.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "ergotic/scene/read_scene.hpp"

namespace ergotic::scene {
namespace {

Scene stringScene(const std::string& fields) {
  return readYaml(
      "ergotic: 1\nparameters: {p: {value: 2, range: [1, 3]}}\nsections: {a: {}}\n"
      "generators: [{type: string, name: s, to: [1, 0], " +
          fields + "}]\n",
      "string.yaml");
}

/// Steps the string from the shape of its first mode; the pitch from x[n-1], x[n], x[n+1] and
/// x[n+2] of one mass, which obey x[n+1] = p x[n] - q x[n-1] when one mode moves alone.
double steppedPitchHz(const Scene& scene, const StringInfo& s, double rate_hz) {
  const double h = 1.0 / (rate_hz * scene.time_unit_s);
  const double m = scene.valueOf(s.mass);
  const double k = scene.valueOf(s.stiffness);
  const double z = scene.valueOf(s.damping);
  const double y = scene.valueOf(s.loss);
  const auto count = static_cast<std::size_t>(s.count);
  std::vector<double> x(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    x[i] = std::sin(M_PI * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  std::vector<double> before = x;
  std::vector<double> seen;
  for (int n = 0; n < 4; ++n) {
    seen.push_back(x[count / 2]);
    std::vector<double> next(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const auto stretch = [i](const std::vector<double>& at) {
        return at[i - 1] - 2.0 * at[i] + at[i + 1];
      };
      const double slip = stretch(x) - stretch(before);
      const double force = k * stretch(x) + z / h * slip - y / h * (x[i] - before[i]);
      next[i] = 2.0 * x[i] - before[i] + h * h / m * force;
    }
    before = x;
    x = next;
  }
  const double determinant = seen[1] * seen[1] - seen[0] * seen[2];
  const double p = (seen[1] * seen[2] - seen[0] * seen[3]) / determinant;
  const double q = (seen[2] * seen[2] - seen[1] * seen[3]) / determinant;
  return std::acos(p / (2.0 * std::sqrt(q))) / (2.0 * M_PI) * rate_hz;
}

TEST(StringPitchTest, OneUndampedMassMovesAsTheClosedFormOfTheOscillator) {
  const Scene scene = stringScene("masses: 1, mass: 0.5, stiffness: 1000");
  const double h = 1.0 / 3000.0;
  // One mass on two springs: x[n+1] = (2 - 2 k h^2 / m) x[n] - x[n-1].
  const double expected = std::acos(1.0 - 1000.0 * h * h / 0.5) / (2.0 * M_PI * h);
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 3000.0), expected, 1e-9 * expected);
}

TEST(StringPitchTest, EqualsThePitchOfASteppedString) {
  for (const char* fields : {"masses: 5, mass: 1e-3, stiffness: 2000",
                             "masses: 12, mass: 2e-4, frequency: 440, damping: 2e-3, loss: 0.01",
                             "masses: 3, mass: 1e-3*$p, stiffness: 500*$p, loss: 0.1*$p"}) {
    const Scene scene = stringScene(fields);
    for (const double rate_hz : {20000.0, 44100.0}) {
      const double stepped = steppedPitchHz(scene, scene.strings[0], rate_hz);
      EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], rate_hz), stepped, 1e-6 * stepped)
          << fields;
    }
  }
}

TEST(StringPitchTest, ComesCloseToTheFrequencyAskedForAtAHighRate) {
  const Scene scene = stringScene("masses: 80, mass: 1e-4, frequency: 110");
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6), 110.0, 1e-5);
  EXPECT_GT(stringPitchHz(scene, scene.strings[0], 44100.0), 110.0);
}

TEST(StringPitchTest, CountsInTheTimeUnitOfTheScene) {
  Scene scene = stringScene("masses: 5, mass: 1e-3, stiffness: 2000, damping: 1e-2, loss: 1e-2");
  const double seconds = stringPitchHz(scene, scene.strings[0], 48000.0);
  scene.time_unit_s = 1.0 / 44100.0;
  scene.strings[0].stiffness.factor /= 44100.0 * 44100.0;
  scene.strings[0].damping.factor /= 44100.0;
  scene.strings[0].loss.factor /= 44100.0;
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 48000.0), seconds, 1e-9 * seconds);
}

TEST(StringPitchTest, FollowsTheParameterAsItIsNow) {
  Scene scene = stringScene("masses: 9, mass: 1e-3, stiffness: 500*$p");
  const double two = stringPitchHz(scene, scene.strings[0], 1e6);
  scene.parameters[0].value = 3.0;
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6) / two, std::sqrt(1.5), 1e-5);
}

TEST(StringPitchTest, IsNoNumberWhereNothingOscillates) {
  const Scene damped = stringScene("masses: 3, mass: 1e-3, stiffness: 10, loss: 1");
  EXPECT_TRUE(std::isnan(stringPitchHz(damped, damped.strings[0], 44100.0)));
  const Scene unstable = stringScene("masses: 1, mass: 1e-3, stiffness: 1e7");
  EXPECT_TRUE(std::isnan(stringPitchHz(unstable, unstable.strings[0], 44100.0)));
}

}  // namespace
}  // namespace ergotic::scene
