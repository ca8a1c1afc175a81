// SPDX-License-Identifier: BSD-3-Clause
// The map of Schelleng: which forces of a bow make a string sound as bowed ones do. With
// ERGOTIC_SCHELLENG=FILE each force that was played also becomes a line of FILE:
// lab/scripts/plot_schelleng draws it.
#include <fstream>
#include <sstream>

#include <Eigen/Dense>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kBowedPitch = 196.0;  // Hz
constexpr int kBowedMasses = 110;
constexpr double kResistance = 0.36;   // kg/s, of waves on the string
constexpr double kLoss = 3.0;          // 1/s, of its first mode
constexpr double kLossOfTenth = 15.0;  // 1/s
constexpr double kBowedSeconds = 0.5;
constexpr int kJudged = 40;                              // last periods
constexpr double kSpeeds[] = {0.15, 0.3, 0.6};           // m/s
constexpr double kPlaces[] = {0.04, 0.06, 0.09, 0.135};  // of the length, from the bridge
constexpr double kRestSpeed = 0.3;                       // m/s, at which it starts from rest, too
constexpr double kRestSeconds = 1.0;
constexpr double kRestStep = 1.1;
constexpr int kForces = 24;  // from 0.5 f_min to 3 f_max

double frictionAt(double v) {
  return 0.35 + 0.4 * std::exp(-v / 0.01) + 0.45 * std::exp(-v / 0.1);
}

/// The forces between which Schelleng's string sounds (Schelleng 1973, JASA 53).
struct Limits {
  Limits(double speed, double place) {
    const double fall = frictionAt(0.0) - frictionAt(speed / place - speed);
    const double at_bridge = 2.0 * kBowedPitch * kResistance / kLoss;
    least = kResistance * kResistance * speed / (2.0 * at_bridge * place * place * fall);
    most = 2.0 * kResistance * speed / (place * fall);
  }
  double least;  // N
  double most;
};

/// How the string moves when the bow is put on: as Helmholtz has it, its corner half way, or not.
enum class Start { kHelmholtz, kRest };

scene::Scene bowedString(double speed, double place, double force, Start start) {
  const double length = kBowedMasses + 1;
  const double step = std::sin(kPi * kBowedPitch / kRate) / std::sin(kPi / (2.0 * length));
  const double mass = kResistance / (kRate * step);
  const double by_square =
      (kLossOfTenth - kLoss) / 99.0;  // losses grow with the square of the mode
  std::ostringstream text;
  text.precision(17);
  text << "ergotic: 1\nsections: {all: {rate: audio}}\n"
       << "mats:\n  hair: {type: mass, mass: 1e9, v: " << speed << "}\n"
       << "generators: [{type: string, name: s, masses: " << kBowedMasses << ", mass: " << mass
       << ", frequency: " << kBowedPitch << ", loss: " << 2.0 * mass * (kLoss - by_square)
       << ", damping: " << 2.0 * mass * by_square * std::pow(length / kPi, 2.0)
       << ", to: [0.325, 0]}]\n"
       << "lias:\n  bow: {type: friction, between: [s@" << place << ", hair], normal: " << force
       << ", steady: 0.35, parts: [[0.4, 0.01], [0.45, 0.1]]}\n"
       << "outputs:\n  string: {at: s@" << place << ", quantity: velocity, channel: 1}\n"
       << "  hair: {at: hair, quantity: velocity, channel: 2}\n";
  scene::Scene scene = scene::readYaml(text.str(), "bowed.yaml");
  if (start == Start::kRest) {
    return scene;
  }
  for (int i = 1; i <= kBowedMasses; ++i) {
    scene::Mat& mat = scene.mats[at(scene.strings[0].first + i)];
    const double x = i / length;
    const double slope = speed / place;
    mat.position.x() = -slope / kBowedPitch / 4.0 * (x < 0.5 ? x : 1.0 - x);
    const double v = x < 0.5 ? slope * x : -slope * (1.0 - x);
    scene::setVelocity(mat, v * Eigen::Vector3d::UnitX());
  }
  return scene;
}

struct Sound {
  double slips = 0.0;     ///< in a period of the string, mean
  double cents = 0.0;     ///< of the time from slip to slip, against the string
  double ragged = 0.0;    ///< the largest difference of that time from its mean, of a period
  double slipping = 0.0;  ///< share of the time
  double stuck = 0.0;     ///< the fastest slip of what sticks, m/s
  bool isHelmholtz() const {
    return std::abs(slips - 1.0) < 0.03 && std::abs(cents) < 10.0 && ragged < 0.1;
  }
};

Sound playBowed(double speed, double place, double force, Start start, double seconds) {
  constexpr Rates kBowedRates{kRate, 45};
  CompileOptions options(Precision::kDouble);
  options.metered = false;
  const scene::Scene scene = settle(bowedString(speed, place, force, start), kBowedRates).scene;
  Player player(compile(scene, kBowedRates, options));
  player.ticks(static_cast<int>(seconds * kRate / kBowedRates.ratio));
  const std::vector<double>& string = player.heard[0];
  const std::vector<double>& hair = player.heard[1];
  const double period = kRate / kBowedPitch;
  const std::size_t first = string.size() - static_cast<std::size_t>(kJudged * period);
  constexpr double kStuck = 1e-6;  // m/s: what slips is far above that, what sticks far below
  Sound sound;
  std::vector<double> onsets;
  bool slipped = true;
  for (std::size_t n = first; n < string.size(); ++n) {
    const double slip = std::abs(string[n] - hair[n]);
    const bool slips = slip > kStuck;
    sound.slipping += slips ? 1.0 / static_cast<double>(string.size() - first) : 0.0;
    sound.stuck = slips ? sound.stuck : std::max(sound.stuck, slip);
    if (slips && !slipped) {
      onsets.push_back(static_cast<double>(n));
    }
    slipped = slips;
  }
  if (onsets.size() < 3) {
    return sound;
  }
  const double mean = (onsets.back() - onsets.front()) / static_cast<double>(onsets.size() - 1);
  sound.slips = period / mean;
  sound.cents = 1200.0 * std::log2(period / mean);
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    sound.ragged = std::max(sound.ragged, std::abs(onsets[i] - onsets[i - 1] - mean) / period);
  }
  return sound;
}

