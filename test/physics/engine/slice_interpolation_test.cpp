// SPDX-License-Identifier: BSD-3-Clause
// Slices that faster sections see interpolated: where they are seen, what they feel, whose work it
// is.

#include <complex>
#include <random>

#include "physics/engine/orchestra.hpp"
#include "physics/interpolation.hpp"
#include "support/physics.hpp"
#include "support/realtime_scope.hpp"

namespace ergotic::physics {
namespace {

scene::Scene smooth(scene::Scene scene) {
  for (scene::Mat& mat : scene.mats) {
    if (mat.type == scene::MatType::kSlice) {
      mat.coupling = scene::Coupling::kSmooth;
    }
  }
  return scene;
}

/// Positions held over the tick, then blurred twice by a mean over a tick: a quadratic B-spline.
std::vector<double> splineOf(const std::vector<double>& positions, int steps) {
  std::vector<double> all;
  for (const double x : positions) {
    all.insert(all.end(), at(steps), x);
  }
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<double> blurred(all.size());
    for (int m = 0; m < static_cast<int>(all.size()); ++m) {
      for (int k = 0; k < steps; ++k) {
        blurred[at(m)] += all[at(std::max(0, m - k))] / steps;
      }
    }
    all = blurred;
  }
  return all;
}

std::vector<double> walk(std::size_t ticks, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-1e-3, 1e-3);
  std::vector<double> positions(ticks);
  for (std::size_t n = 1; n < ticks; ++n) {
    positions[n] = positions[n - 1] + step(random);
  }
  return positions;
}

/// A slice on a spring to the ground of a section with this divisor, whose force is heard.
struct Wall : SceneBuilder {
  explicit Wall(double stiffness, double damping = 0.0, int divisor = 1) {
    const int hand = slice(0);
    scene.sections[0].divisor = divisor;
    const int there = ground();
    spring(hand, there, stiffness, damping);
    hear(there, 0, Quantity::kForce);
    scene = smooth(scene);
  }
};

