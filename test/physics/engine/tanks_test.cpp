// SPDX-License-Identifier: BSD-3-Clause
// One energy tank for all hardening links of a body: stretches, and nets of cubic links.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kLength = 0.65;

scene::Scene sceneOf(const std::string& text) {
  return scene::readYaml("ergotic: 1\n" + text, "tanks.yaml");
}

/// A string whose tension rises, in its first mode.
scene::Scene stretched(int masses, double hardening, double amplitude, const std::string& more) {
  scene::Scene scene = sceneOf(
      "sections: {a: {}}\ngenerators:\n  - {type: string, name: s, section: a, masses: " +
      std::to_string(masses) + ", mass: 1e-4, frequency: 110, to: [" + number(kLength) +
      ", 0]}\nlias:\n  tension: {type: stretch, of: s, spacing: " + number(kLength / (masses + 1)) +
      ", hardening: " + number(hardening) + "}\n" + more);
  for (int i = 1; i <= masses; ++i) {
    scene.mats[at(i)].position.x() = amplitude * std::sin(kPi * i / (masses + 1));
  }
  return scene;
}

const char kHeard[] = "outputs: {x: {at: s@0.5, quantity: position, channel: 1}}\n";

double pitchOf(const scene::Scene& scene, Precision precision) {
  Player player(scene, kEveryFrame, precision);
  player.ticks(12000);
  const std::vector<double>& x = player.heard[0];
  double first = -1.0;
  double last = 0.0;
  int periods = -1;
  for (std::size_t n = 1; n < x.size(); ++n) {
    if (x[n - 1] < 0.0 && x[n] >= 0.0) {
      last = static_cast<double>(n) - x[n] / (x[n] - x[n - 1]);
      first = first < 0.0 ? last : first;
      ++periods;
    }
  }
  return kRate * periods / (last - first);
}

TEST(TanksTest, AStretchedStringGlidesByTheFormula) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    for (const double r : {0.9, 0.99}) {
      const double hardening = r / (1.0 - r);
      const double base = pitchOf(stretched(60, hardening, 1e-6 * kLength, kHeard), precision);
      for (const double share : {0.002, 0.005, 0.01}) {
        const double pitch = pitchOf(stretched(60, hardening, share * kLength, kHeard), precision);
        const double expected = 1602.0 * hardening * share * share;
        if (expected > 0.2) {  // what zeros of the sound tell at all
          EXPECT_NEAR(1200.0 * std::log2(pitch / base) / expected, 1.0, 0.03) << r << ", " << share;
        }
      }
    }
  }
}

/// Its tank is no memory: psi is a function of two positions, and the mean of both psi, which is
/// the force, solves one linear equation.
TEST(TanksTest, AStretchIsTheSchemeOfKirchhoffAndCarrier) {
  constexpr int kMasses = 7;
  constexpr double kHardening = 500.0;
  scene::Scene scene = stretched(kMasses, kHardening, 0.02, kHeard);
  scene.mats[3].position.x() += 0.004;
  scene.outputs[0].point = {3};
  const scene::Scene settled = settle(scene, kEveryFrame).scene;
  const double kappa = settled.lias[0].stiffness.factor / 1e-4 / (kRate * kRate);
  const double a = kLength / (kMasses + 1);
  using State = Eigen::Matrix<double, kMasses, 1>;
  const auto pull = [&](const State& x) -> State {
    State f = 2.0 * x;
    f.tail<kMasses - 1>() -= x.head<kMasses - 1>();
    f.head<kMasses - 1>() -= x.tail<kMasses - 1>();
    return kappa * f;
  };
  const auto meanOf = [&](const State& x, const State& y) {
    return x.dot(pull(y)) / kappa / (2.0 * a * a * (kMasses + 1));
  };
  State last;
  for (int i = 0; i < kMasses; ++i) {
    last[i] = scene.mats[at(i + 1)].position.x();
  }
  State x = last;  // the first step is made without links
  Player player(settled, kEveryFrame);
  for (int n = 0; n < 3000; ++n) {
    player.tick();
    ASSERT_NEAR(player.heard[0].back(), x[2], 1e-9 * 0.02) << n;
    const State harder = 0.5 * kHardening * pull(x);
    const State free = 2.0 * x - last - pull(x);
    const double before = meanOf(x, last);
    const double after = (meanOf(x, free) - meanOf(x, harder) * before) / (1.0 + meanOf(x, harder));
    last = x;
    x = free - harder * (before + after);
  }
  std::vector<TankReport> reports = player.instrument->makeTankReports();
  player.instrument->readTanks(reports);
  EXPECT_EQ(reports.at(0).active, 3000);
  EXPECT_EQ(reports.at(0).clipped, 0);
}

