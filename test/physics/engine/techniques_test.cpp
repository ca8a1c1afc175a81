// SPDX-License-Identifier: BSD-3-Clause
// What models/lib has to play bodies with: each against a closed form.
#include <filesystem>
#include <set>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"

namespace ergotic::physics {
namespace {

constexpr double kGravity = 9.81;

scene::Scene sceneIncluding(const std::string& files, const std::string& text) {
  return scene::readYaml("ergotic: 1\ninclude: [" + files +
                             "]\nsections: {a: {}, k: {rate: gestural}, air: {gravity: -9.81}}\n" +
                             text,
                         test::repository("models/techniques_test.yaml"));
}

bool isCertified(const scene::Scene& open) {
  const Verdict verdict = certify(settle(open, kRates).scene, kRates).verdict;
  return verdict == Verdict::kPassive || verdict == Verdict::kBounded;
}

const char kWall[] = "mats: {wall: {type: ground, section: a}}\n";
const char kPush[] = "outputs: {f: {at: wall, quantity: force, channel: 1}}\n";

/// The first frame from `from` on that is not 0, the size if there is none.
std::size_t firstPush(const std::vector<double>& heard, std::size_t from = 0) {
  return static_cast<std::size_t>(std::find_if(heard.begin() + static_cast<std::ptrdiff_t>(from),
                                               heard.end(), [](double f) { return f != 0.0; }) -
                                  heard.begin());
}

/// m v^2/2 = K x^(p+1)/(p+1), and how long it takes to go there and back.
TEST(TechniquesTest, AHammerIsInContactAsLongAsItsFeltSays) {
  for (const double speed : {0.5, 2.0, 5.0}) {
    for (const double p : {1.5, 2.5, 3.0}) {
      const double mass = 0.003;
      const double stiffness = 1e4 * std::pow(1e3, p - 1.0);
      const scene::Scene scene = sceneIncluding(
          "lib/mallets.yaml", std::string(kWall) + kPush +
                                  "use: [{is: hammer, as: h, in: {s: a}, with: {on: wall, rest: -1 "
                                  "mm, return: 0, hysteresis: 0, speed: " +
                                  std::to_string(speed) + ", exponent: " + std::to_string(p) +
                                  ", stiffness: " + std::to_string(stiffness) + "}}]\n");
      EXPECT_TRUE(isCertified(scene));
      Player player(scene, kRates);
      player.ticks(150);
      const std::vector<double>& heard = player.heard[0];
      const auto touching =
          std::count_if(heard.begin(), heard.end(), [](double f) { return f != 0.0; });
      const double deepest =
          std::pow((p + 1.0) * mass * speed * speed / (2.0 * stiffness), 1.0 / (p + 1.0));
      const double a = 1.0 + 1.0 / (p + 1.0);
      const double contact =
          std::sqrt(kPi) * std::tgamma(a) / std::tgamma(a - 0.5) * 2.0 * deepest / speed;
      // An energy-stable force is a mean over two steps, which adds one at either end.
      EXPECT_NEAR(static_cast<double>(touching) - 1.0, contact * kRate, 1.5) << speed << " " << p;
      const double most =
          std::abs(*std::max_element(heard.begin(), heard.end(),
                                     [](double x, double y) { return std::abs(x) < std::abs(y); }));
      EXPECT_NEAR(most / (stiffness * std::pow(deepest, p)), 1.0, 0.05) << speed << " " << p;
    }
  }
}

/// The force at the hand as it goes slowly.
std::vector<double> feltOver(const scene::Scene& scene, double way, int ticks) {
  Player player(scene, kRates);
  std::vector<double> forces;
  for (int n = 0; n < ticks; ++n) {
    player.positions.assign(scene.ports.size(), 0.0);
    player.positions[0] = way * n / ticks;
    player.tick();
    forces.push_back(player.forces[0]);
  }
  return forces;
}

TEST(TechniquesTest, APlectrumLetsGoAtItsForce) {
  for (const double force : {0.5, 1.5, 4.0}) {
    const scene::Scene scene = sceneIncluding(
        "lib/plectra.yaml", std::string(kWall) +
                                "use: [{is: plectrum, as: p, in: {keys: k}, with: {on: wall, rest: "
                                "-5 mm, force: " +
                                std::to_string(force) + "}}]\n");
    EXPECT_TRUE(isCertified(scene));
    const std::vector<double> felt = feltOver(scene, 0.03, 6000);
    const auto least = *std::min_element(felt.begin(), felt.end());
    const auto most = *std::max_element(felt.begin(), felt.end());
    EXPECT_NEAR(std::max(-least, most) / force, 1.0, 0.05);
    EXPECT_NEAR(felt.back(), 0.0, 1e-9);
  }
}

/// Partial j loses Z sin^2(j pi u)/M: by 60 dB in ln(1000) over that.
TEST(TechniquesTest, ADamperTakesEachPartialAsItsPlaceSays) {
  struct Case {
    const char* keys;
    double at;
    int points;
    double step;
  };
  for (const Case& one : {Case{"at: 0.1", 0.1, 1, 0.0}, Case{"at: 0.3, partial: 2", 0.3, 1, 0.0},
                          Case{"at: 0.2, width: 0.1, points: 3", 0.2, 3, 0.05}}) {
    const double mass = 0.3 / 400.0;
    const scene::Scene open = sceneIncluding(
        "lib/plectra.yaml",
        "generators: [{type: string, name: s, section: a, masses: 59, to: [1, 0], pitch: 200, "
        "impedance: 0.3}]\nuse: [{is: damper, as: d, in: {s: a}, with: {string: s, t60: 1 s, "
        "mass: " +
            std::to_string(mass) + ", " + one.keys + "}}]\n");
    EXPECT_TRUE(isCertified(open));
    const scene::Scene scene = settle(open, kRates).scene;
    const int tuned = std::string(one.keys).find("partial") == std::string::npos ? 1 : 2;
    const auto share = [&](int j) {
      double sum = 0.0;
      for (int k = 0; k < one.points; ++k) {
        sum += std::pow(std::sin(j * kPi * (one.at + (k - 0.5 * (one.points - 1)) * one.step)), 2);
      }
      return sum / one.points;
    };
    const auto poles = test::BodyPoles(scene, kRate).poles();
    for (const int j : {1, 2, 3, 4, 6}) {
      const double expected = share(tuned) / share(j);
      EXPECT_NEAR(test::t60Of(poles[at(j - 1)], kRate) / expected, 1.0, 0.03) << one.keys << j;
    }
  }
}

TEST(TechniquesTest, AClockPlucksOnTheRootsOfItsSwing) {
  const double period = 0.3;
  const scene::Scene scene = sceneIncluding(
      "lib/clocks.yaml", std::string(kWall) + kPush +
                             "use: [{is: clock, as: c, in: {s: a}, with: {on: wall, period: "
                             "0.3 s}}]\n");
  EXPECT_TRUE(isCertified(scene));
  Player player(scene, kRates);
  player.ticks(9500);  // 3 s
  const std::vector<double>& heard = player.heard[0];
  std::vector<double> middles;
  for (std::size_t n = firstPush(heard); n < heard.size(); n = firstPush(heard, n)) {
    const std::size_t begin = n;
    while (n < heard.size() && heard[n] != 0.0) {
      ++n;
    }
    middles.push_back(0.5 * static_cast<double>(begin + n) / kRate);
  }
  ASSERT_GE(middles.size(), 9U);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(middles[k], (static_cast<double>(k) + 0.5) * period, 1e-3) << k;
  }
}

TEST(TechniquesTest, AKeyWeighsWhatItSays) {
  const scene::Scene scene =
      sceneIncluding("lib/keys.yaml, lib/mallets.yaml",
                     "use: [{is: weighted_key, as: key, in: {s: a, keys: k}}]\n");
  EXPECT_TRUE(isCertified(scene));
  constexpr double kWay = 0.0115;
  constexpr int kTicks = 30000;
  const std::vector<double> felt = feltOver(scene, kWay, kTicks);
  const auto at_mm = [&](double mm) {
    return std::abs(felt[static_cast<std::size_t>(mm * 1e-3 / kWay * kTicks)]);
  };
  EXPECT_NEAR(at_mm(4.0), 0.5, 0.02);
  EXPECT_NEAR(at_mm(6.5), 0.5, 0.02);
  EXPECT_NEAR(at_mm(8.0), 0.8, 0.04);
  EXPECT_NEAR(at_mm(9.5), 0.5, 0.04);
  EXPECT_NEAR(at_mm(11.0), 1.3, 0.07);  // a millimetre into its bed
}

TEST(TechniquesTest, AKeyThrowsItsHammerWhichComesBack) {
  const scene::Scene scene = sceneIncluding(
      "lib/mallets.yaml, lib/keys.yaml",
      std::string(kWall) + kPush +
          "use: [{is: hammer_key, as: key, in: {s: a, keys: k}, with: {on: wall}}]\n");
  EXPECT_TRUE(isCertified(scene));
  Player player(scene, kRates);
  const auto blows = [&](double ticks_down) {
    const std::size_t begin = player.heard[0].size();
    for (int n = 0; n < 3150; ++n) {
      player.positions.assign(1, n < 1500 ? 0.011 * std::min(1.0, n / ticks_down) : 0.0);
      player.tick();
    }
    int count = 0;
    for (std::size_t n = begin + 1; n < player.heard[0].size(); ++n) {
      count += player.heard[0][n] != 0.0 && player.heard[0][n - 1] == 0.0 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(blows(100.0), 1);
  EXPECT_EQ(blows(60.0), 1);
  EXPECT_EQ(blows(1500.0), 0);  // too slow to throw it
}

TEST(TechniquesTest, RainFallsFromItsHeights) {
  const scene::Scene scene = sceneIncluding(
      "lib/mallets.yaml",
      "generators: [{type: membrane, name: skin, section: a, cells: 8, mass: 0.05, pitch: 100}]\n"
      "outputs: {o: {at: 'skin@0.5:0.5', quantity: velocity, channel: 1}}\n"
      "use: [{is: rain, as: r, in: {air: air}, with: {on: skin, n: 1, height: 0.2 m, seed: 3}}]\n");
  EXPECT_TRUE(isCertified(scene));
  double height = 0.0;
  for (const scene::Mat& mat : scene.mats) {
    height = mat.name == "r.ball_0" ? mat.position.x() : height;
  }
  ASSERT_GE(height, 0.02);
  ASSERT_LE(height, 0.2);
  Player player(scene, kRates);
  player.ticks(1500);
  const double heard_at = static_cast<double>(firstPush(player.heard[0])) / kRate;
  EXPECT_NEAR(heard_at, std::sqrt(2.0 * height / kGravity), 1e-3);
}

TEST(TechniquesTest, BowsBringAStringToItsPitch) {
  const std::string string =
      "generators: [{type: string, name: s, section: a, masses: 100, to: [0.325, 0], pitch: 196, "
      "impedance: 0.3, t60: [[1, 2 s], [10, 0.5 s]]}]\n"
      "outputs: {o: {at: s@0.95, quantity: velocity, channel: 1}}\n";
  struct Case {
    const char* use;
    double pressed;  ///< m, of the second slice
  };
  for (const Case& one :
       {Case{"{is: bow, as: b, in: {s: a, keys: k}, with: {on: s@0.12}}", 0.0},
        Case{"{is: pressed_bow, as: b, in: {s: a, keys: k}, with: {string: s, at: 0.12, hairs: 1}}",
             0.0033},
        Case{"{is: pressed_bow, as: b, in: {s: a, keys: k}, with: {string: s, at: 0.12, hairs: 3, "
             "width: 0.02}}",
             0.0032}}) {  // pressed more, three hairs rasp
    const scene::Scene scene = sceneIncluding("lib/bows.yaml", string + "use: [" + one.use + "]\n");
    EXPECT_TRUE(isCertified(scene)) << one.use;
    Player player(scene, kRates);
    for (int n = 0; n < 6000; ++n) {
      // 0.1 m/s of the bow, 0.02 m/s of the hand.
      player.positions.assign(scene.ports.size(), one.pressed * std::min(1.0, n / 300.0));
      player.positions[0] = 0.02 * n / 3150.0;
      player.tick();
    }
    const std::vector<double> late(player.heard[0].end() - 40000, player.heard[0].end());
    EXPECT_NEAR(test::cents(test::partialNear(late, 196.0, kRate), 196.0), 0.0, 12.0) << one.use;
    const double largest = *std::max_element(late.begin(), late.end());
    EXPECT_GT(largest, 0.05) << one.use;
  }
}

TEST(TechniquesTest, TheRestCanBePlayedToo) {
  const std::string string =
      "generators: [{type: string, name: s, section: a, masses: 60, to: [0.65, 0], pitch: 110, "
      "impedance: 0.3, t60: 3 s}]\n";
  for (const char* const use : {"{is: beater, as: b, in: {s: a, keys: k}, with: {on: s@0.3}}",
                                "{is: touch_key, as: b, in: {keys: k}, with: {on: s@0.3}}",
                                "{is: finger, as: b, in: {s: a, keys: k}, with: {on: s@0.3}}",
                                "{is: mallet, as: b, in: {s: a, keys: k}}"}) {
    EXPECT_TRUE(isCertified(sceneIncluding("lib/mallets.yaml, lib/plectra.yaml, lib/keys.yaml",
                                           string + "use: [" + use + "]\n")))
        << use;
  }
}

}  // namespace
}  // namespace ergotic::physics