class SliceInterpolationTest : public testing::TestWithParam<int> {
 protected:
  Rates rates() const { return {kRate, GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(, SliceInterpolationTest, testing::Values(4, 14, 44));

TEST_P(SliceInterpolationTest, AreSeenOnTheQuadraticSplineOfTheirPositions) {
  for (const int divisor : {1, GetParam() / 2}) {
    const std::vector<double> positions = walk(60, 3);
    const std::vector<double> spline = splineOf(positions, GetParam() / divisor);
    Player player(Wall(1000.0, 0.0, divisor).scene, rates());
    for (std::size_t n = 0; n < positions.size(); ++n) {
      player.positions[0] = positions[n];
      player.tick();
    }
    // The force of a step is heard when it is over.
    for (std::size_t m = at(divisor) - 1; m < player.heard[0].size(); m += at(divisor)) {
      EXPECT_NEAR(player.heard[0][m], 1000.0 * spline[m / at(divisor)], 1e-12) << m;
    }
  }
}

TEST_P(SliceInterpolationTest, WhatASliceFeelsIsTheResponseThatItsLoopIsJudgedBy) {
  const InterpolationResponse answer = interpolationResponse(GetParam());
  const double tick = 1.0 / rates().gesturalHz();
  const std::vector<double> positions = walk(80, 5);
  Player player(Wall(1000.0, 3.0).scene, rates());
  for (std::size_t n = 0; n < positions.size(); ++n) {
    player.positions[0] = positions[n];
    player.tick();
    double force = 0.0;
    for (std::size_t i = 0; i < std::min(n + 1, answer.spring.size()); ++i) {
      force -= (1000.0 * answer.spring[i] + 3.0 / tick * answer.damper[i]) * positions[n - i];
    }
    EXPECT_NEAR(player.forces[0], force, 1e-10 * 30.0) << n;
  }
}

/// Everything that a slice may touch: springs, dampers, energy-stable and explicit contacts, a
/// pluck, a point that it leads and presses, masses of several rates.
SceneBuilder everything() {
  SceneBuilder b;
  const int hand = b.slice(0);
  scene::Section half = b.scene.sections[0];
  half.name = "half";
  half.divisor = 2;
  b.scene.sections.push_back(half);
  const int first = b.chain(20, 1e-3, 2e4, 1e-3);
  const int grid = b.grid(first, 22);
  b.spring(hand, first + 7, 900.0, 0.3);
  const int slow = b.mass(0.01, 0.0, 0.0, 2);
  b.spring(hand, slow, 700.0, 0.1);
  b.spring(slow, b.ground(0.0, 2), 300.0, 0.2);
  const int finger = b.point(grid, 0.4);
  b.scene.connections.back().along.guide = hand;
  b.scene.connections.back().along.scale = 5.0;
  b.spring(hand, finger, 400.0, 0.05);
  b.link(LiaType::kContact, hand, first + 12, 2000.0, 0.2);
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  b.link(LiaType::kContact, first + 4, hand, 800.0, 0.1);
  b.link(LiaType::kPluck, hand, first + 15, 600.0);
  b.scene.lias.back().law.edit().width = {2e-3};
  b.scene = smooth(b.scene);
  return b;
}

/// A tick of D is paid by the force of the next one, so it must rest for two at the end.
TEST_P(SliceInterpolationTest, TheWorkOfTheHandIsThatOnTheFasterSideToRounding) {
  std::vector<double> positions = walk(400, 7);
  positions.insert(positions.end(), 2, positions.back());
  Player player(everything().scene, rates());
  double work = 0.0;
  double size = 0.0;
  double last = 0.0;
  for (std::size_t n = 0; n < positions.size(); ++n) {
    player.positions[0] = positions[n];
    player.tick();
    const double given = n < 2 ? 0.0 : -(positions[n - 1] - positions[n - 2]) * player.forces[0];
    work += given;
    size += std::abs(given);
    last = positions[n];
  }
  const Energies energies = energiesOf(player);
  EXPECT_GT(size, 1e-3) << last;
  EXPECT_NEAR(energies.sections[1].from_device, work, 1e-12 * size);
  for (const CouplingEnergy& coupling : energies.couplings) {
    EXPECT_EQ(coupling.section_a == 1 || coupling.section_b == 1 ? coupling.made : 0.0, 0.0);
  }
}

TEST_P(SliceInterpolationTest, EnergyBalancesAfterEveryTick) {
  Player player(everything().scene, rates());
  EXPECT_LT(imbalanceOf(player, 2000), 1e-11);
}

TEST_P(SliceInterpolationTest, APointThatTheyLeadGlidesWithThem) {
  SceneBuilder b;
  const int first = b.chain(20, 1e-3, 2e4);
  const int grid = b.grid(first, 22);
  for (int i = 0; i < 22; ++i) {  // a string along a slope tells where the point is
    b.scene.mats[at(first + i)].type = scene::MatType::kGround;
    b.scene.mats[at(first + i)].position.x() = i / 21.0;
  }
  const int point = b.point(grid, 0.3);
  b.scene.connections.back().along.guide = b.slice(0);
  b.scene.connections.back().along.scale = 10.0;
  b.scene.connections.back().power = 1e6;
  b.hear(point);
  const std::vector<double> positions = walk(40, 9);
  const std::vector<double> spline = splineOf(positions, GetParam());
  Player player(smooth(b.scene), rates());
  for (const double x : positions) {
    player.positions[0] = x;
    player.tick();
  }
  for (std::size_t m = at(GetParam()); m < player.heard[0].size(); ++m) {
    EXPECT_NEAR(player.heard[0][m], 0.3 + 10.0 * spline[m], 1e-9) << m;
  }
}

TEST_P(SliceInterpolationTest, GoOnBitByBitFromASavedState) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const scene::Scene scene = everything().scene;
    const std::vector<double> positions = walk(200, 11);
    Player one(scene, rates(), precision);
    Player other(scene, rates(), precision);
    std::vector<std::byte> state(one.instrument->stateSize());
    for (std::size_t n = 0; n < positions.size(); ++n) {
      one.positions[0] = other.positions[0] = positions[n];
      one.tick();
      if (n == 101) {
        one.instrument->saveState(state.data());
        other.instrument->loadState(state.data());
      } else if (n > 101) {
        other.tick();
        EXPECT_EQ(one.forces, other.forces) << n;
      }
    }
  }
}

TEST(SliceInterpolationSceneTest, SinglePrecisionPlaysTheSame) {
  const std::vector<double> positions = walk(500, 13);
  Player wide(everything().scene, {kRate, 14}, Precision::kDouble);
  Player narrow(everything().scene, {kRate, 14}, Precision::kFloat);
  for (const double x : positions) {
    wide.positions[0] = narrow.positions[0] = x;
    wide.tick();
    narrow.tick();
    EXPECT_NEAR(narrow.forces[0], wide.forces[0], 2e-3 * 30.0);
  }
}

TEST(SliceInterpolationSceneTest, ThreadsPlayTheSameBits) {
  const scene::Scene scene = settle(smooth(Orchestra(9).scene()), {kRate, 14}).scene;
  CompileOptions options(Precision::kFloat);
  options.wait_limit_ns = 60'000'000'000;
  Player alone(compile(scene, {kRate, 14}, options));
  options.threads = 3;
  Player together(compile(scene, {kRate, 14}, options));
  const std::vector<double> positions = walk(300, 17);
  for (const double x : positions) {
    for (Player* player : {&alone, &together}) {
      std::fill(player->positions.begin(), player->positions.end(), x);
      std::fill(player->inputs.begin(), player->inputs.end(), 100.0 * x);
      player->tick();
    }
    ASSERT_EQ(alone.forces, together.forces);
  }
  EXPECT_EQ(alone.heard, together.heard);
}

TEST(SliceInterpolationSceneTest, ALoadThatTheySeeInSpaceIsCountedAlongEveryAxis) {
  SceneBuilder b;
  const int hand = b.slice(0);
  b.scene.sections[0].geometry = b.scene.sections[1].geometry = Geometry::kSpace;
  b.scene.sections[0].pose.rotate(
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()));
  for (const int axis : {1, 2}) {
    b.scene.ports.push_back(b.scene.ports.front());
    b.scene.ports.back().name += std::to_string(axis);
    b.scene.ports.back().axis = axis;
    b.scene.ports.back().slice = axis;
  }
  const int mass = b.mass(0.01);
  b.scene.mats[at(mass)].rest = b.scene.mats[at(mass)].position = {0.1, 0.05, 0.02};
  b.spring(hand, mass, 500.0, 0.0);
  b.scene.lias.back().rest_length = 0.05;
  b.link(LiaType::kContact, hand, mass, 300.0);
  b.scene.lias.back().law.edit().width = {0.2};
  Player player(smooth(b.scene), {kRate, 14});
  std::vector<double> ways[3] = {walk(302, 19), walk(302, 23), walk(302, 29)};
  double work = 0.0;
  double size = 0.0;
  for (std::size_t n = 0; n < 302; ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      ways[k][n] = n < 300 ? ways[k][n] : ways[k][n - 1];
      player.positions[k] = ways[k][n];
    }
    player.tick();
    for (std::size_t k = 0; k < 3 && n >= 2; ++k) {
      const double given = -(ways[k][n - 1] - ways[k][n - 2]) * player.forces[k];
      work += given;
      size += std::abs(given);
    }
  }
  EXPECT_NEAR(energiesOf(player).sections[1].from_device, work, 1e-12 * size);
}

