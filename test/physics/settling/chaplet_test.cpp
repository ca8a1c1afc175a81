// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/chaplet.hpp"

#include <complex>

#include <Eigen/Eigenvalues>

#include "ergotic/physics/engine/instrument.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kChapletMass = 0.0012;

Chaplet c2(int ratio) {
  return tunedChaplet(scene::kChapletC2, kChapletMass, 1.0 / kRate, ratio);
}
Chaplet c3(int ratio) {
  return tunedChaplet(scene::kChapletC3, kChapletMass, 1.0 / kRate, ratio);
}

/// Z = 0.05 m wN, the heaviest load a chaplet is made for.
ChapletLoad fullLoad(const Chaplet& chaplet) {
  return {0.0, 0.05 * chaplet.mass() * 2.0 * kPi * chaplet.nyquistHz()};
}

/// dB, at a share of fN.
double levelAt(const Chaplet& chaplet, double share, const ChapletLoad& load = {}) {
  return decibels(chaplet.gain(share * chaplet.nyquistHz(), load));
}

struct Band {
  double lowest;
  double highest;
};
Band bandTo(const Chaplet& chaplet, double edge, const ChapletLoad& load) {
  Band band{0.0, 0.0};
  for (int i = 1; i <= 2000; ++i) {
    const double level = levelAt(chaplet, edge * i / 2000.0, load);
    band = {std::min(band.lowest, level), std::max(band.highest, level)};
  }
  return band;
}

/// Where the response has fallen to a level, in fN.
double shareAt(const Chaplet& chaplet, double level) {
  double below = 0.5;
  double above = 1.0;
  while (above - below > 1e-9) {
    const double middle = 0.5 * (below + above);
    (levelAt(chaplet, middle) > level ? below : above) = middle;
  }
  return below;
}

/// Published figures, dB; frequencies in fN.
struct Design {
  const char* name;
  Chaplet chaplet;
  Band free;
  Band loaded;
  double corner;
  double at_nyquist;
  double at_image;
  double series;  // K/(m wN^2)
};

std::vector<Design> designs() {
  return {
      {"C2 R=4", c2(4), {-0.36, 1.37}, {-1.78, 0.0}, 0.568, 19.4, 29.9, 0.0074},
      {"C2 R=14", c2(14), {-0.17, 1.42}, {-1.98, 0.0}, 0.558, 21.6, 33.1, 0.0074},
      {"C2 R=44", c2(44), {-0.14, 1.49}, {-2.04, 0.0}, 0.556, 22.0, 33.6, 0.0074},
      {"C3 R=14", c3(14), {-0.87, 2.05}, {-2.05, 0.0}, 0.568, 24.6, 38.6, 0.0038},
      {"C3 R=44", c3(44), {-0.94, 1.98}, {-2.08, 0.0}, 0.562, 25.0, 39.4, 0.0038},
  };
}

// The figures were read off a grid of frequencies: its last point below 0.5 fN is at 0.4982 fN,
// where the free response falls by 0.035 dB per 0.001 fN; the corner is its first point below -3
// dB.
constexpr double kEdge = 0.4982;
constexpr double kGridStep = 0.0035;
constexpr double kTolerance = 0.05;
constexpr double kPrinted = 0.05;  // one digit after the point

TEST(ChapletTest, PassbandsAreThoseOfTheDesigns) {
  for (const Design& d : designs()) {
    const Band free = bandTo(d.chaplet, kEdge, {});
    EXPECT_NEAR(free.lowest, d.free.lowest, kTolerance) << d.name;
    EXPECT_NEAR(free.highest, d.free.highest, 0.01) << d.name;
    const Band loaded = bandTo(d.chaplet, kEdge, fullLoad(d.chaplet));
    EXPECT_NEAR(loaded.lowest, d.loaded.lowest, kTolerance) << d.name;
    EXPECT_NEAR(loaded.highest, d.loaded.highest, 0.01) << d.name;
    EXPECT_NEAR(shareAt(d.chaplet, -3.0), d.corner, kGridStep) << d.name;
  }
}

