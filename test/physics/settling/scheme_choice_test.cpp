// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"
#include "physics/settling/steps.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kLight = 0.002;
constexpr double kHeavy = 0.008;
constexpr double kInverse = 1.0 / kLight + 1.0 / kHeavy;

/// One `auto` link between two masses in a medium.
struct Pair {
  explicit Pair(LiaType type) {
    const int a = b.mass(kLight);
    b.link(type, a, b.mass(kHeavy), 0.0);
    lia().scheme = Scheme::kAuto;
    lia().law.edit().width = {0.1};
    b.scene.sections[0].medium = {1e-6};  // everything loses energy
  }
  scene::Lia& lia() { return b.scene.lias[0]; }
  Settled settled() { return settle(b.scene, kRates); }
  Scheme scheme() { return settled().scene.lias[0].scheme; }

  SceneBuilder b;
};

/// Stiffness with that h^2 K (1/Ma + 1/Mb).
scene::Value stiff(double kappa) {
  return {kappa * kRate * kRate / kInverse};
}

/// Damping with that h Z (1/Ma + 1/Mb).
scene::Value damped(double s) {
  return {s * kRate / kInverse};
}

TEST(SchemeChoiceTest, ContactsAreEnergyStable) {
  Pair pair(LiaType::kContact);
  pair.lia().stiffness = stiff(0.0501);
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable);
  ASSERT_EQ(pair.settled().notes.size(), 1U);
  EXPECT_EQ(pair.settled().notes[0],
            "built.yaml:100:1: note: link 'l0': energy-stable, so that it cannot gain energy "
            "(h^2 K (1/Ma + 1/Mb) = 0.0501; the explicit scheme is stable up to 0)");
}

TEST(SchemeChoiceTest, FrictionIsJudgedAtTheWorstEndOfItsRange) {
  Pair pair(LiaType::kBow);
  pair.b.scene.parameters.push_back({"z", 1.0, 0.5, 2.0, {}});
  pair.lia().damping = {damped(0.299).factor, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.lia().damping = {damped(0.301).factor, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable);
  pair.lia().damping = damped(0.301);
  pair.b.scene.mats[0].mass = {kLight, 0};
  pair.b.scene.mats[1].mass = {kHeavy, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable) << "half the masses at the lower end";
}

TEST(SchemeChoiceTest, FrictionThatReachesAMassThatLosesNothingIsEnergyStable) {
  Pair pair(LiaType::kBow);
  pair.lia().damping = damped(0.01);
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.b.scene.sections[0].medium = {};
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable);
}

/// What a law bears of kappa or of h F' (1/Ma + 1/Mb) before it is energy-stable.
struct Turn {
  const char* name;
  LiaType type;
  double bears;
  std::function<void(Lia& lia, double value)> set;
};
void setStiffness(Lia& lia, double kappa) {
  lia.stiffness = stiff(kappa);
}
void setDamping(Lia& lia, double s) {
  lia.damping = damped(s);
}
void setLimit(Lia& lia, double kappa) {
  lia.law.edit().tipping_point = 1e-3;
  lia.stiffness = {};
  lia.law.edit().stiffness_limit = stiff(kappa);
}
void setNonlinearity(Lia& lia, double nonlinearity) {
  lia.stiffness = stiff(0.5);
  lia.law.edit().nonlinearity = {nonlinearity};
}
/// Up to f at 1 mm.
void setElastic(Lia& lia, double kappa) {
  const double f = stiff(kappa).factor * 1e-3;
  lia.law.edit().table.points = {{-1e-3, -0.1 * f}, {0.0, 0.0}, {1e-3, f}};
}
const double kFallOfSmoothBow = 0.63 * 2.0 * std::exp(-1.0);
const Turn kTurns[] = {
    {"contact", LiaType::kContact, 0.0, setStiffness},
    {"linear power contact", LiaType::kPowerContact, 0.0, setStiffness},
    {"contact that only damps", LiaType::kContact, 0.0, setDamping},
    {"clipped cubic", LiaType::kClippedCubic, 0.0, setLimit},
    {"cubic contact", LiaType::kCubicContact, 0.0, setLimit},
    {"pluck", LiaType::kPluck, 0.0, setStiffness},
    {"table", LiaType::kTable, 0.0, setElastic},
    {"table that falls", LiaType::kTable, 0.0, [](Lia& l, double k) { setElastic(l, -k); }},
    // The fall of friction decides, as it is allowed less than its rise.
    {"bow", LiaType::kBow, 0.2 * 3.0, setDamping},
    {"smooth bow", LiaType::kSmoothBow, 0.2 / kFallOfSmoothBow, setDamping},
    // As soon as they are nonlinear.
    {"quadratic", LiaType::kQuadratic, 0.0, setNonlinearity},
    {"cubic", LiaType::kCubic, 0.0, setNonlinearity},
};

