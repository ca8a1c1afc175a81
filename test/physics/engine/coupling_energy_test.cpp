// SPDX-License-Identifier: BSD-3-Clause
// The energy accounts across rates: what hold and mean make has an entry of its own, and the
// balance fails where a coupling does not hold what its positions say.
#include <numeric>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A slow mass that is thrown, on a spring-damper to a fast one with a spring of its own.
struct Joined {
  int ratio = 14;
  double kappa = 0.1;  ///< of the spring between them, by the slow step and the fast mass
  double zeta = 0.1;   ///< of its damper
  double own = 0.3;    ///< of the spring of the fast mass

  static constexpr double kSlowKg = 1.0;
  static constexpr double kFastKg = 0.3;

  double slowRate() const { return kRate / ratio; }
  double stiffness() const { return kappa * kFastKg * slowRate() * slowRate(); }

  SceneBuilder scene() const {
    SceneBuilder b;
    const int slow = b.mass(kSlowKg, 0.0, std::sqrt(10.0), SceneBuilder::kGestural);
    const int fast = b.mass(kFastKg);
    b.spring(slow, fast, stiffness(), zeta * kFastKg * slowRate());
    b.spring(fast, b.ground(), own * kFastKg * slowRate() * slowRate());
    b.hear(slow, 0);
    b.hear(fast, 1);
    return b;
  }
};

/// Stored and dissipated, and what couplings made.
struct Sums {
  double kept = 0.0;
  double dissipated = 0.0;
  double made = 0.0;

  explicit Sums(const Energies& energies) : kept(energies.stored) {
    for (const SectionEnergy& section : energies.sections) {
      dissipated += section.dissipated;
    }
    for (const CouplingEnergy& coupling : energies.couplings) {
      dissipated += coupling.dissipated;
      made += coupling.made;
    }
  }
};

/// What hold and mean make of the positions that are heard, from the second tick on: at each step D
/// of the slow mass K D times the mean of the fast one over the ticks before and after, less its
/// place where the held one jumps.
double madeBy(const Joined& joined,
              const std::vector<double>& slow,
              const std::vector<double>& fast) {
  const int ratio = joined.ratio;
  const auto mean = [&](int tick) {
    const auto first = fast.begin() + tick * ratio;
    return std::accumulate(first, first + ratio, 0.0) / ratio;
  };
  double made = 0.0;
  for (int n = 1; n * ratio < static_cast<int>(fast.size()); ++n) {
    const std::size_t jump = at(n * ratio);
    const double here = 0.5 * (fast[jump - 1] + fast[jump]);
    made += (slow[jump] - slow[jump - 1]) * (0.5 * (mean(n - 1) + mean(n)) - here);
  }
  return joined.stiffness() * made;
}

TEST(CouplingEnergyTest, WhatIsDissipatedWasThereOrWasMade) {
  for (const int ratio : {2, 4, 14, 44}) {
    for (const double kappa : {0.03, 0.1, 0.4, 1.0}) {
      for (const double zeta : {0.0, 0.01, 0.1, 0.4}) {
        const Joined joined{ratio, kappa, zeta};
        Player player(joined.scene().scene, {kRate, ratio});
        player.tick();
        const Sums start(energiesOf(player));
        player.ticks(600);
        const Sums now(energiesOf(player));
        const double made = madeBy(joined, player.heard[0], player.heard[1]);
        EXPECT_NEAR(now.made - start.made, made, 1e-11) << ratio << " " << kappa << " " << zeta;
        EXPECT_NEAR(now.kept + now.dissipated - made, start.kept + start.dissipated, 1e-11)
            << ratio << " " << kappa << " " << zeta;
      }
    }
  }
}

TEST(CouplingEnergyTest, MoreThanThereWasIsDissipatedWhereSomeWasMade) {
  Player player(Joined{14, 1.0, 0.1}.scene().scene, {kRate, 14});
  player.ticks(601);
  const Energies now = energiesOf(player);
  const Sums sums(now);
  EXPECT_GT(sums.dissipated, 6.0) << "of 5 J";
  EXPECT_GT(sums.made, 3.0);
  EXPECT_NEAR(now.residual, 0.0, 1e-11);
}

TEST(CouplingEnergyTest, AtOneRateNothingIsMade) {
  SceneBuilder b = Joined{14, 0.1, 0.1}.scene();
  b.scene.sections[SceneBuilder::kGestural].gestural = false;
  Player player(b.scene, {kRate, 14});
  player.ticks(100);
  const Energies now = energiesOf(player);
  EXPECT_EQ(now.couplings.at(0).made, 0.0);
  EXPECT_GT(now.couplings[0].dissipated, 0.0);
  EXPECT_NEAR(now.residual, 0.0, 1e-12);
}

/// The state goes on in an instrument with a stiffer coupling: energy that nothing brought.
TEST(CouplingEnergyTest, BalanceFailsWhereASpringHoldsWhatNothingBrought) {
  const Joined joined{14, 0.1, 0.01};
  Joined stiffer = joined;
  stiffer.kappa *= 1.5;
  Player player(joined.scene().scene, {kRate, 14});
  player.ticks(40);
  EXPECT_NEAR(energiesOf(player).residual, 0.0, 1e-12);
  std::vector<unsigned char> state(player.instrument->stateSize());
  player.instrument->saveState(state.data());
  Player other(stiffer.scene().scene, {kRate, 14});
  other.instrument->loadState(state.data());
  const double brought = 0.5 * energiesOf(player).couplings.at(0).stored;
  EXPECT_GT(brought, 1e-3);
  EXPECT_NEAR(energiesOf(other).residual, brought, 1e-12);
}

}  // namespace
}  // namespace ergotic::physics
