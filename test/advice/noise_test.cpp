// SPDX-License-Identifier: BSD-3-Clause
// What the noise of the sensors comes back as, predicted and played.
#include "ergotic/advice/noise.hpp"

#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

using test::kRates;
using test::Player;

constexpr double kWithin = 0.03;  // of the predicted rms

/// A key on a wall, at the gestural or the audio rate.
scene::Scene wall(const std::string& port, const std::string& rate = "gestural") {
  return scene::readYaml(
      "ergotic: 1\ngestural_rate: 3150\n"
      "sections: {hand: {rate: gestural}, wall: {rate: " +
          rate +
          "}}\n"
          "mats: {key: {type: slice, section: hand}, wall: {type: ground, section: wall}}\n"
          "lias: {wall: {type: spring_damper, between: [key, wall], stiffness: 800, damping: "
          "0.3}}\n"
          "ports: {key: {mat: key, slice: 0" +
          port + "}}\n",
      "wall.yaml");
}

struct Played {
  double force = 0.0;   // N rms at the device
  double behind = 0.0;  // m rms of the module behind the filter, at the device
};

Played play(const scene::Scene& scene, double rms, int ticks = 60000) {
  Player player(scene, kRates);
  const scene::Port& port = scene.ports[0];
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, rms);
  std::vector<float> displacements(static_cast<std::size_t>(scene.coordinates()));
  const auto seen = static_cast<std::size_t>(port.filter >= 0 ? port.filter : port.mat);
  double force2 = 0.0;
  double behind2 = 0.0;
  for (int n = -2000; n < ticks; ++n) {
    player.positions[0] = noise(random) / port.position_scale;
    player.tick();
    if (n >= 0) {
      player.instrument->readDisplacements(displacements.data());
      const double behind = port.position_scale * static_cast<double>(displacements[seen]);
      force2 += player.forces[0] * player.forces[0] * port.force_scale * port.force_scale;
      behind2 += behind * behind;
    }
  }
  return {std::sqrt(force2 / ticks), std::sqrt(behind2 / ticks)};
}

TEST(NoiseTest, RoundingAddsATwelfthOfItsSquare) {
  EXPECT_DOUBLE_EQ((SensorNoise{0.0, 1.2e-6}.total()), 1.2e-6 / std::sqrt(12.0));
  EXPECT_DOUBLE_EQ((SensorNoise{3e-6, 4e-6 * std::sqrt(12.0)}.total()), 5e-6);
}

TEST(NoiseTest, WithoutAFilterTheForceIsThatOfTheLinks) {
  const NoiseFloor floor = noiseFloors(wall(""), kRates, {1e-6, 0.0}).at(0);
  const double viscous = 0.3 * 3150.0;
  EXPECT_NEAR(floor.force, 1e-6 * std::hypot(800.0 + viscous, viscous), 1e-15);
  EXPECT_EQ(floor.unfiltered, floor.force);
  EXPECT_EQ(floor.behind, 1e-6);
  EXPECT_EQ(floor.position, 1e-6);
}

TEST(NoiseTest, ForceOfWhiteNoiseIsAsPredicted) {
  for (const std::string rate : {"gestural", "audio"}) {
    for (const std::string port :
         {"", ", position_scale: 0.25, force_scale: 4",
          ", filter: {mass: 0.002, frequency: 150, damping_ratio: 0.7}",
          ", filter: {mass: 0.02, frequency: 60, damping_ratio: 0.2}, force_scale: 3",
          ", filter: {mass: 0.002, frequency: 150, section: wall}",
          ", filter: {mass: 0.01, frequency: 90, damping_ratio: 0.1, section: wall}"}) {
      scene::Scene scene = wall(port, rate);
      for (const auto coupling : {scene::Coupling::kHold, scene::Coupling::kSmooth}) {
        scene.mats[static_cast<std::size_t>(scene.ports[0].mat)].coupling = coupling;
        const NoiseFloor floor = noiseFloors(scene, kRates, {2e-6, 0.0}).at(0);
        const Played played = play(scene, 2e-6);
        EXPECT_NEAR(played.force, floor.force, kWithin * floor.force) << rate << port;
        EXPECT_NEAR(played.behind, floor.behind, kWithin * floor.behind) << rate << port;
      }
    }
  }
}

