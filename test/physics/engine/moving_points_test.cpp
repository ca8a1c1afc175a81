// SPDX-License-Identifier: BSD-3-Clause
// Places that move glide, and bring no more energy than they may.
#include <cmath>

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/engine/moved_places.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A string of 110 Hz, plucked at one third.
struct Plucked : SceneBuilder {
  static constexpr int kMasses = 80;
  static constexpr double kKilograms = 5e-5;
  int on = 0;

  explicit Plucked(double t60_s) {
    const int first = chain(kMasses, kKilograms, kKilograms * 17820.0 * 17820.0);
    on = grid(first, kMasses + 2);
    if (t60_s > 0.0) {
      scene.sections[0].medium = {2.0 * kKilograms * std::log(1000.0) / t60_s};
    }
    for (int i = 1; i <= kMasses; ++i) {
      scene.mats[at(first + i)].position.x() = 1e-3 * std::min(i / 27.0, (kMasses + 1 - i) / 54.0);
    }
  }
  /// A spring from a place to the ground.
  scene::Connection& fret(double along, double k) {
    spring(point(on, along), ground(), k);
    return scene.connections.back();
  }
};

/// A fret that a hand leads.
Plucked frettedByHand(double t60_s) {
  Plucked b(t60_s);
  scene::Connection& fret = b.fret(0.5, 2e5);
  fret.along.guide = b.slice(0);
  fret.along.scale = 10.0;
  return b;
}

/// A spring that an oscillator of its own leads, at about twice the fundamental.
Plucked shaken(double power) {
  Plucked b(4.6);
  scene::Connection& place = b.fret(0.25, 3000.0);
  place.along.guide = b.cell(1e-6, 1e-6 * std::pow(2.0 * kPi * 266.0, 2.0), 0.0, 0.1);
  place.along.scale = 1.5;
  place.power = power;
  b.scene.sections.push_back(b.scene.sections[0]);
  b.scene.sections.back().name = "free";
  b.scene.sections.back().medium = {0.0};
  b.scene.mats[at(place.along.guide)].section = 2;
  return b;
}

struct Played {
  double start = 0.0;  ///< J
  double most = 0.0;   ///< J
};

Played play(const SceneBuilder& b, double seconds, Precision precision) {
  Player player(b.scene, {kRate, 14}, precision);
  Played played;
  for (int n = 0; n < static_cast<int>(seconds * kRate / 14.0); ++n) {
    if (!player.positions.empty()) {
      player.positions[0] = 0.03 * std::sin(2.0 * kPi * 6.0 * n * 14.0 / kRate);
    }
    player.tick();
    if (n % 50 == 0) {
      const double stored = energiesOf(player).stored;
      played.start = n == 0 ? stored : played.start;
      played.most = std::max(played.most, stored);
    }
  }
  return played;
}

/// Plays what is certified: it holds what it was given and what moving may bring, no more.
void expectHeld(const SceneBuilder& b, double seconds) {
  ASSERT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const Played played = play(b, seconds, precision);
    const double power = b.scene.connections[0].power;
    EXPECT_LT(played.most, kBeyond * (played.start + power * (seconds + kCreditSeconds)));
  }
}

TEST(MovingPointsTest, HandThatSwingsAFretLetsTheStringDecay) {
  const Plucked b = frettedByHand(4.6);
  expectHeld(b, 20.0);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const Played played = play(b, 20.0, precision);
    EXPECT_LT(played.most, 1.1 * played.start);
  }
}

TEST(MovingPointsTest, WithoutLossItGrowsByWhatItMay) {
  Plucked b = frettedByHand(0.0);
  for (const double power : {1.0, 1e-4}) {
    b.scene.connections[0].power = power;
    expectHeld(b, 20.0);
  }
}

