// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/generate/pitch.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {
namespace {

Scene stringScene(const std::string& fields, const std::string& section = "") {
  return readYaml("ergotic: 1\nparameters: {p: {value: 2, range: [1, 3]}}\nsections: {a: {" +
                      section + "}}\ngenerators: [{type: string, name: s, to: [1, 0], " + fields +
                      "}]\n",
                  "string.yaml");
}

using Places = std::vector<Eigen::Vector3d>;

/// Forces of all links on all modules, written out from the laws.
Places linkForces(const Scene& scene, const Places& x, const Places& before, double h) {
  const bool scalar = scene.sections[0].geometry == Geometry::kScalar;
  Places forces(x.size(), Eigen::Vector3d::Zero());
  for (const Lia& lia : scene.lias) {
    const auto a = static_cast<std::size_t>(lia.a);
    const auto b = static_cast<std::size_t>(lia.b);
    const Eigen::Vector3d apart = x[a] - x[b];
    const Eigen::Vector3d apart_before = before[a] - before[b];
    const double length = scalar ? apart.x() : apart.norm();
    const double slip = length - (scalar ? apart_before.x() : apart_before.norm());
    const double force = scene.valueOf(lia.stiffness) * (length - lia.rest_length) +
                         scene.valueOf(lia.damping) / h * slip;
    const Eigen::Vector3d along = scalar ? Eigen::Vector3d(1.0, 0.0, 0.0) : apart / length;
    forces[a] -= force * along;
    forces[b] += force * along;
  }
  return forces;
}

/// Steps the string from the shape of its first mode, across it where it can move so; the pitch
/// from x[n-1], x[n], x[n+1] and x[n+2] of one mass, which obey x[n+1] = p x[n] - q x[n-1] when one
/// mode moves alone.
double steppedPitchHz(const Scene& scene, const StringInfo& s, double rate_hz) {
  const double h = 1.0 / (rate_hz * scene.time_unit_s);
  const double m = scene.valueOf(s.mass);
  const double y = scene.valueOf(s.loss) + scene.valueOf(scene.sections[0].medium);
  const bool first_order = scene.mats[1].type == MatType::kCell && !scene.mats[1].matched;
  const double keep = first_order ? 1.0 - y * h / m : std::exp(-y * h / m);
  const int axis = dimensionsOf(scene.sections[0].geometry) > 1 ? 1 : 0;
  const auto count = static_cast<std::size_t>(s.count);
  Places x;
  for (std::size_t i = 0; i < count; ++i) {
    x.push_back(scene.mats[i].position);
    x.back()[axis] +=
        1e-5 * std::sin(M_PI * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  Places before = x;
  std::vector<double> seen;
  for (int n = 0; n < 4; ++n) {
    seen.push_back(x[count / 2][axis] - scene.mats[count / 2].position[axis]);
    const Places forces = linkForces(scene, x, before, h);
    Places next = x;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      next[i] += keep * (x[i] - before[i]) + h * h / m * forces[i];
    }
    before = x;
    x = next;
  }
  const double determinant = seen[1] * seen[1] - seen[0] * seen[2];
  const double p = (seen[1] * seen[2] - seen[0] * seen[3]) / determinant;
  const double q = (seen[2] * seen[2] - seen[1] * seen[3]) / determinant;
  return std::acos(p / (2.0 * std::sqrt(q))) / (2.0 * M_PI) * rate_hz;
}

void expectSteppedPitch(const Scene& scene, double rate_hz) {
  const double stepped = steppedPitchHz(scene, scene.strings[0], rate_hz);
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], rate_hz), stepped, 1e-6 * stepped)
      << scene.text;
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
                             "masses: 12, mass: 2e-4, frequency: 440, damping: 2e-3, loss: 0.3",
                             "masses: 3, mass: 1e-3*$p, stiffness: 500*$p, loss: 0.1*$p"}) {
    for (const char* section : {"", "medium: 0.1*$p"}) {
      Scene scene = stringScene(fields, section);
      expectSteppedPitch(scene, 20000.0);
      expectSteppedPitch(scene, 44100.0);
      for (Mat& mat : scene.mats) {
        mat.matched = false;
      }
      expectSteppedPitch(scene, 20000.0);
    }
  }
}

TEST(StringPitchTest, EqualsThePitchAcrossASteppedStringInAPlaneAndInSpace) {
  for (const char* section : {"geometry: plane", "geometry: space, medium: 0.1"}) {
    for (const char* ratio : {"0", "0.5", "0.9"}) {
      std::string to = section[10] == 's' ? ", from: [0, 0, 0], to: [1, 0, 0]" : ", to: [1, 0]";
      const Scene scene = readYaml(
          "ergotic: 1\nsections: {a: {" + std::string(section) +
              "}}\ngenerators: [{type: string, name: s, masses: 7, mass: 1e-3, stiffness: 2e5, "
              "damping: 0.01, loss: 0.02, rest_length_ratio: " +
              ratio + to + "}]\n",
          "string.yaml");
      expectSteppedPitch(scene, 20000.0);
    }
  }
}

TEST(StringPitchTest, EqualsThePitchAlongASteppedLine) {
  const Scene scene = readYaml(
      "ergotic: 1\nsections: {a: {geometry: line}}\ngenerators: [{type: string, name: s, masses: "
      "7, "
      "mass: 1e-3, stiffness: 2000, damping: 0.01, rest_length_ratio: 0.9, from: [0], to: [1]}]\n",
      "string.yaml");
  expectSteppedPitch(scene, 44100.0);
}

TEST(StringPitchTest, FrequencyOfAStringInAPlaneIsThatAcrossIt) {
  const Scene scene = stringScene("masses: 40, mass: 1e-4, frequency: 110, rest_length_ratio: 0.75",
                                  "geometry: plane");
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6), 110.0, 1e-5);
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
  const Scene slack =
      stringScene("masses: 3, mass: 1e-3, stiffness: 10, rest_length_ratio: 1", "geometry: plane");
  EXPECT_TRUE(std::isnan(stringPitchHz(slack, slack.strings[0], 44100.0)));
}

TEST(StringPitchTest, IsNoNumberBeforeACoarseStringIsFitted) {
  const Scene coarse = stringScene("masses: 20, mass: 1e-3, frequency: 110, coarse: true");
  EXPECT_TRUE(std::isnan(stringPitchHz(coarse, coarse.strings[0], 44100.0)));
}

}  // namespace
}  // namespace ergotic::scene