TEST(SchemeChoiceTest, EveryLawIsEnergyStableAboveWhatItBears) {
  for (const Turn& turn : kTurns) {
    Pair pair(turn.type);
    turn.set(pair.lia(), 0.999 * turn.bears);
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit) << turn.name;
    turn.set(pair.lia(), 1.001 * turn.bears + (turn.bears == 0.0 ? 1e-6 : 0.0));
    EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable) << turn.name;
  }
}

TEST(SchemeChoiceTest, SteepestFallOfTheSmoothBowIsThatOfItsCurve) {
  // F = 0.63 z v exp(-4 (v/w)^2 + 0.5) with z = w = 1
  const auto force = [](double v) { return 0.63 * v * std::exp(-4.0 * v * v + 0.5); };
  double fall = 0.0;
  for (double v = 0.0; v < 2.0; v += 1e-4) {
    fall = std::max(fall, (force(v) - force(v + 1e-4)) / 1e-4);
  }
  Pair pair(LiaType::kSmoothBow);
  pair.lia().damping = damped(0.2 / fall * 0.9999);
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.lia().damping = damped(0.2 / fall * 1.0001);
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable);
}

TEST(SchemeChoiceTest, FrictionTablesAreJudgedByTheirLines) {
  for (const LiaType type : {LiaType::kBowTable, LiaType::kTable}) {
    Pair pair(type);
    const double unit = kRate / kInverse;
    const auto scheme = [&](double rise, double fall) {
      auto& law = pair.lia().law.edit();
      (type == LiaType::kBowTable ? law.table : law.viscous_table).points = {
          {-1.0, -rise * unit}, {1.0, rise * unit}, {2.0, (rise - fall) * unit}};
      return pair.scheme();
    };
    EXPECT_EQ(scheme(0.999, 0.199), Scheme::kExplicit);
    EXPECT_EQ(scheme(1.001, 0.199), Scheme::kEnergyStable);
    EXPECT_EQ(scheme(0.999, 0.201), Scheme::kEnergyStable);
  }
}

TEST(SchemeChoiceTest, AcrossRatesOnlyWhatNoForceMovesMayBeSlow) {
  SceneBuilder b;
  const int string = b.mass(kLight);
  const auto contact = [&](int slow) {
    const int l = b.link(LiaType::kContact, slow, string, 0.06 * kLight * kRate * kRate);
    b.scene.lias[at(l)].scheme = Scheme::kAuto;
  };
  contact(b.slice(0));
  contact(b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural));
  contact(b.ground(0.0, SceneBuilder::kGestural));
  for (int i = 0; i < 100; ++i) {
    b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);  // too many to be raised to the faster rate
  }
  const Settled settled = settle(b.scene, kRates);
  EXPECT_EQ(settled.scene.lias[0].scheme, Scheme::kEnergyStable);
  EXPECT_EQ(settled.scene.lias[1].scheme, Scheme::kExplicit);
  EXPECT_EQ(settled.scene.lias[2].scheme, Scheme::kEnergyStable);
  ASSERT_EQ(settled.notes.size(), 3U);  // by place
  EXPECT_THAT(settled.notes[1], HasSubstr("'l1': explicit, because one end is a slower mass"));
  const Settled at_one_rate = settle(b.scene, {kRate, 1});
  EXPECT_EQ(at_one_rate.scene.lias[1].scheme, Scheme::kEnergyStable);
}

TEST(SchemeChoiceTest, WallThatOnlyAHandTouchesStaysExplicit) {
  SceneBuilder b;
  const int hand = b.slice(0);
  b.link(LiaType::kPowerContact, hand, b.ground(0.0, SceneBuilder::kGestural), 1e6);
  b.scene.lias[0].scheme = Scheme::kAuto;
  b.scene.lias[0].law.edit().exponent = {2.3};
  EXPECT_EQ(settle(b.scene, kRates).scene.lias[0].scheme, Scheme::kExplicit);
}