TEST(SliceInterpolationSceneTest, TicksInRealTime) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    Player player(everything().scene, {kRate, 14}, precision);
    std::vector<double> outputs(at(14 * player.instrument->outputChannels()));
    ergotic::test::expectRealtime([&] {
      for (int n = 0; n < 200; ++n) {
        player.positions[0] = 1e-3 * std::sin(0.1 * n);
        player.instrument->tick(
            {player.positions.data(), player.forces.data(), player.inputs.data(), outputs.data()});
      }
    });
  }
}

TEST(SliceInterpolationSceneTest, ASleepingSectionWakesByThem) {
  SceneBuilder b;
  const int first = b.chain(10, 1e-3, 2e4);
  b.scene.sections[0].sleep_energy = 1e-12;
  b.link(LiaType::kContact, first + 5, b.slice(0), 500.0);
  b.scene.lias.back().law.edit().width = {-0.01};
  b.hear(first + 5);
  Player player(smooth(b.scene), {kRate, 14});
  player.ticks(50);
  EXPECT_EQ(player.heard[0].back(), 0.0);
  for (int n = 0; n < 60; ++n) {
    player.positions[0] = -2e-4 * n;
    player.tick();
  }
  EXPECT_LT(player.heard[0].back(), -1e-6);
}

/// Energy above half the gestural rate against that below, of the velocity that a spring's far end
/// is seen to be moved with, dB.
double imagesOf(scene::Scene scene, int ratio, double hz) {
  Player player(scene, {kRate, ratio});
  const double tick = ratio / kRate;
  const int ticks = 40000 / ratio;
  for (int n = 0; n < ticks; ++n) {
    player.positions[0] = 1e-3 * std::sin(2.0 * kPi * hz * n * tick);
    player.tick();
  }
  std::vector<double> change;
  for (std::size_t m = 8000; m + 1 < player.heard[0].size(); ++m) {
    change.push_back(player.heard[0][m + 1] - player.heard[0][m]);
  }
  const auto size = static_cast<double>(change.size());
  const auto levelAt = [&](double at_hz) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < change.size(); ++i) {
      const double window = 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / size);
      sum +=
          window * change[i] * std::polar(1.0, -2.0 * kPi * at_hz * static_cast<double>(i) / kRate);
    }
    return std::norm(sum);
  };
  double images = 0.0;
  for (int k = 1; k <= ratio / 2; ++k) {
    for (const double side : {-hz, hz}) {
      const double image = k * kRate / ratio + side;
      images += image < 0.5 * kRate ? levelAt(image) : 0.0;
    }
  }
  return 10.0 * std::log10(images / levelAt(hz));
}

TEST(SliceInterpolationSceneTest, HaveNoImagesThatAreHeard) {
  struct Expected {
    int ratio;
    double hz;
    double db;
  };
  for (const Expected& e : {Expected{4, 20.0, -104.0},
                            {4, 100.0, -76.0},
                            {4, 400.0, -51.5},
                            {14, 20.0, -84.0},
                            {14, 100.0, -56.0},
                            {14, 400.0, -27.0},
                            {44, 20.0, -64.0},
                            {44, 100.0, -36.0}}) {
    EXPECT_LT(imagesOf(Wall(1000.0).scene, e.ratio, e.hz), e.db) << e.ratio << ", " << e.hz;
    scene::Scene held = Wall(1000.0).scene;
    held.mats[0].coupling = scene::Coupling::kHold;
    EXPECT_GT(imagesOf(held, e.ratio, e.hz), 0.0);
  }
}

}  // namespace
}  // namespace ergotic::physics
