// SPDX-License-Identifier: BSD-3-Clause
// A slice in nobody's hand, with masses that are attached to it: its loop against itself, played.

#include "physics/certificate/free_slices.hpp"

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A slice, a link, a mass, and what damps that to the ground.
struct AttachedMass {
  double stiffness = 2000.0;
  double damping = 0.0;
  double mass = 0.1;
  double loss = 0.0;
  bool is_fast = false;  // the mass at the audio rate

  scene::Scene scene() const {
    SceneBuilder b;
    const int section = is_fast ? SceneBuilder::kAudio : SceneBuilder::kGestural;
    const int hung = b.mass(mass, 0.0, 0.0, section);
    b.spring(hung, b.slice(0), stiffness, damping);
    b.spring(hung, b.ground(0.0, section), 0.0, loss);
    return b.scene;
  }
};

double radiusOf(const scene::Scene& scene, const DeviceTraits& device = {}) {
  const Network network(scene);
  const RatedNetwork networks(network, kRates);
  return FreeSlices(networks).radii(device).at(at(scene.ports.at(0).mat));
}

/// Factor by which the speed of slices of `device` grows in a tick, so many ticks after a knock to
/// each, answered one tick late.
double playedGrowth(const scene::Scene& scene, const DeviceTraits& device, int settled = 4000) {
  const double decay = std::exp(-device.damping / device.mass * kTick);
  const double glide = device.mass / device.damping * (1.0 - decay);
  struct Moving {
    double x = 0.0;
    double v = 0.01;
    double force = 0.0;
  };
  std::vector<Moving> slices(scene.ports.size());
  Player player(scene, kRates, Precision::kDouble);
  const auto peak = [&](int ticks) {
    double most = 0.0;
    for (int n = 0; n < ticks; ++n) {
      for (std::size_t p = 0; p < slices.size(); ++p) {
        player.positions[p] = slices[p].x;
      }
      player.tick();
      for (std::size_t p = 0; p < slices.size(); ++p) {
        auto& [x, v, force] = slices[p];
        x += glide * v + (kTick - glide) / device.damping * force;
        v = decay * v + glide / device.mass * force;
        force = player.forces[p];
        most = std::max(most, std::abs(v));
      }
    }
    return most;
  };
  constexpr int kTicks = 4000;
  peak(settled);
  const double early = peak(kTicks);
  return std::pow(peak(kTicks) / early, 1.0 / kTicks);
}

TEST(FreeSlicesTest, GrowsAsItIsForetold) {
  for (const bool is_fast : {false, true}) {
    for (const AttachedMass& attached :
         {AttachedMass{2000.0, 0.0, 0.1, 0.0}, AttachedMass{3000.0, 0.0, 0.02, 0.0},
          AttachedMass{3000.0, 0.2, 0.1, 0.05}, AttachedMass{1500.0, 0.0, 0.05, 0.0}}) {
      AttachedMass one = attached;
      one.is_fast = is_fast;
      EXPECT_NEAR(radiusOf(one.scene()), playedGrowth(one.scene(), {}), 2e-5)
          << one.stiffness << ", " << one.mass;
    }
  }
}

TEST(FreeSlicesTest, APartOfATickOfDelayIsAWholeOne) {
  DeviceTraits late;
  late.delay_ticks = 1.0;
  const double whole = radiusOf(AttachedMass{}.scene(), late);
  late.delay_ticks = 0.5;
  EXPECT_EQ(radiusOf(AttachedMass{}.scene(), late), whole);
  late.delay_ticks = 0.0;
  EXPECT_LT(radiusOf(AttachedMass{}.scene(), late), whole);
}

TEST(FreeSlicesTest, EndsOfTheRangesOfParametersCount) {
  scene::Scene scene = AttachedMass{}.scene();
  scene.parameters.push_back({"k", 500.0, 500.0, 2000.0, {}});
  scene.lias[0].stiffness = {1.0, 0};
  EXPECT_EQ(radiusOf(scene), radiusOf(AttachedMass{}.scene()));
}