TEST(MovingPointsTest, OscillatorThatLeadsAPlacePumpsNoMoreThanItMay) {
  expectHeld(shaken(1e-3), 2.0);
  expectHeld(shaken(1.0), 2.0);
  // With all the power in the world it would, and is not certified.
  const Plucked unlimited = shaken(1e30);
  const Played played = play(unlimited, 2.0, Precision::kDouble);
  EXPECT_GT(played.most, 1e12 * played.start);
  EXPECT_EQ(certify(unlimited.scene, {kRate, 14}).verdict, Verdict::kUnproven);
}

TEST(MovingPointsTest, EnergyStableLinksBringNothing) {
  Plucked b = frettedByHand(0.0);
  b.scene.lias.back().type = LiaType::kCubic;
  b.scene.lias.back().law.edit().nonlinearity = {1e10};
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const Played played = play(b, 20.0, precision);
    EXPECT_LT(played.most, 1.01 * played.start);
  }
}

TEST(MovingPointsTest, UpASlopeItGoesAsFastAsItsPowerLasts) {
  SceneBuilder b;
  for (int i = 0; i < 11; ++i) {
    b.ground(i);
  }
  const int point = b.point(b.grid(0, 11), 1.0);
  b.scene.parameters.push_back({"place", 0.2, 0.0, 1.0, {}});
  b.scene.connections[0].along.at = {1.0, 0};
  b.scene.connections[0].power = 3000.0;
  b.spring(point, b.ground(), 100.0);
  b.hear(point);
  Player player(b.scene, {kRate, 10});
  player.tick();
  player.instrument->exchange(player.instrument->prepare({0.8}));
  const auto stored = [](double x) { return 50.0 * x * x; };
  for (const double seconds : {0.2, 0.4, 0.6}) {
    player.ticks(static_cast<int>(0.2 * kRate / 10.0));
    const double brought = stored(player.heard[0].back()) - stored(2.0);
    EXPECT_NEAR(brought, 3000.0 * (seconds + kCreditSeconds), 15.0);
  }
  player.ticks(static_cast<int>(0.5 * kRate / 10.0));
  EXPECT_NEAR(player.heard[0].back(), 8.0, 1e-12) << "it arrives in the end";
}

/// It goes 0.6 m in its first step, for Z (0.6 m)^2 / h = 0.3 s of its power, and waits for 0.2 s
/// of them: no more than 0.1 s are lent.
TEST(MovingPointsTest, ByADamperItPaysForItsSpeed) {
  constexpr double kPower = 1000.0;
  for (const double unit : {1.0, 1.0 / kRate}) {
    SceneBuilder b;
    b.scene.time_unit_s = unit;
    for (int i = 0; i < 11; ++i) {
      b.ground(i);
    }
    const int point = b.point(b.grid(0, 11), 1.0);
    b.scene.parameters.push_back({"place", 0.2, 0.0, 1.0, {}});
    b.scene.connections[0].along.at = {1.0, 0};
    b.scene.connections[0].power = kPower;
    b.spring(point, b.ground(), 0.0, 0.3 * kPower / (0.36 * kRate) * unit);
    b.hear(point);
    Player player(b.scene, {kRate, 10});
    player.tick();
    player.instrument->exchange(player.instrument->prepare({0.8}));
    player.ticks(static_cast<int>(0.19 * kRate / 10.0));
    EXPECT_NEAR(player.heard[0].back(), 2.6, 1e-12);
    player.ticks(static_cast<int>(0.02 * kRate / 10.0));
    EXPECT_GT(player.heard[0].back(), 2.7);
  }
}

TEST(MovingPointsTest, GlidesOverTheStepOfWhatGuidesIt) {
  SceneBuilder b;
  for (int i = 0; i < 11; ++i) {
    b.ground(i);
  }
  const int point = b.point(b.grid(0, 11), 0.2);
  b.scene.connections[0].along.guide = b.slice(0);
  b.scene.connections[0].along.scale = 1.0;
  b.hear(point);
  Player player(b.scene, {kRate, 5});
  player.tick();
  player.positions = {0.5};
  player.ticks(2);
  for (int n = 0; n < 10; ++n) {
    EXPECT_NEAR(player.heard[0][at(5 + n)], 2.0 + std::min(5.0, n + 1.0), 1e-12) << n;
  }
}