TEST(ChapletTest, StopbandsAreThoseOfTheDesigns) {
  for (const Design& d : designs()) {
    EXPECT_NEAR(-levelAt(d.chaplet, 1.0), d.at_nyquist, kTolerance + kPrinted) << d.name;
    EXPECT_NEAR(-levelAt(d.chaplet, 1.5), d.at_image, kTolerance + kPrinted) << d.name;
    const double nyquist = 2.0 * kPi * d.chaplet.nyquistHz();
    EXPECT_NEAR(d.chaplet.seriesStiffness() / (kChapletMass * nyquist * nyquist), d.series, 5e-5)
        << d.name;
  }
}

TEST(ChapletTest, ResponseIsThatOfTheseNumbers) {
  // To three digits, worked out from the tables on their own: any other number in C2 changes them.
  const struct {
    int ratio;
    double levels[5];  // free, at 0.25, 0.5, 0.7, 1, 1.5 fN
    double loaded;     // at 0.5 fN
  } rows[] = {
      {4, {1.103, -0.431, -9.109, -19.450, -29.962}, -1.828},
      {14, {0.722, -0.254, -10.536, -21.654, -33.089}, -2.032},
      {44, {0.621, -0.184, -10.825, -22.055, -33.575}, -2.069},
  };
  const double shares[] = {0.25, 0.5, 0.7, 1.0, 1.5};
  for (const auto& row : rows) {
    const Chaplet chaplet = c2(row.ratio);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(levelAt(chaplet, shares[i]), row.levels[i], 1e-3) << row.ratio << " " << i;
    }
    EXPECT_NEAR(levelAt(chaplet, 0.5, fullLoad(chaplet)), row.loaded, 1e-3) << row.ratio;
  }
}

TEST(ChapletTest, ReachesWhatItIsUsedForFromItsLowestRatioOn) {
  for (int ratio = scene::kChapletC2LowestRatio; ratio <= kMaxRatio; ++ratio) {
    const Chaplet chaplet = c2(ratio);
    for (const ChapletLoad& load : {ChapletLoad{}, fullLoad(chaplet)}) {
      const Band band = bandTo(chaplet, 0.5, load);
      EXPECT_GE(band.lowest, -2.1) << ratio;
      EXPECT_LE(band.highest, 1.5) << ratio;
    }
    EXPECT_LE(levelAt(chaplet, 1.0), -19.0) << ratio;
    EXPECT_LE(levelAt(chaplet, 1.5), -29.0) << ratio;
    const double image = 1.5 * chaplet.nyquistHz();
    EXPECT_LE(levelAt(chaplet, 1.5) + decibels(chaplet.holdGain(image)), -39.9) << ratio;
  }
}

TEST(ChapletTest, IsFeltAsItsMassAtLowFrequencies) {
  const Chaplet chaplet = c2(14);
  const double nyquist = chaplet.nyquistHz();
  EXPECT_NEAR(chaplet.apparentMass(0.02 * nyquist, {}) / kChapletMass, 1.04, 0.01);
  EXPECT_NEAR(chaplet.apparentMass(0.05 * nyquist, {}) / kChapletMass, 1.11, 0.01);
  EXPECT_NEAR(chaplet.apparentDamping(0.02 * nyquist, {}) / (kChapletMass * 2.0 * kPi * nyquist),
              4e-4, 1e-4);
  EXPECT_NEAR(chaplet.apparentDamping(1e-4 * nyquist, {}), 0.0, 1e-6);
}

TEST(ChapletTest, GivesWayToASpringAsItsOwnSpringsInSeries) {
  const Chaplet chaplet = c2(14);
  const double load = 0.3 * chaplet.seriesStiffness();
  EXPECT_NEAR(chaplet.gain(1e-3, {load, 0.0}), 1.0 / 1.3, 1e-6);
}

/// Largest eigenvalue of M^-1 (h^2 K + 2 h Z) with the slower end held.
double lambdaOf(const Chaplet& chaplet) {
  const auto n = static_cast<Eigen::Index>(chaplet.stages().size());
  const double h = 1.0 / kRate;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const scene::ChapletStage& stage = chaplet.stages()[static_cast<std::size_t>(i)];
    const double load = h * h * stage.stiffness + 2.0 * h * stage.damping;
    m(i, i) = stage.mass;
    a(i, i) += load;
    if (i > 0) {
      a(i - 1, i - 1) += load;
      a(i, i - 1) -= load;
      a(i - 1, i) -= load;
    }
  }
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(a, m).eigenvalues().maxCoeff();
}