/// One that moves may come to every module of its range; one that does not stays on its own.
TEST(SchemeChoiceTest, PointIsAsLightAsTheLightestModuleUnderIt) {
  for (const bool moves : {true, false}) {
    SceneBuilder b;
    const int first = b.chain(3, kHeavy, 1.0, 1.0);
    b.scene.mats[3].mass = {kLight};
    const int point = b.point(b.grid(first, 5), 0.5);
    b.scene.connections[0].along.guide = moves ? b.slice(0) : -1;
    b.scene.connections[0].along.scale = 1.0;
    scene::Lia& lia =
        b.scene.lias[static_cast<std::size_t>(b.link(LiaType::kBow, b.ground(), point, 0.0))];
    lia.scheme = Scheme::kAuto;
    lia.law.edit().width = {1e-3};
    const double mass = moves ? kLight : kHeavy;
    lia.damping = {0.599 * mass * kRate};  // falls by a third of that
    EXPECT_EQ(settle(b.scene, kRates).scene.lias.back().scheme, Scheme::kExplicit) << moves;
    lia.damping = {0.601 * mass * kRate};
    EXPECT_EQ(settle(b.scene, kRates).scene.lias.back().scheme, Scheme::kEnergyStable) << moves;
  }
}

TEST(SchemeChoiceTest, LinksOfOnePlaceAreSaidOnce) {
  SceneBuilder b;
  const int bar = b.ground();
  for (int i = 0; i < 20; ++i) {
    b.link(LiaType::kContact, bar, b.mass(kLight), (0.1 + 0.01 * i) * kLight * kRate * kRate);
    b.scene.lias.back().scheme = Scheme::kAuto;
    b.scene.lias.back().place = {7, 3};
  }
  const Settled settled = settle(b.scene, kRates);
  ASSERT_EQ(settled.notes.size(), 1U);
  EXPECT_THAT(settled.notes[0], HasSubstr(":7:3: note: link 'l0' and 19 more: energy-stable"));
  EXPECT_THAT(settled.notes[0], HasSubstr("= 0.29;"));
}

TEST(SchemeChoiceTest, WhatTheSceneSaysIsKept) {
  for (const Scheme said : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    for (const double kappa : {0.01, 0.5}) {
      Pair pair(LiaType::kContact);
      pair.lia().stiffness = stiff(kappa);
      pair.lia().scheme = said;
      EXPECT_EQ(pair.scheme(), said);
    }
  }
}

TEST(SchemeChoiceTest, OtherLinksStayExplicit) {
  for (const LiaType type : {LiaType::kSpringDamper, LiaType::kTable}) {
    Pair pair(type);
    pair.lia().stiffness = stiff(0.9);
    pair.lia().damping = damped(1.5);
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  }
}

TEST(SchemeChoiceTest, LinksThatAreExplicitIfStableAreEnergyStableOnlyIfTheyAreTooStiff) {
  Pair pair(LiaType::kContact);
  pair.lia().scheme = Scheme::kExplicitIfStable;
  pair.lia().stiffness = stiff(3.9);
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  EXPECT_TRUE(pair.settled().notes.empty());
  pair.lia().stiffness = stiff(40.0);
  EXPECT_EQ(pair.scheme(), Scheme::kEnergyStable);
  EXPECT_THAT(pair.settled().notes.at(0),
              AllOf(HasSubstr("link 'l0': energy-stable (h^2 K"), HasSubstr(" = 40, "),
                    HasSubstr("does not sound as programs do that play it explicitly")));
  EXPECT_EQ(certify(pair.settled().scene, kRates).verdict, Verdict::kPassive);
}

TEST(SchemeChoiceTest, TheStiffestAreEnergyStableUntilTheOthersAreStable) {
  SceneBuilder b;
  const int mass = b.mass(kLight);
  for (const double kappa : {1.0, 6.0, 2.5}) {
    const int link = b.link(LiaType::kContact, mass, b.ground(), kappa * kLight * kRate * kRate);
    b.scene.lias[at(link)].scheme = Scheme::kExplicitIfStable;
  }
  const scene::Scene settled = settle(b.scene, kRates).scene;
  EXPECT_EQ(settled.lias[0].scheme, Scheme::kExplicit);
  EXPECT_EQ(settled.lias[1].scheme, Scheme::kEnergyStable);
  EXPECT_EQ(settled.lias[2].scheme, Scheme::kExplicit);
}

/// What is linear is unstable without them, and guarding them would only change their sound.
TEST(SchemeChoiceTest, NoneIsEnergyStableForTheSakeOfWhatIsTooStiffByItself) {
  SceneBuilder b;
  const int mass = b.mass(kLight);
  b.spring(mass, b.ground(), 5.0 * kLight * kRate * kRate);
  b.scene.lias[at(b.link(LiaType::kContact, mass, b.ground(), 1.0))].scheme =
      Scheme::kExplicitIfStable;
  EXPECT_EQ(settle(b.scene, kRates).scene.lias[1].scheme, Scheme::kExplicit);
}

}  // namespace
}  // namespace ergotic::physics
