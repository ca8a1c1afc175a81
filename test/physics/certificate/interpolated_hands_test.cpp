// SPDX-License-Identifier: BSD-3-Clause
// The loop of a hand with a slice that is interpolated: what `check` names, played.

#include <limits>
#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/certificate/free_slices.hpp"
#include "physics/interpolation.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A slice before a spring and a damper to the ground, or to a mass.
scene::Scene interpolated(double stiffness, double damping, double kg = 0.0, double loss = 0.0) {
  SceneBuilder b;
  const int far = kg > 0.0 ? b.mass(kg) : b.ground();
  b.spring(far, b.slice(0), stiffness, damping);
  if (kg > 0.0) {
    b.spring(far, b.ground(), 0.0, loss);
  }
  b.scene.mats[at(b.scene.ports[0].mat)].coupling = scene::Coupling::kSmooth;
  return b.scene;
}

/// What is held of a slice, and the delay of its device.
struct HeldSlice {
  double mass = 0.3;
  double damping = 2.0;
  int delay = 1;
};

/// By which factor its speed has grown after so many ticks, from those before them; it is knocked
/// at the start and moved exactly between two ticks.
double growthOf(const scene::Scene& scene, const Rates& rates, const HeldSlice& held, int ticks) {
  const double tick = 1.0 / rates.gesturalHz();
  const double decay = std::exp(-held.damping / held.mass * tick);
  const double glide = held.mass / held.damping * (1.0 - decay);
  Player player(scene, rates, Precision::kDouble);
  std::vector<double> queue(at(held.delay + 1), 0.0);
  double x = 0.0;
  double v = 0.01;
  const auto peak = [&](int count) {
    double most = 0.0;
    for (int n = 0; n < count && std::abs(v) < 1e9; ++n) {
      player.positions[0] = x;
      player.tick();
      queue.push_back(player.forces[0]);
      const double force = queue[queue.size() - 1 - at(held.delay)];
      x += glide * v + (tick - glide) / held.damping * force;
      v = decay * v + glide / held.mass * force;
      most = std::max(most, std::abs(v));
    }
    return most;
  };
  peak(ticks);
  const double early = peak(ticks);
  const double late = peak(ticks);
  return std::abs(v) < 1e9 ? late / early : std::numeric_limits<double>::infinity();
}