/// Masses on springs, in a row and each to the ground, with hardening links beside.
scene::Scene net(double speed, double q, const std::string& keys, const std::string& more = "") {
  std::string text = "sections: {a: {}}\nmats:\n  g: {type: ground}\n";
  std::string lias;
  for (int i = 0; i < 8; ++i) {
    const std::string m = "m" + std::to_string(i);
    const std::string to = i == 0 ? "g" : "m" + std::to_string(i - 1);
    const std::string ends = "between: [" + m + ", " + to + "], ";
    text += "  " + m + ": {type: mass, mass: 1e-3, v: " + number(speed * (i % 3 - 0.9)) + "}\n";
    lias += "  k" + m + ": {type: spring, " + ends + "stiffness: 2e5}\n  q" + m +
            ": {type: cubic, " + ends + "stiffness: 0, nonlinearity: " + number(q) + keys + "}\n";
  }
  return sceneOf(text + "lias:\n" + lias + more);
}

/// Stored energy never rises; and of what loses nothing it stays.
void expectPassive(const scene::Scene& scene, bool keeps, const std::string& what) {
  Player player(scene, kRates);
  player.tick();
  const double start = energiesOf(player).stored;
  double least = start;
  double most = start;
  for (int n = 0; n < 3000; ++n) {
    player.tick();
    const Energies energies = energiesOf(player);
    least = std::min(least, energies.stored);
    most = std::max(most, energies.stored);
    ASSERT_LT(std::abs(energies.residual), 1e-10 * start) << what << ", tick " << n;
  }
  EXPECT_LT(most, start * (1.0 + 1e-10)) << what;
  if (keeps) {
    EXPECT_GT(least, start * (1.0 - 1e-10)) << what;
  } else {
    EXPECT_LT(least, start * (1.0 - 1e-6)) << what;
  }
}

TEST(TanksTest, KeepEnergyHoweverHardTheyAre) {
  for (const double hardening : {1.0, 100.0, 1e5}) {
    expectPassive(stretched(20, hardening, 0.03, kHeard), true, number(hardening));
  }
  for (const double q : {1e7, 1e10, 1e13, 1e16}) {
    expectPassive(net(3.0, q, ", tank: net"), true, number(q));
  }
}

/// Energy-stable links on the same modules are worked out as if the tank did not answer.
TEST(TanksTest, NeitherTheyNorTheEnergyStableLinksOnTheirModulesMakeEnergy) {
  const std::string more =
      "  hit: {type: contact, between: [m3, g], stiffness: 3e5, scheme: energy_stable}\n"
      "  felt: {type: felt, between: [m7, m2], stiffness: 1e7, exponent: 2, damping: 0.3}\n"
      "  rub: {type: friction, between: [m5, m4], normal: 20, steady: 0.2, parts: [[0.6, 0.1]]}\n"
      "  own: {type: cubic, between: [m1, g], stiffness: 0, nonlinearity: 1e10}\n";
  for (const double q : {1e7, 1e10, 1e13}) {
    expectPassive(net(3.0, q, ", tank: net", more), false, number(q));
  }
}

/// Where steps are short against the motion, links in one tank play what each plays by itself.
TEST(TanksTest, AreCubicSpringsWhereStepsAreShort) {
  static constexpr int kTimes = 441;  // of the audio rate
  const auto heardOf = [](int times, const std::string& keys) {
    scene::Scene scene = net(0.5, 3e10, keys);
    scene.outputs.push_back({});
    scene.outputs.back().name = "x";
    scene.outputs.back().point.mat = 6;
    Player player(scene, {times * kRate, 1});
    player.ticks(times * kTimes);
    Eigen::VectorXd heard(kTimes);
    for (int n = 0; n < kTimes; ++n) {
      heard[n] = player.heard[0][at((n + 1) * times - 1)];
    }
    return heard;
  };
  const Eigen::VectorXd exact = heardOf(64, ", scheme: explicit");
  const double coarse = (heardOf(4, ", tank: net") - exact).norm();
  const double fine = (heardOf(8, ", tank: net") - exact).norm();
  EXPECT_LT(fine, 0.05 * exact.norm());
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);  // of second order
}

TEST(TanksTest, ChangeNoBitWithoutEnergiesOrWithThreadsAndGoOnFromWhereTheyWereSaved) {
  for (const char* keys : {", tank: net", ", tank: net, rest_length: 1e-4"}) {
    scene::Scene scene = net(3.0, 1e11, keys);
    scene.outputs.push_back({});
    scene.outputs.back().name = "x";
    scene.outputs.back().point.mat = 6;
    const scene::Scene settled = settle(scene, kRates).scene;
    CompileOptions plain(Precision::kDouble);
    plain.metered = false;
    plain.threads = 2;
    Player metered(compile(settled, kRates, Precision::kDouble));
    Player other(compile(settled, kRates, plain));
    Player late(compile(settled, kRates, plain));
    metered.ticks(100);
    other.ticks(100);
    std::vector<std::byte> state(other.instrument->stateSize());
    other.instrument->saveState(state.data());
    late.instrument->loadState(state.data());
    metered.ticks(100);
    other.ticks(100);
    late.ticks(100);
    EXPECT_EQ(metered.heard, other.heard) << keys;
    EXPECT_TRUE(std::equal(late.heard[0].rbegin(), late.heard[0].rend(), other.heard[0].rbegin()));
  }
}