TEST(FreeSlicesTest, ALosslessMassOnASpringSetsOffASliceAtLessThanTheSpringAlone) {
  const scene::Scene scene = AttachedMass{}.scene();
  EXPECT_GT(playedGrowth(scene, {}), 1.0 + 1e-5);
  const Certificate certificate = certify(scene, kRates);
  EXPECT_LT(certificate.ports.at(0).stiffness, 0.5 * certificate.ports[0].stiffness_limit);
  EXPECT_EQ(certificate.ports[0].level, HandLevel::kWarned);
  EXPECT_THAT(certificate.findings,
              ElementsAre(HasSubstr("when nobody holds it, a slice of 0.3 kg")));
}

TEST(FreeSlicesTest, ALossKeepsItSilent) {
  EXPECT_TRUE(certify(AttachedMass{2000.0, 0.0, 0.1, 0.5}.scene(), kRates).findings.empty());
  EXPECT_TRUE(certify(AttachedMass{500.0, 0.0, 0.1, 0.0}.scene(), kRates).findings.empty());
}

TEST(FreeSlicesTest, IsRefusedWhereItGrowsFastWithTwiceTheDamping) {
  const AttachedMass attached{3500.0, 0.0, 0.05, 0.0};
  DeviceTraits twice;
  twice.damping *= 2.0;
  ASSERT_GT(playedGrowth(attached.scene(), twice), 1.0 + kTick);
  EXPECT_EQ(certify(attached.scene(), kRates).verdict, Verdict::kUnproven);
}

/// A string of so many masses at the audio rate, on a spring at a mass or between two.
scene::Scene stringOn(int masses, bool is_between, double loss) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int ends = b.ground();
  const int first = b.mass(0.01 / masses, 0.0);
  for (int i = 1; i < masses; ++i) {
    b.mass(0.01 / masses, 0.0);
  }
  const double tension = 20.0 * masses;
  for (int i = 0; i <= masses; ++i) {
    const int left = i == 0 ? ends : first + i - 1;
    b.spring(left, i == masses ? ends : first + i, tension, loss);
  }
  const int grid = b.grid(first, masses);
  b.spring(is_between ? b.point(grid, 0.37) : first + masses / 2, slice, 1500.0);
  return b.scene;
}

TEST(FreeSlicesTest, AStringBehindASpringGrowsAsItIsForetold) {
  for (const bool is_between : {false, true}) {
    const scene::Scene scene = stringOn(6, is_between, 0.0);
    const double growth = playedGrowth(scene, {}, 200000);
    EXPECT_GT(growth, 1.0 + 1e-5);
    EXPECT_NEAR(radiusOf(scene), growth, 2e-6);
    EXPECT_EQ(certify(scene, kRates).ports.at(0).level, HandLevel::kWarned);
    EXPECT_TRUE(certify(stringOn(6, is_between, 0.02), kRates).findings.empty());
  }
}

TEST(FreeSlicesTest, NothingIsWorkedOutWhereNothingIsAttached) {
  SceneBuilder wall;
  wall.link(LiaType::kContact, wall.slice(0), wall.ground(), 2000.0);
  const Network network(wall.scene);
  const RatedNetwork networks(network, kRates);
  EXPECT_FALSE(FreeSlices(networks).areJudged());
}

TEST(FreeSlicesTest, ScalesOfThePortCount) {
  scene::Scene scene = AttachedMass{500.0, 0.0, 0.025, 0.0}.scene();
  scene.ports[0].force_scale = 2.0;
  scene.ports[0].position_scale = 0.5;  // felt as four times the mass and the stiffness
  EXPECT_NEAR(radiusOf(scene), radiusOf(AttachedMass{}.scene()), 1e-9);
}

TEST(FreeSlicesTest, UnitsOfTimeCount) {
  scene::Scene in_samples =
      AttachedMass{2000.0 / (kRate * kRate), 0.2 / kRate, 0.1, 0.1 / kRate}.scene();
  in_samples.time_unit_s = 1.0 / kRate;
  EXPECT_NEAR(radiusOf(in_samples), radiusOf(AttachedMass{2000.0, 0.2, 0.1, 0.1}.scene()), 1e-9);
}