TEST(NoiseTest, AFilterIsALowPassOfSecondOrderForWhatIsBehind) {
  scene::Scene scene = wall(", filter: {mass: 0.005, frequency: 20, damping_ratio: 0.5}");
  scene.lias[0].stiffness = scene.lias[0].damping = {};
  const NoiseFloor floor = noiseFloors(scene, kRates).at(0);
  // In continuous time its band is pi/2 f (1/(2 z) + 2 z) wide, of half the tick rate.
  const double band = 0.5 * 3.14159265358979323846 * 20.0 * (1.0 + 1.0);
  EXPECT_NEAR(floor.behind / floor.position, std::sqrt(band / 1575.0), 0.02);
  EXPECT_EQ(floor.unfiltered, 0.0);
}

TEST(NoiseTest, ASofterFilterBeforeAStiffWallGivesLessForceNoise) {
  scene::Scene scene = wall(", filter: {mass: 0.001, frequency: 100, damping_ratio: 0.2}");
  scene.lias[0].stiffness = {4000.0};
  const NoiseFloor floor = noiseFloors(scene, kRates).at(0);
  EXPECT_LT(floor.force, 0.6 * floor.unfiltered);
}

TEST(NoiseTest, AFilterThatIsNotDampedOrNotStableHasNoFloor) {
  scene::Scene scene = wall(", filter: {mass: 0.002, frequency: 150, damping_ratio: 0}");
  scene.lias[0].damping = {};
  EXPECT_TRUE(std::isinf(noiseFloors(scene, kRates).at(0).force));
  scene = wall(", filter: {mass: 1e-6, frequency: 150}");
  EXPECT_TRUE(std::isinf(noiseFloors(scene, kRates).at(0).force));
  EXPECT_EQ(certify(settle(scene, kRates).scene, kRates).verdict, Verdict::kUnstable);
}

TEST(NoiseTest, InAPlaneAFilterDoesNotGoOnCircling) {
  Player player(
      scene::readYaml(
          "ergotic: 1\nsections: {hand: {rate: gestural, geometry: plane}}\n"
          "mats: {key: {type: slice}}\n"
          "ports: {x: {mat: key, filter: {mass: 0.01, frequency: 50, damping_ratio: 0.1}},\n"
          "        y: {mat: key, axis: y}}\n",
          "plane.yaml"),
      kRates);
  const auto play = [&player](int ticks, double radius) {
    double force = 0.0;
    for (int n = 0; n < ticks; ++n) {
      const double angle = 2.0 * 3.14159265358979323846 * 50.0 * n / kRates.gesturalHz();
      player.positions = {radius * std::cos(angle), radius * std::sin(angle)};
      player.tick();
      force = std::hypot(player.forces[0], player.forces[1]);
    }
    return force;
  };
  // At resonance it goes 1/(2 z) as far, a quarter of a turn behind.
  const double stiffness = 0.01 * std::pow(2.0 * 3.14159265358979323846 * 50.0, 2.0);
  EXPECT_NEAR(play(3000, 1e-3), 5.1 * stiffness * 1e-3, 0.1 * 5.1 * stiffness * 1e-3);
  EXPECT_LT(play(3000, 0.0), 1e-6 * stiffness * 1e-3);
}

TEST(NoiseTest, AHandMeetsTheFilterAndWhatIsBehindInSeries) {
  const double omega = 2.0 * 3.14159265358979323846 * 150.0;
  scene::Scene scene = wall(", filter: {mass: 0.002, frequency: 150}");
  const double attached = 0.002 * omega * omega;
  EXPECT_NEAR(certify(scene, kRates).ports.at(0).stiffness, 1.0 / (1.0 / attached + 1.0 / 800.0),
              1e-9);
  scene.lias.push_back(scene.lias[0]);  // two links behind it side by side
  EXPECT_NEAR(certify(scene, kRates).ports.at(0).stiffness, 1.0 / (1.0 / attached + 1.0 / 1600.0),
              1e-9);
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive);
}

}  // namespace
}  // namespace ergotic::physics