TEST(InterpolatedHandsTest, ASpringIsAnsweredOneAndAHalfTicksLater) {
  const double tick = 14.0 / kRate;
  const Certificate c = certify(interpolated(1000.0, 0.0), {kRate, 14});
  EXPECT_NEAR(c.ports.at(0).stiffness_limit, 2.0 * 2.0 / ((1.0 + 2.0 * 2.5) * tick), 1e-9);
  EXPECT_DOUBLE_EQ(c.ports[0].interpolated_stiffness, c.ports[0].stiffness);
  for (const int steps : {2, 3, 4, 14, 44}) {
    const InterpolationResponse answer = interpolationResponse(steps);
    double sum = 0.0;
    double late = 0.0;
    for (std::size_t i = 0; i < answer.spring.size(); ++i) {
      sum += answer.spring[i];
      late += static_cast<double>(i) * answer.spring[i];
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(late, kInterpolationDelay, 1e-12) << steps;
  }
}

TEST(InterpolatedHandsTest, ASliceIsQuietBelowTheStiffnessThatIsNamedAndTremblesAbove) {
  for (const int ratio : {4, 14, 44}) {
    const Rates rates{kRate, ratio};
    for (const int delay : {0, 1, 2}) {
      DeviceTraits device;
      device.delay_ticks = delay;
      const double named =
          certify(interpolated(1000.0, 0.0), rates, device).ports.at(0).stiffness_limit;
      const HeldSlice held{0.3, 2.0, delay};
      EXPECT_LT(growthOf(interpolated(0.9 * named, 0.0), rates, held, 4000), 0.9) << ratio << delay;
      EXPECT_GT(growthOf(interpolated(1.1 * named, 0.0), rates, held, 4000), 1.1) << ratio << delay;
    }
  }
}

TEST(InterpolatedHandsTest, ADamperIsQuietBelowWhatIsNamedAndSetsASliceOffShortlyAbove) {
  for (const int ratio : {4, 14, 44}) {
    const Rates rates{kRate, ratio};
    for (const int delay : {0, 1, 2}) {
      DeviceTraits device;
      device.delay_ticks = delay;
      const double named = certify(interpolated(0.0, 1.0), rates, device).ports.at(0).damping_limit;
      const HeldSlice held{0.3, 2.0, delay};
      EXPECT_LT(growthOf(interpolated(0.0, 0.98 * named), rates, held, 4000), 1.0)
          << ratio << delay;
      // At 1 kHz a stiff hand takes away so much of the mass that others bear more.
      const double above = ratio == 44 ? 1.8 : 1.2;
      EXPECT_GT(growthOf(interpolated(0.0, above * named), rates, held, 4000), 1.0)
          << ratio << delay;
    }
  }
}

/// Of hands that are a mass and a damper beside those of the slice.
TEST(InterpolatedHandsTest, NoHandSetsOffSpringsAndDampersTogetherBelowTheLimit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  const auto scattered = [&](double low, double high) {
    return low * std::pow(high / low, number(random));
  };
  const Rates rates{kRate, 14};
  for (int i = 0; i < 150; ++i) {
    const int delay = static_cast<int>(4.0 * number(random));
    DeviceTraits slice;
    slice.mass = scattered(0.05, 1.0);
    slice.damping = scattered(0.5, 8.0);
    slice.delay_ticks = delay;
    const HandLoop loop(slice, 1.0 / rates.gesturalHz(), rates.ratio);
    const double k = i % 4 == 0 ? 1e-3 : scattered(10.0, 1e5);
    const double z = scattered(0.1, 5000.0);
    const double share = loop.share({k, z, k, z}) / 0.98;
    const HeldSlice held{slice.mass + (i % 3 == 0 ? 0.0 : scattered(1e-3, 1.0)),
                         slice.damping + (i % 2 == 0 ? 0.0 : scattered(1e-2, 20.0)), delay};
    EXPECT_LT(growthOf(interpolated(k / share, z / share), rates, held, 3000), 1.0 + 1e-6)
        << i << ": " << k / share << ", " << z / share;
  }
}

TEST(InterpolatedHandsTest, WhatIsAttachedGrowsAsItIsForetold) {
  const Rates rates{kRate, 14};
  for (const auto& [stiffness, damping, kg, loss] : {std::array{2000.0, 0.0, 0.1, 0.0},
                                                     {3000.0, 0.0, 0.02, 0.0},
                                                     {3000.0, 0.2, 0.1, 0.05},
                                                     {1500.0, 0.0, 0.05, 0.0}}) {
    const scene::Scene scene = interpolated(stiffness, damping, kg, loss);
    const Network network(scene);
    const RatedNetwork networks(network, rates);
    const double radius = FreeSlices(networks).radii({}).at(at(scene.ports.at(0).mat));
    const double played = std::pow(growthOf(scene, rates, {}, 4000), 1.0 / 4000.0);
    EXPECT_NEAR(radius, std::max(1.0, played), 2e-5) << stiffness << ", " << kg;
  }
}

TEST(InterpolatedHandsTest, TheFindingNamesWhatInterpolationCosts) {
  const Certificate c = certify(interpolated(3000.0, 0.0), {kRate, 14});
  ASSERT_EQ(c.findings.size(), 1U);
  EXPECT_THAT(c.findings[0], HasSubstr("is passive up to 2100 N/m at 3150 Hz"));
  EXPECT_THAT(c.findings[0], HasSubstr("adds a delay of 1.5 ticks (coupling: hold has none)"));
}

}  // namespace
}  // namespace ergotic::physics