/// The same mass on another link.
scene::Scene withLaw(const AttachedMass& attached, LiaType type, Scheme scheme) {
  scene::Scene scene = attached.scene();
  scene::Lia& lia = scene.lias.front();
  lia.type = type;
  lia.scheme = scheme;
  lia.law.edit().nonlinearity = {1e-3};
  lia.law.edit().width = {1.0};
  lia.law.edit().release = 2.0;
  lia.law.edit().exponent = {1.5};
  const double force = attached.stiffness * 0.1;
  lia.law.edit().table.points = {{-0.1, -force}, {0.1, force}};
  return scene;
}

TEST(FreeSlicesTest, AEnergyStableSpringGrowsAsItIsForetold) {
  for (const bool is_fast : {false, true}) {
    AttachedMass attached;
    attached.is_fast = is_fast;
    const scene::Scene scene = withLaw(attached, LiaType::kCubic, Scheme::kEnergyStable);
    EXPECT_GT(playedGrowth(scene, {}), 1.0 + 1e-5);
    EXPECT_NEAR(radiusOf(scene), playedGrowth(scene, {}), 2e-5);
  }
}

/// Nearly linear and soft for a step, it does not look ahead.
TEST(FreeSlicesTest, ASoftEnergyStableSpringIsTheExplicitOne) {
  const AttachedMass attached{2090.0, 0.0, 0.00330378479, 0.0103722453};
  scene::Scene scene = withLaw(attached, LiaType::kCubic, Scheme::kEnergyStable);
  scene.lias.at(0).law.edit().nonlinearity = {1e-6};
  const double growth = playedGrowth(scene, {}, 20000);
  EXPECT_GT(growth, 1.0 + 0.01 * kTick);
  EXPECT_NEAR(radiusOf(scene), growth, 2e-6);
}

/// Its damper sees half of the steps of a slice whose next place it does not know.
TEST(FreeSlicesTest, AEnergyStableDamperBrakesASliceLess) {
  const AttachedMass attached{6500.0, 1.6, 0.7, 0.05, true};
  const scene::Scene scene = withLaw(attached, LiaType::kCubic, Scheme::kEnergyStable);
  EXPECT_EQ(radiusOf(attached.scene()), 1.0);
  EXPECT_GT(playedGrowth(scene, {}, 20000), 1.0 + 1e-5);
  EXPECT_GT(radiusOf(scene), playedGrowth(scene, {}, 20000));
}

TEST(FreeSlicesTest, LinksThatAreNotLinearAreSeenAsTheSpringsThatTheyMayBe) {
  const struct {
    LiaType type;
    Scheme scheme;
  } laws[] = {{LiaType::kCubic, Scheme::kEnergyStable}, {LiaType::kCubic, Scheme::kExplicit},
              {LiaType::kTable, Scheme::kEnergyStable}, {LiaType::kContact, Scheme::kEnergyStable},
              {LiaType::kPluck, Scheme::kExplicit},     {LiaType::kConditional, Scheme::kExplicit}};
  for (const auto& law : laws) {
    const auto level = [&](const AttachedMass& attached) {
      return certify(withLaw(attached, law.type, law.scheme), kRates).ports.at(0).level;
    };
    const int type = static_cast<int>(law.type);
    EXPECT_EQ(level({2000.0, 0.0, 0.1, 0.0}), HandLevel::kWarned) << type;
    EXPECT_EQ(level({4000.0, 0.0, 0.05, 0.0}), HandLevel::kRefused) << type;
    EXPECT_EQ(level({2000.0, 0.0, 0.1, 0.5}), HandLevel::kSilent) << type;
  }
}

/// Where they grow without an end, at a millimetre from the start.
TEST(FreeSlicesTest, ALawThatGrowsIsSeenAsItIsAtAMillimetre) {
  AttachedMass attached;
  for (const double pressed : {0.0, 3e-3}) {
    attached.stiffness = 2000.0 / (1.5 * std::sqrt(pressed + 1e-3));
    scene::Scene scene = withLaw(attached, LiaType::kPowerContact, Scheme::kEnergyStable);
    scene.lias.at(0).law.edit().width = {0.01 + pressed};
    scene.mats.at(0).position.x() = -0.01;
    EXPECT_NEAR(radiusOf(scene), radiusOf(AttachedMass{}.scene()), 1e-6);
    scene.mats[0].position.x() = -0.02;  // open
    EXPECT_LE(radiusOf(scene), radiusOf(AttachedMass{}.scene()));
  }
}