/// Of one speed and place: what was played, in order of forces.
struct Cell {
  double speed;
  double place;
  Limits limits{speed, place};
  std::vector<std::pair<double, Sound>> played = {};
  double from_rest = 0.0;  ///< N, the least force that starts it, 0: none

  double firstHelmholtz() const {
    for (const auto& [force, sound] : played) {
      if (sound.isHelmholtz()) {
        return force;
      }
    }
    return 0.0;
  }
  double lastHelmholtz() const {
    double last = 0.0;
    for (const auto& [force, sound] : played) {
      last = sound.isHelmholtz() ? force : last;
    }
    return last;
  }
};

/// The least force, in steps of 1.1, that brings a string at rest to Helmholtz motion.
double leastFromRest(const Cell& cell) {
  for (double force = cell.limits.least; force < cell.limits.most; force *= kRestStep) {
    if (playBowed(cell.speed, cell.place, force, Start::kRest, kRestSeconds).isHelmholtz()) {
      return force;
    }
  }
  return 0.0;
}

std::vector<Cell> playMap() {
  std::vector<Cell> map;
  for (const double speed : kSpeeds) {
    for (const double place : kPlaces) {
      Cell cell{speed, place};
      const double from = 0.5 * cell.limits.least;
      const double ratio = std::pow(3.0 * cell.limits.most / from, 1.0 / (kForces - 1));
      for (int i = 0; i < kForces; ++i) {
        const double force = from * std::pow(ratio, i);
        cell.played.emplace_back(force,
                                 playBowed(speed, place, force, Start::kHelmholtz, kBowedSeconds));
      }
      cell.from_rest = speed == kRestSpeed ? leastFromRest(cell) : 0.0;
      map.push_back(std::move(cell));
    }
  }
  return map;
}

void write(const std::vector<Cell>& map, const char* file) {
  std::ofstream out(file);
  out << "speed,place,least,most,force,slips,cents,ragged,slipping,stuck,helmholtz,from_rest\n";
  for (const Cell& cell : map) {
    for (const auto& [force, s] : cell.played) {
      out << cell.speed << ',' << cell.place << ',' << cell.limits.least << ',' << cell.limits.most
          << ',' << force << ',' << s.slips << ',' << s.cents << ',' << s.ragged << ','
          << s.slipping << ',' << s.stuck << ',' << s.isHelmholtz() << ',' << cell.from_rest
          << '\n';
    }
  }
}

/// Exponents of speed and place of a limit, by least squares of logarithms.
template <class LimitOf>
Eigen::Vector2d exponentsOf(const std::vector<Cell>& map, const LimitOf& limit_of) {
  Eigen::MatrixX3d left(map.size(), 3);
  Eigen::VectorXd right(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    left.row(row) << 1.0, std::log(map[i].speed), std::log(map[i].place);
    right[row] = std::log(limit_of(map[i]));
  }
  return left.colPivHouseholderQr().solve(right).tail<2>();
}

TEST(SchellengTest, StringsSoundBetweenTheForcesThatHeGives) {
  const std::vector<Cell> map = playMap();
  if (const char* const file = std::getenv("ERGOTIC_SCHELLENG")) {
    write(map, file);
  }
  for (const Cell& cell : map) {
    for (const auto& [force, sound] : cell.played) {
      SCOPED_TRACE(std::to_string(cell.speed) + " m/s at " + std::to_string(cell.place) + ", " +
                   std::to_string(force) + " N of " + std::to_string(cell.limits.least) + "..." +
                   std::to_string(cell.limits.most));
      EXPECT_LT(sound.stuck, 1e-9);
      const bool is_inside = force > 7.0 * cell.limits.least && force < 0.5 * cell.limits.most;
      const bool is_outside = force < 0.9 * cell.limits.least || force > 2.0 * cell.limits.most;
      EXPECT_FALSE(is_outside && sound.isHelmholtz());
      EXPECT_FALSE(is_inside && !sound.isHelmholtz())
          << sound.slips << " slips, " << sound.cents << " cents, " << sound.ragged;
    }
  }
  for (const Cell& cell : map) {
    if (cell.speed == kRestSpeed) {
      const double times = cell.from_rest / cell.limits.least;
      EXPECT_GT(times, 7.0) << cell.place;
      EXPECT_LT(times, 22.0) << cell.place;
    }
  }
  const auto least = exponentsOf(map, [](const Cell& c) { return c.limits.least; });
  const auto most = exponentsOf(map, [](const Cell& c) { return c.limits.most; });
  const auto first = exponentsOf(map, [](const Cell& c) { return c.firstHelmholtz(); });
  const auto last = exponentsOf(map, [](const Cell& c) { return c.lastHelmholtz(); });
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(first[k] / least[k], 1.0, 0.25) << (k == 0 ? "speed" : "place");
    EXPECT_NEAR(last[k] / most[k], 1.0, 0.25) << (k == 0 ? "speed" : "place");
  }
}

}  // namespace
}  // namespace ergotic::physics
