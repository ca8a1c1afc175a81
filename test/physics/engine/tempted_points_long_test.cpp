// SPDX-License-Identifier: BSD-3-Clause
// Hands that search for a way to pump by moving places.
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/engine/moved_places.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

double logarithmic(std::mt19937& random, double a, double b) {
  return std::exp(uniform(random, std::log(a), std::log(b)));
}

/// What tries to pump: it swings, leaps to and fro, trembles, or stays on the side on which its
/// last move has brought something.
class Tempter {
 public:
  explicit Tempter(std::mt19937& random)
      : random_(random),
        kind_(random() % 4),
        hz_(logarithmic(random, 1.0, 2000.0)),
        size_(logarithmic(random, 0.02, 1.0)) {}

  double next(double seconds, double stored) {
    const double swing = std::sin(2.0 * kPi * hz_ * seconds);
    side_ = stored > last_ ? side_ : -side_;
    last_ = stored;
    return size_ *
           std::array{swing, std::copysign(1.0, swing), uniform(random_, -1.0, 1.0), side_}[kind_];
  }

 private:
  std::mt19937& random_;
  std::size_t kind_;
  double hz_;
  double size_;
  double side_ = 1.0;
  double last_ = 0.0;
};

/// One or two strings, or nets, with places that hands lead, and links among these, a mass and the
/// ground.
class Temptation : public SceneBuilder {
 public:
  Temptation(std::mt19937& random, double power, bool of_nets) : random_(random) {
    std::vector<int> ends{ground(), mass(mass_, 0.0, uniform(random_, -1.0, 1.0))};
    for (unsigned s = 0; s <= random_() % 2; ++s) {
      ends.push_back(of_nets ? addNet() : addString());
      scene.connections.back().power = power;
    }
    for (int l = 0; l < 3; ++l) {
      const int a = ends[random_() % ends.size()];
      const int b = ends[random_() % ends.size()];
      if (a != b) {
        addLink(a, b);
      }
    }
    scene.sections[0].medium = {perhaps(1e-6, 1e-3)};
    const int hand = slice(0);
    const int other = of_nets ? slice(1) : -1;
    for (scene::Connection& place : scene.connections) {
      place.along.guide = hand;
      place.across.guide = other;
      place.along.scale = place.across.scale = 1.0;
    }
  }

 private:
  /// N s/m, or none.
  double perhaps(double a, double b) {
    return random_() % 2 == 0 ? 0.0 : logarithmic(random_, a, b) * mass_ * kRate;
  }

  int addString() {
    const int masses = 2 + static_cast<int>(random_() % 30);
    const double k = logarithmic(random_, 1e-4, 0.9) * mass_ * kRate * kRate;
    const int first = chain(masses, mass_, k, perhaps(1e-7, 1e-3));
    for (int i = 1; i <= masses; ++i) {
      scene.mats[at(first + i)].push.edit().velocity.x() = uniform(random_, -1.0, 1.0);
    }
    const int place = point(grid(first, masses + 2), uniform(random_, 0.0, 1.0));
    scene.connections.back().speed = random_() % 2 == 0 ? 0.0 : logarithmic(random_, 0.1, 100.0);
    return place;
  }

  int addNet() {
    const int columns = 2 + static_cast<int>(random_() % 5);
    const int rows = 2 + static_cast<int>(random_() % 4);
    const double k = logarithmic(random_, 1e-4, 0.45) * mass_ * kRate * kRate;
    const double z = perhaps(1e-7, 1e-3);
    const auto first = static_cast<int>(scene.mats.size());
    for (int i = 0; i < rows * columns; ++i) {
      i == 0 ? ground() : mass(mass_, 0.0, uniform(random_, -1.0, 1.0));
    }
    for (int i = 0; i < rows * columns; ++i) {
      if ((i + 1) % columns != 0) {
        spring(first + i, first + i + 1, k, z);
      }
      if (i + columns < rows * columns) {
        spring(first + i, first + i + columns, k, z);
      }
    }
    const int on = grid(first, columns, rows);
    const int place = point(on, uniform(random_, 0.0, 1.0), uniform(random_, 0.0, 1.0));
    scene.connections.back().speed = random_() % 2 == 0 ? 0.0 : logarithmic(random_, 0.1, 100.0);
    return place;
  }

  void addLink(int a, int b) {
    const double k = logarithmic(random_, 1e-3, 2.0) * mass_ * kRate * kRate;
    const std::array types{LiaType::kSpringDamper, LiaType::kSpringDamper, LiaType::kContact,
                           LiaType::kCubic};
    Lia& lia = scene.lias[at(link(types[random_() % 4], a, b, k, perhaps(1e-5, 0.3)))];
    if (lia.type != LiaType::kSpringDamper) {
      lia.scheme = Scheme::kEnergyStable;
      lia.law.edit().nonlinearity = {k / logarithmic(random_, 1e-12, 1e-6)};
    }
  }

  std::mt19937& random_;
  double mass_ = logarithmic(random_, 1e-5, 1e-2);
};

/// The most that was stored over what may be, J/J; 0 if it is not certified.
double tempt(unsigned seed, bool of_nets) {
  std::mt19937 random(seed);
  const double power = logarithmic(random, 1e-5, 1.0);
  const Temptation b(random, power, of_nets);
  const int ratio = std::array{1, 2, 7, 14}[random() % 4];
  if (certify(b.scene, {kRate, ratio}).verdict > Verdict::kBounded) {
    return 0.0;
  }
  Player player(b.scene, {kRate, ratio}, seed % 2 == 0 ? Precision::kDouble : Precision::kFloat);
  std::vector<Tempter> hands;
  for (std::size_t i = 0; i < player.positions.size(); ++i) {
    hands.emplace_back(random);
  }
  const double all = power * static_cast<double>(b.scene.connections.size());
  Energies energies;
  double start = 0.0;
  double worst = 0.0;
  for (int n = 0; n < 8000 / ratio; ++n) {
    const double seconds = (n + 1) * ratio / kRate;
    for (std::size_t i = 0; i < hands.size(); ++i) {
      player.positions[i] = hands[i].next(seconds, energies.stored);
    }
    player.tick();
    energies = energiesOf(player);
    start = n == 0 ? energies.stored : start;
    worst = std::max(worst, energies.stored / (start + all * (seconds + kCreditSeconds)));
  }
  return worst;
}

TEST(MovingPointsTest, NothingThatIsCertifiedIsPumpedUp) {
  for (const bool of_nets : {false, true}) {
    const unsigned scenes = of_nets ? 300 : 1000;
    int certified = 0;
    for (unsigned seed = 0; seed < scenes; ++seed) {
      const double worst = tempt(seed, of_nets);
      certified += worst > 0.0 ? 1 : 0;
      EXPECT_LT(worst, kBeyond) << "seed " << seed << (of_nets ? " of nets" : "");
    }
    EXPECT_GT(certified, 0.9 * scenes);
  }
}

}  // namespace
}  // namespace ergotic::physics