TEST(FreeSlicesTest, ASpringThatIsStretchedIsSeenAsItIsThere) {
  scene::Scene scene =
      withLaw(AttachedMass{45.0, 0.0, 8.0}, LiaType::kCubic, Scheme::kEnergyStable);
  scene.lias.at(0).law.edit().nonlinearity = {6e6};
  scene.lias.pop_back();
  EXPECT_LT(certify(scene, kRates).ports.at(0).stiffness, 100.0);
  scene.mats.at(0).position.x() = 0.018;
  EXPECT_NEAR(certify(scene, kRates).ports.at(0).stiffness, 45.0 + 3.0 * 6e6 * 0.019 * 0.019, 1.0);
  EXPECT_THAT(certify(scene, kRates).findings,
              Contains(HasSubstr("may meet 6543 N/m within a millimetre, mostly by link 'l0'")));
}

/// A millimetre of the hand is ten of the model.
TEST(FreeSlicesTest, ALawThatGrowsIsSeenAsFarAsHandsMove) {
  scene::Scene scene =
      withLaw(AttachedMass{0.0, 0.0, 100.0}, LiaType::kCubic, Scheme::kEnergyStable);
  scene.lias.at(0).law.edit().nonlinearity = {1e6};
  scene.lias.pop_back();
  scene.ports.at(0).position_scale = 0.1;
  scene.ports[0].force_scale = 0.1;
  EXPECT_NEAR(certify(scene, kRates).ports.at(0).stiffness, 3.0 * 1e6 * 1e-4, 1e-6);
}

/// Those that close would hold what the table lets swing.
TEST(FreeSlicesTest, ContactsBehindAMassHideNothing) {
  AttachedMass attached{1900.0, 0.0, 1e-4, 0.02, true};
  SceneBuilder b;
  b.scene = attached.scene();
  const int far = b.mass(0.1, 0.0);
  b.link(LiaType::kTable, 0, far, 0.0);
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  b.scene.lias.back().law.edit().table.points = {{-10.0, -4e5}, {10.0, 4e5}};
  EXPECT_GT(playedGrowth(b.scene, {}, 20000), 1.0 + 1e-5);
  EXPECT_GT(radiusOf(b.scene), 1.0 + 1e-5);
  const int wall = b.ground();
  for (int i = 0; i < 3; ++i) {
    b.link(LiaType::kContact, wall, far, 1e10);
    b.scene.lias.back().scheme = Scheme::kEnergyStable;
    b.scene.lias.back().law.edit().width = {-100.0};
  }
  EXPECT_GT(radiusOf(b.scene), 1.0 + 1e-5);
}

/// What a table between a mass and the ground makes of it while it holds.
TEST(FreeSlicesTest, LinksBehindAMassAreSeenOpenAndClosed) {
  SceneBuilder b;
  const int hung = b.mass(1e-3, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(hung, b.slice(0), 2000.0);
  b.link(LiaType::kTable, hung, b.mass(0.1, 0.0, 0.0, SceneBuilder::kGestural), 0.0);
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  b.scene.lias.back().law.edit().table.points = {{-0.1, -2e4}, {0.1, 2e4}};
  EXPECT_GT(playedGrowth(b.scene, {}), 1.0 + 1e-5);
  EXPECT_GT(radiusOf(b.scene), 1.0 + 1e-5);
}

/// The worst is not where it is steepest: there the mass answers too late to be driven.
TEST(FreeSlicesTest, AStiffContactIsSeenAsTheSoftOneThatItIsOnTheWay) {
  AttachedMass steep{4000.0, 0.0, 1e-4, 0.0, true};
  AttachedMass soft = steep;
  soft.stiffness *= 0.25;
  ASSERT_GT(radiusOf(soft.scene()), radiusOf(steep.scene()) + 1e-6);
  EXPECT_NEAR(radiusOf(withLaw(steep, LiaType::kContact, Scheme::kEnergyStable)),
              radiusOf(soft.scene()), 3e-5);
}

TEST(FreeSlicesTest, EnergyStableWallsAreNoAlarm) {
  const auto findings = [](double mass, double stiffness, double loss) {
    SceneBuilder b;
    const int hung = b.mass(mass, 0.0);
    b.link(LiaType::kContact, b.slice(0), hung, stiffness);
    b.scene.lias.back().scheme = Scheme::kEnergyStable;
    b.spring(hung, b.ground(), 1000.0, loss);
    return certify(b.scene, kRates).findings;
  };
  EXPECT_TRUE(findings(1e-4, 1e6, 0.01).empty());  // 5 times what an explicit contact bears
  EXPECT_TRUE(findings(1e-2, 2000.0, 0.1).empty());
}

/// Each bears it by itself; as explicit links, together, they would grow with no hand near.
TEST(FreeSlicesTest, WhatOnlyGuardsBearTellsNothingOfTheSlice) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int hung = b.mass(1e-5, 0.0);
  for (int i = 0; i < 2; ++i) {
    b.link(LiaType::kContact, slice, hung, 1e6);
    b.scene.lias.back().scheme = Scheme::kEnergyStable;
  }
  b.spring(hung, b.ground(), 1000.0, 0.01);
  EXPECT_EQ(radiusOf(b.scene), 1.0);
}