TEST(TanksTest, KnobsThatTurnThemAreInTheEnergyAccounts) {
  scene::Scene scene = sceneOf(R"(
parameters: {hard: {value: 10, range: [0, 1000]}}
sections: {a: {}}
generators:
  - {type: string, name: s, section: a, masses: 20, mass: 1e-4, stiffness: 2e4, to: [0.65, 0],
     pluck: {at: 0.3, height: 0.02}}
lias: {tension: {type: stretch, of: s, spacing: 0.03, hardening: $hard}}
)");
  Player player(scene, kRates);
  player.ticks(100);
  double most = 0.0;
  for (int n = 0; n < 400; ++n) {
    player.instrument->exchange(player.instrument->prepare({10.0 + n}));
    player.tick();
    const Energies energies = energiesOf(player);
    ASSERT_LT(std::abs(energies.residual), 1e-9 * energies.stored) << n;
    most = std::max(most, std::abs(energies.from_parameters) / energies.stored);
  }
  EXPECT_GT(most, 0.01);
}

Verdict verdictOf(const scene::Scene& scene) {
  return certify(settle(scene, kRates).scene, kRates).verdict;
}

TEST(TanksTest, ArePassiveOverAPassiveNetwork) {
  EXPECT_EQ(verdictOf(stretched(20, 1e5, 0.03, kHeard)), Verdict::kPassive);
  EXPECT_EQ(verdictOf(net(3.0, 1e13, ", tank: net")), Verdict::kPassive);
  EXPECT_EQ(verdictOf(net(3.0, 1e13, ", scheme: explicit")), Verdict::kUnproven);
}

/// Beside a mass that is coupled to a faster section, as all that is not linear.
TEST(TanksTest, AStretchIsOfItsOwnSpringsWhateverOthersAreCalled) {
  const std::string string = "{type: string, masses: 4, mass: 1e-3, stiffness: 1e4, to: [1, 0]";
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {a: {}}\ngenerators: [" + string + ", name: s}, " + string +
          ", name: s.link}]\nlias: {h: {type: stretch, of: s, spacing: 0.2, hardening: 9}}\n",
      "names.yaml");
  EXPECT_EQ(scene.tanks.at(0).springs, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(TanksTest, AStretchIsOfWholeBodiesAndSingleLinksAlike) {
  const scene::Scene scene = sceneOf(R"(
sections: {a: {}}
mats: {hook: {type: mass, mass: 1e-3}}
generators:
  - {type: string, name: s, section: a, masses: 4, mass: 1e-3, stiffness: 1e4, to: [1, 0]}
  - {type: mesh, name: skin, rows: 3, columns: 4, spacing: 0.1, mass: 1e-3, stiffness: 100}
lias:
  pull: {type: spring, between: [hook, skin.1.1], stiffness: 100}
  h: {type: stretch, of: [skin, pull, s], spacing: 0.2, hardening: 9}
)");
  const std::vector<int>& springs = scene.tanks.at(0).springs;
  std::vector<std::string> names;
  for (const int l : springs) {
    names.push_back(scene.lias[at(l)].name.str());
  }
  EXPECT_EQ(std::count(names.begin(), names.end(), "pull"), 1);
  EXPECT_THAT(names, testing::IsSupersetOf({"s.link.0", "s.link.4", "skin.link.0", "skin.link.6"}));
  EXPECT_EQ(names.size(), 5U + 7U + 1U);
}

/// In a section that makes its first step later than the first tick, too.
TEST(TanksTest, AreFilledBeforeTheFirstStep) {
  for (const char* const hard :
       {"{type: stretch, of: [s], spacing: 0.01, hardening: 300}",
        "{type: cubic, between: [m, g], stiffness: 0, nonlinearity: 1e11, tank: t}"}) {
    const scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections: {a: {rate: {divisor: 28}}}\n"
        "mats: {g: {type: ground}, m: {type: mass, mass: 1, x: 1e-3, v: 0.5}}\nlias:\n"
        "  s: {type: spring, between: [m, g], stiffness: 1e5}\n  h: " +
            std::string(hard) + "\n",
        "slow.yaml");
    Player player(scene, {kRate, 14});
    const double start = energiesOf(player).stored;
    player.ticks(2000);
    EXPECT_LT(std::abs(energiesOf(player).residual), 1e-10 * start) << hard;
  }
}

TEST(TanksTest, AreUnprovenWhereTwoRatesMeet) {
  EXPECT_EQ(verdictOf(sceneOf(R"(
sections: {a: {}, s: {rate: {divisor: 7}}}
mats:
  m: {type: mass, section: a, mass: 0.01}
  n: {type: mass, section: s, mass: 0.01}
  g: {type: ground, section: s}
lias:
  k: {type: spring, between: [m, n], stiffness: 100}
  l: {type: spring, between: [n, g], stiffness: 100}
  q: {type: cubic, between: [n, g], stiffness: 0, nonlinearity: 1e6, tank: t}
)")),
            Verdict::kUnproven);
}

}  // namespace
}  // namespace ergotic::physics