TEST(ChapletTest, IsStableFromItsLowestRatioOn) {
  EXPECT_NEAR(lambdaOf(c2(4)), 0.90, 0.01);
  EXPECT_NEAR(lambdaOf(c2(8)), 0.42, 0.01);
  EXPECT_NEAR(lambdaOf(c2(14)), 0.23, 0.01);
  EXPECT_NEAR(lambdaOf(c2(44)), 0.07, 0.01);
  EXPECT_NEAR(lambdaOf(c3(4)), 5.8, 0.1);
  EXPECT_NEAR(lambdaOf(c3(scene::kChapletC3LowestRatio)), 2.65, 0.02);
  EXPECT_NEAR(lambdaOf(c3(14)), 1.45, 0.01);
}

/// \return the last mass of a chaplet on a slice
int addChaplet(SceneBuilder& builder, const Chaplet& chaplet) {
  int last = builder.slice(0);
  for (const scene::ChapletStage& stage : chaplet.stages()) {
    const int mass = builder.mass(stage.mass);
    builder.spring(last, mass, stage.stiffness, stage.damping);
    last = mass;
  }
  return last;
}

/// Amplitudes of the last mass at p/q and 2 - p/q of fN for a held sine at p/q of fN.
Band heardLevels(const Chaplet& chaplet, const ChapletLoad& load, int p, int q) {
  SceneBuilder b;
  const int last = addChaplet(b, chaplet);
  b.spring(last, b.ground(), load.stiffness, load.damping);
  b.hear(last);
  Player player(b.scene, {kRate, chaplet.ratio()});
  const int period = 2 * q;  // ticks after which slice and sound repeat
  const int settling = 150 * period;
  for (int n = 0; n < settling + period; ++n) {
    player.positions[0] = 1e-3 * std::cos(kPi * p * n / q);
    player.tick();
  }
  const auto level = [&](double share) {
    const int frames = period * chaplet.ratio();
    std::complex<double> sum = 0.0;
    for (int m = 0; m < frames; ++m) {
      const auto frame = player.heard[0].size() - at(frames - m);
      sum += player.heard[0][frame] * std::polar(1.0, -kPi * share * m / chaplet.ratio());
    }
    return decibels(2.0 * std::abs(sum) / frames / 1e-3);
  };
  const double share = static_cast<double>(p) / q;
  return {level(share), level(2.0 - share)};
}

TEST(ChapletTest, InstrumentRespondsAsComputedFreeAndLoaded) {
  for (const Design& d : designs()) {
    for (const ChapletLoad& load : {ChapletLoad{}, fullLoad(d.chaplet)}) {
      const double nyquist = d.chaplet.nyquistHz();
      for (const int p : {1, 2, 3, 4, 5, 6, 7}) {
        const Band heard = heardLevels(d.chaplet, load, p, 8);
        const double share = p / 8.0;
        for (const auto& [level, at] :
             {std::pair{heard.lowest, share}, std::pair{heard.highest, 2.0 - share}}) {
          const double expected =
              levelAt(d.chaplet, at, load) + decibels(d.chaplet.holdGain(at * nyquist));
          EXPECT_NEAR(level, expected, 1e-6) << d.name << " at " << at << " fN";
        }
      }
    }
  }
}

TEST(ChapletTest, GeneratedChapletsAreFoundWithTheirLoads) {
  SceneBuilder builder;
  const Chaplet chaplet = c2(14);
  const int last = addChaplet(builder, chaplet);
  builder.scene.mats[1].name = "pick.0";
  const int string = builder.chain(20, 1e-4, 2000.0);
  builder.link(scene::LiaType::kContact, last, string + 10, 1e4);
  const Rates rates{kRate, 14};
  const auto found = findChaplets(builder.scene, rates);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "pick");
  EXPECT_EQ(found[0].chaplet.ratio(), 14);
  EXPECT_DOUBLE_EQ(found[0].chaplet.mass(), kChapletMass);
  EXPECT_NEAR(found[0].load.damping, 2.0 * std::sqrt(2000.0 * 1e-4), 1e-12);
  EXPECT_NEAR(found[0].load.stiffness, 2000.0 / 10.0 + 2000.0 / 11.0, 1e-9);
  builder.scene.mats[1].mass.factor *= 1.01;
  EXPECT_TRUE(findChaplets(builder.scene, rates).empty());
}

}  // namespace
}  // namespace ergotic::physics