/// Slices on one mass, each on a spring of its own.
scene::Scene onOneMass(int slices, double stiffness, double loss) {
  SceneBuilder b;
  const int hung = b.mass(0.4, 0.0);
  for (int i = 0; i < slices; ++i) {
    b.spring(hung, b.slice(i), stiffness);
  }
  b.spring(hung, b.ground(), 0.0, loss);
  return b.scene;
}

/// Let go together they swing against the mass like one that is as many times as strong.
TEST(FreeSlicesTest, SlicesOnOneMassSetItOffTogether) {
  EXPECT_TRUE(certify(onOneMass(1, 2000.0, 0.3), kRates).findings.empty());
  const Certificate silent = certify(onOneMass(8, 250.0, 0.3), kRates);
  EXPECT_TRUE(silent.findings.empty());
  const Certificate warned = certify(onOneMass(8, 2000.0, 0.3), kRates);
  EXPECT_EQ(warned.verdict, Verdict::kPassive);
  EXPECT_THAT(warned.findings, ElementsAre(HasSubstr("(7 more like it)")));
  EXPECT_TRUE(std::all_of(warned.ports.begin(), warned.ports.end(),
                          [](const PortCertificate& p) { return p.level == HandLevel::kWarned; }));
  const scene::Scene scene = onOneMass(8, 4000.0, 1.0);
  DeviceTraits twice;
  twice.damping *= 2.0;
  const double growth = playedGrowth(scene, twice);
  EXPECT_GT(growth, 1.0 + kTick);
  EXPECT_NEAR(radiusOf(scene, twice), growth, 2e-5);
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kUnproven);
}

TEST(FreeSlicesTest, ASliceIsToldOfAMassThatIsAttachedToAnother) {
  scene::Scene scene = AttachedMass{}.scene();
  SceneBuilder b;
  b.scene = scene;
  const int far = b.slice(1);
  b.spring(far, b.ground(), 10.0);
  b.spring(far, scene.ports.front().mat, 10.0);
  const Certificate certificate = certify(b.scene, kRates);
  EXPECT_THAT(certificate.findings, ElementsAre(HasSubstr("(1 more like it)")));
  ASSERT_EQ(certificate.ports.size(), 2U);
  EXPECT_THAT(certificate.ports[1].finding, HasSubstr("what is attached to link 'l3'"));
}

/// In space a damper does nothing to what swings across its line, so it makes no hand safe.
TEST(FreeSlicesTest, DampersInSpaceMayTakeNothing) {
  AttachedMass light{975.0, 12.5, 1.75e-3, 0.0, true};
  scene::Scene scene = light.scene();
  EXPECT_LT(radiusOf(scene), 1.0 + 1e-9);
  for (scene::Section& section : scene.sections) {
    section.geometry = Geometry::kSpace;
  }
  scene.mats.at(0).position = {6.6e-3, 3.3e-3, 13.8e-3};
  EXPECT_GT(playedGrowth(settle(scene, kRates).scene, {}), 1.0 + 1e-5);
  EXPECT_GT(radiusOf(settle(scene, kRates).scene), 1.0 + 1e-5);
}

}  // namespace
}  // namespace ergotic::physics