/// Each coordinate of what guides it takes it its own way: along by y of a mass in space, across by
/// a hand.
TEST(MovingPointsTest, OnAMeshFollowsTwoCoordinates) {
  SceneBuilder b;
  const auto heightAt = [](int column, int row) { return column + 10.0 * row; };
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 11; ++column) {
      b.ground(heightAt(column, row));
    }
  }
  const int point = b.point(b.grid(0, 11, 5), 0.2, 0.5);
  scene::Section space = b.scene.sections[0];
  space.name = "space";
  space.geometry = scene::Geometry::kSpace;
  b.scene.sections.push_back(space);
  const int tip = b.mass(1.0, 0.0, 0.0, 2);
  setVelocity(b.scene.mats[at(tip)], {7.0, 0.25, -3.0});
  scene::Connection& c = b.scene.connections[0];
  c.along.guide = tip;
  c.along.axis = 1;
  c.along.scale = 2.0;  // 0.5 of the way in a second
  c.across.guide = b.slice(0);
  c.across.scale = 1.0;
  c.across.maximum = 0.75;
  b.hear(point);
  Player player(b.scene, {kRate, 5});
  player.ticks(100);
  const auto expected = [&](int frame, double across) {
    return heightAt(0, 0) + 10.0 * (0.2 + 0.5 * (frame + 1) / kRate) + 40.0 * across;
  };
  EXPECT_NEAR(player.heard[0].back(), expected(499, 0.5), 1e-9);
  player.positions = {0.5};
  player.ticks(2);
  for (int n = 0; n < 10; ++n) {
    const double across = 0.5 + 0.25 * std::min(5.0, n + 1.0) / 5.0;
    EXPECT_NEAR(player.heard[0][at(500 + n)], expected(500 + n, across), 1e-9) << n;
  }
}

/// How fast a string goes after a finger has let go of it that glided along it. The finger, 7 mm
/// down, lifts evenly within 0.1 s.
double speedAfterTheFinger(double damping, Precision precision) {
  Plucked b(0.2);
  const int place = b.point(b.on, 0.3);
  scene::Connection& connection = b.scene.connections.back();
  connection.along.guide = b.slice(0);
  connection.along.scale = 20.0;
  connection.speed = 4.0;
  const int finger = b.mass(0.01, 5e-3);
  b.spring(b.slice(1), finger, 700.0, 4.0);
  b.link(LiaType::kContact, place, finger, 2e4, damping);
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  b.hear(40, 0, Quantity::kVelocity);
  Player player(b.scene, {kRate, 14}, precision);
  const auto wayAt = [](double t, double begin, double end) {
    return std::clamp((t - begin) / (end - begin), 0.0, 1.0);
  };
  for (int n = 0; n < static_cast<int>(1.3 / kTick); ++n) {
    const double t = n * kTick;
    player.positions[0] = 0.01 * wayAt(t, 0.1, 0.2);
    player.positions[1] = 5e-3 - 23e-3 * (wayAt(t, 0.0, 0.05) - wayAt(t, 1.0, 1.1));
    player.tick();
  }
  double fastest = 0.0;
  for (auto v = player.heard[0].begin() + static_cast<int>(kRate); v < player.heard[0].end(); ++v) {
    fastest = std::max(fastest, std::abs(*v));
  }
  return fastest;
}

/// What a contact takes up while it is closed, as here by the string that it passes, it does not
/// give back as a blow when it opens.
TEST(MovingPointsTest, FingerThatHasGlidedLetsGoOfAStringQuietly) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    EXPECT_LT(speedAfterTheFinger(0.05, precision), 0.3) << "m/s; 9 if all is given back";
  }
}

}  // namespace
}  // namespace ergotic::physics
