// SPDX-License-Identifier: BSD-3-Clause
// What holds for every scene, tried on random ones.

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/physics.hpp"
#include "support/random_scene.hpp"

namespace ergotic::physics {
namespace {

using test::RandomScene;

constexpr unsigned kScenes = 520;
constexpr unsigned kBlock = 40;  // scenes per test
constexpr int kTicks = 2000;
constexpr int kMaxTicks = kTicks << 8;
constexpr double kFar = 1e6;        // of energy: nobody need go on
constexpr double kMaxGrowth = 1e3;  // near its limit a stable step breathes by 4/(4 - lambda)
constexpr double kCreated = 1e-11;  // of the energy at the start
constexpr double kDrift = 1e-3;     // of the mean energy

/// What was seen of the energy of a scene. All but the residual in units of that at the start.
struct Seen {
  double growth = 0.0;    ///< largest kinetic energy
  double stored = 0.0;    ///< most that was stored beyond what there was
  double created = 0.0;   ///< the same with what was dissipated
  double residual = 0.0;  ///< of the largest energy stored
  double early = 0.0;     ///< mean of what was stored over the first half
  double late = 0.0;      ///< and over the second
};

double kineticEnergyAtStart(const scene::Scene& scene) {
  double energy = 0.0;
  for (const scene::Mat& mat : scene.mats) {
    energy += 0.5 * mat.mass.factor * mat.push->velocity.squaredNorm();
  }
  return energy;
}

/// Sums over sections.
struct SectionSums {
  double kinetic = 0.0;
  double dissipated = 0.0;
};

SectionSums sumsOf(const Energies& energies) {
  SectionSums sums;
  for (const SectionEnergy& section : energies.sections) {
    sums.kinetic += std::abs(section.kinetic);
    sums.dissipated += section.dissipated;
  }
  for (const CouplingEnergy& coupling : energies.couplings) {
    sums.dissipated += coupling.dissipated;
  }
  return sums;
}

/// Weight of a tick in the mean over its half; smooth at both ends, as no window holds whole
/// periods.
double weightOf(int tick, int ticks) {
  const int half = ticks / 2;
  return (1.0 - std::cos(2.0 * kPi * tick / half)) / half;
}

Seen playAndWatch(const scene::Scene& scene, const Rates& rates, int ticks) {
  Player player(compile(scene, rates, Precision::kDouble));
  Energies energies = player.instrument->makeEnergies();
  Seen seen;
  double unit = kineticEnergyAtStart(scene);
  double stored = 0.0;  // at the start
  double spent = 0.0;
  double most = 0.0;
  for (int n = 0; n < ticks && seen.growth < kFar; ++n) {
    player.tick();
    player.instrument->readEnergies(energies);
    const SectionSums sums = sumsOf(energies);
    if (n == 0) {
      stored = energies.stored;
      spent = stored + sums.dissipated;
      unit = std::max(unit, std::abs(stored));
    }
    // A number that is none compares false with everything.
    seen.growth = sums.kinetic <= kFar * unit ? std::max(seen.growth, sums.kinetic / unit) : kFar;
    seen.stored = std::max(seen.stored, (energies.stored - stored) / unit);
    seen.created = std::max(seen.created, (energies.stored + sums.dissipated - spent) / unit);
    most = std::max({most, std::abs(energies.stored), sums.kinetic});
    seen.residual = std::max(seen.residual, std::abs(energies.residual));
    (n < ticks / 2 ? seen.early : seen.late) += weightOf(n, ticks) * energies.stored / unit;
  }
  seen.residual /= most;
  return seen;
}

/// Links of a settled scene that are not linear.
struct Links {
  int energy_stable = 0;
  int other = 0;
};

Links linksOf(const scene::Scene& scene) {
  Links links;
  for (const scene::Lia& lia : scene.lias) {
    const bool is_energy_stable = lia.scheme == Scheme::kEnergyStable;
    links.energy_stable += is_energy_stable ? 1 : 0;
    links.other += !is_energy_stable && lia.type != LiaType::kSpringDamper ? 1 : 0;
  }
  return links;
}

bool isScalar(const scene::Scene& scene) {
  return std::all_of(scene.sections.begin(), scene.sections.end(), [](const scene::Section& s) {
    return s.geometry == scene::Geometry::kScalar;
  });
}

/// Two modes that nearly meet across the rates take turns over a very long time: then only a longer
/// mean tells whether it drifts. One that grows drifts more over a longer one.
double driftOf(const scene::Scene& scene, const Rates& rates) {
  double drift = 1.0;
  for (int ticks = kTicks; ticks <= kMaxTicks && std::abs(drift) > kDrift; ticks *= 4) {
    const Seen seen = playAndWatch(scene, rates, ticks);
    drift = seen.late / seen.early - 1.0;
  }
  return drift;
}

class PropertyTest : public testing::TestWithParam<unsigned> {};

void expectProperties(const RandomScene& random) {
  const Settled settled = settle(random.scene, random.rates);
  const Verdict verdict = certify(settled.scene, random.rates).verdict;
  const Seen seen = playAndWatch(settled.scene, random.rates, kTicks);
  EXPECT_LE(seen.residual, kUnbalanced);
  if (verdict != Verdict::kPassive && verdict != Verdict::kBounded) {
    return;
  }
  const Links links = linksOf(settled.scene);
  EXPECT_LE(seen.growth, kMaxGrowth);
  if (!random.has_two_rates && links.other == 0) {
    EXPECT_LE(seen.created, kCreated);
    if (random.is_lossless) {
      EXPECT_LE(seen.stored, kCreated);
    }
  }
  if (random.has_two_rates && random.is_lossless && links.energy_stable + links.other == 0 &&
      isScalar(settled.scene)) {
    EXPECT_LE(std::abs(driftOf(settled.scene, random.rates)), kDrift);
  }
}

TEST_P(PropertyTest, EnergyOfRandomScenesIsWhatTheCertificatePromises) {
  for (unsigned seed = GetParam(); seed < GetParam() + kBlock; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expectProperties(test::randomScene(seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PropertyTest, testing::Range(0u, kScenes, kBlock));

TEST(RandomSceneTest, ScenesAreOfAllKinds) {
  constexpr unsigned kCounted = kScenes / 5;
  unsigned two_rates = 0;
  unsigned nonlinear = 0;
  unsigned near_limit = 0;
  unsigned certified = 0;
  unsigned certified_near = 0;
  for (unsigned seed = 0; seed < kCounted; ++seed) {
    const RandomScene random = test::randomScene(seed);
    EXPECT_GE(random.scene.mats.size(), 20u) << "seed " << seed;
    const Settled settled = settle(random.scene, random.rates);
    const Verdict verdict = certify(settled.scene, random.rates).verdict;
    const bool is_certified = verdict == Verdict::kPassive || verdict == Verdict::kBounded;
    two_rates += random.has_two_rates ? 1 : 0;
    nonlinear += random.is_nonlinear ? 1 : 0;
    near_limit += random.is_near_limit ? 1 : 0;
    certified += is_certified ? 1 : 0;
    certified_near += is_certified && random.is_near_limit ? 1 : 0;
  }
  EXPECT_GT(two_rates, kCounted / 2);
  EXPECT_GT(nonlinear, 9 * kCounted / 20);
  EXPECT_GT(near_limit, 3 * kCounted / 10);
  EXPECT_GT(certified, 2 * kCounted / 5);
  EXPECT_GT(certified_near, kCounted / 10);
}

}  // namespace
}  // namespace ergotic::physics
