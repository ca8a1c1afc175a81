// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/laws/dry_friction.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

scene::Scene rubbedScene(const std::string& text) {
  return scene::readYaml("ergotic: 1\n" + text, "friction.yaml");
}

/// A falling coefficient: 1.2 at rest.
const char kFalls[] = "steady: 0.3, parts: [[0.4, 0.01], [0.5, 0.1]]";

/// A block on the ground, pulled by a spring whose other end goes at 0.01 m/s.
std::string pulledBlock(const std::string& normal) {
  return std::string(R"(
parameters: {press: {value: 1, range: [0, 2]}}
sections: {a: {}}
mats:
  floor: {type: ground}
  block: {type: mass, mass: 0.01}
  hook: {type: mass, mass: 1e9, v: 0.01}
lias:
  pull: {type: spring_damper, between: [hook, block], stiffness: 1000, damping: 0.1}
  rub: {type: friction, between: [block, floor], normal: )") +
         normal + ", " + kFalls + R"(}
outputs:
  v: {at: block, quantity: velocity, channel: 1}
  x: {at: block, quantity: position, channel: 2}
)";
}

TEST(FrictionTest, SticksUntilItIsPulledHarderThanItHolds) {
  for (const char* normal : {"1", "$press"}) {
    Player player(rubbedScene(pulledBlock(normal)), kRates);
    player.ticks(500);
    const std::vector<double>& v = player.heard[0];
    const auto moves = std::find_if(v.begin(), v.end(), [](double each) { return each > 1e-9; });
    // 1.2 N, less the damper, at 10 N/s; a force moves its mass one step later
    EXPECT_NEAR(static_cast<double>(moves - v.begin()) / kRate, (1.2 - 0.1 * 0.01) / 10.0,
                2.0 / kRate);
    EXPECT_GT(*std::max_element(moves, v.end()), 0.05);
  }
}

TEST(FrictionTest, WhatIsThrownSlowsDownEvenlyAndThenStays) {
  const scene::Scene scene = rubbedScene(R"(
sections: {a: {}}
mats: {floor: {type: ground}, block: {type: mass, mass: 0.01, v: 0.5}}
lias: {rub: {type: friction, between: [floor, block], normal: 0.2, steady: 0.3}}
outputs:
  v: {at: block, quantity: velocity, channel: 1}
  x: {at: block, quantity: position, channel: 2}
)");
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Player player(scene, kRates, precision);
    player.ticks(400);
    const double brake = 0.3 * 0.2 / 0.01;  // m/s^2
    EXPECT_NEAR(player.heard[1].back(), 0.5 * 0.5 / (2.0 * brake), 0.5 / kRate);
    EXPECT_EQ(player.heard[0].back(), 0.0);
  }
}

/// Line and curve of one step: what is asked of a law of mu from 1 at rest to 0 at 1.
double forceAfter(double free, bool slipped) {
  scene::Scene scene = rubbedScene(R"(
sections: {a: {}}
mats: {floor: {type: ground}, block: {type: mass, mass: 1}}
lias: {rub: {type: friction, between: [block, floor], normal: 1, table: [[0, 1], [1, 0], [2, 0]]}}
)");
  const auto law = EnergyStableLaw<double>::make(scene, scene.lias[0], {1.0});
  EnergyStableState<double> state;
  state.phase = slipped ? 1.0 : 0.0;
  return exertDry({free, free, 2.0, 1.0, true}, 0.0, law, state);
}

TEST(FrictionTest, StaysInTheBranchInWhichItIs) {
  // c = 2: g + 2 (1 - g) = free is met twice from 1 to 2, as g = 2 - free and, beyond 1, as free.
  EXPECT_DOUBLE_EQ(forceAfter(1.5, false), 0.75);  // sticks: all that it takes
  EXPECT_DOUBLE_EQ(forceAfter(1.5, true), 0.0);    // slips on at 1.5
  EXPECT_DOUBLE_EQ(forceAfter(0.9, true), 0.45);   // no root is left
  EXPECT_DOUBLE_EQ(forceAfter(2.1, false), 0.0);   // nothing holds that
}

TEST(FrictionTest, IsPressedByAContact) {
  // In a bowl of 1 m, which presses a weight of 0.1 N against its bottom.
  const scene::Scene scene = rubbedScene(R"(
sections: {a: {geometry: plane, gravity: [0, -10]}}
mats:
  bowl: {type: ground, at: [0, 1]}
  pole: {type: ground, at: [0, -1]}
  block: {type: mass, mass: 0.01, at: [0, 0], v: [0.1, 0]}
lias:
  floor: {type: contact, between: [pole, block], stiffness: 1e5, damping: 3, threshold: 1.000001}
  rub: {type: friction, between: [block, pole], normal: floor, steady: 0.3}
outputs:
  v: {at: block, quantity: velocity, channel: 1}
  x: {at: block, quantity: position, channel: 2}
  y: {at: block, quantity: position, channel: 3, axis: y}
)");
  Player player(scene, kRates);
  player.ticks(300);
  EXPECT_NEAR(player.heard[1].back(), 0.1 * 0.1 / (2.0 * 0.3 * 10.0), 2e-5);
  EXPECT_LT(std::abs(player.heard[0].back()), 1e-9);
}

TEST(FrictionTest, LetsGoWhereNothingPresses) {
  const scene::Scene scene = rubbedScene(R"(
sections: {a: {}}
mats: {floor: {type: ground}, block: {type: mass, mass: 0.01, v: 0.1}, lid: {type: ground, x: 1}}
lias:
  far: {type: contact, between: [block, lid], stiffness: 1000}
  rub: {type: friction, between: [block, floor], normal: far, steady: 0.3}
outputs: {v: {at: block, quantity: velocity, channel: 1}}
)");
  Player player(scene, kRates);
  player.ticks(100);
  EXPECT_DOUBLE_EQ(player.heard[0].back(), 0.1);
}

TEST(FrictionTest, TwoAtOneMassHoldItTogether) {
  const scene::Scene scene = rubbedScene(R"(
sections: {a: {}}
mats:
  floor: {type: ground}
  block: {type: mass, mass: 0.01}
  hook: {type: mass, mass: 1e9, v: 0.01}
lias:
  pull: {type: spring, between: [hook, block], stiffness: 1000}
  one: {type: friction, between: [block, floor], normal: 1, steady: 0.5}
  other: {type: friction, between: [floor, block], normal: 1, steady: 0.7}
outputs: {v: {at: block, quantity: velocity, channel: 1}}
)");
  Player player(scene, kRates);
  player.ticks(450);
  const std::vector<double>& v = player.heard[0];
  const auto moves = std::find_if(v.begin(), v.end(), [](double each) { return each > 1e-9; });
  EXPECT_NEAR(static_cast<double>(moves - v.begin()) / kRate, 0.12, 2.0 / kRate);
}

/// Pressed in a section of its own, at the rate of the hand or another one, which shares no module
/// with those that rub.
scene::Scene pressedFromAfar(const std::string& rate) {
  return rubbedScene(R"(
sections: {a: {}, b: {}, c: {}, far: {rate: )" +
                     rate + R"(}}
mats:
  floor: {type: ground, section: a}
  block: {type: mass, section: b, mass: 0.01, v: 0.5}
  alone: {type: mass, section: c, mass: 0.01, v: 0.5}
  pad: {type: ground, section: far}
  foot: {type: mass, section: far, mass: 0.1, x: -1.5e-4}
lias:
  hold: {type: spring_damper, between: [foot, pad], stiffness: 1000, damping: 10, rest_length: -3e-4}
  weight: {type: contact, between: [pad, foot], stiffness: 1000, damping: 10}
  rub: {type: friction, between: [block, floor], normal: weight, steady: 0.3}
outputs:
  x: {at: block, quantity: position, channel: 1}
  y: {at: alone, quantity: position, channel: 2}
)");
}

TEST(FrictionTest, IsPressedByWhatIsSteppedElsewhere) {
  for (const char* rate : {"gestural", "audio", "{divisor: 2}"}) {
    const scene::Scene settled = settle(pressedFromAfar(rate), kRates).scene;
    CompileOptions options(Precision::kDouble);
    Player one(compile(settled, kRates, options));
    options.threads = 2;
    Player two(compile(settled, kRates, options));
    one.ticks(1200);
    two.ticks(1200);
    EXPECT_EQ(one.heard, two.heard) << rate;
    // The foot rests where the spring of 0.3 mm and the contact are equally strong: 0.15 N.
    EXPECT_NEAR(one.heard[0].back(), 0.5 * 0.5 / (2.0 * 0.3 * 0.15 / 0.01), 1e-3) << rate;
  }
}

/// The same string as a network and as its modes.
TEST(FrictionTest, RubsModesAsItDoesModules) {
  const auto bowed = [](const std::string& modes) {
    return rubbedScene("sections: {a: {" + modes + R"(}, b: {}}
mats: {hair: {type: mass, section: b, mass: 1e9, v: 0.2}}
generators:
  - {type: string, name: s, section: a, masses: 40, mass: 2e-5, frequency: 300, damping: 1e-4, to: [1, 0]}
lias:
  bow: {type: friction, between: [s@0.13, hair], normal: 0.5, steady: 0.3, parts: [[0.8, 0.1]]}
outputs: {v: {at: s.20, quantity: velocity, channel: 1}}
)");
  };
  Player network(bowed(""), kRates);
  Player modal(bowed("modes: all"), kRates);
  network.ticks(150);
  modal.ticks(150);
  double most = 0.0;
  double off = 0.0;
  for (std::size_t n = 0; n < network.heard[0].size(); ++n) {
    most = std::max(most, std::abs(network.heard[0][n]));
    off = std::max(off, std::abs(network.heard[0][n] - modal.heard[0][n]));
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(off, 1e-9 * most);
}

/// Between masses of a net, a point on it, grounds, what an input drives and a slower mass.
const char kRubbedNet[] = R"(
parameters: {p: {value: 1, range: [0, 3]}}
sections: {a: {GEOMETRY}, s: {GEOMETRY, rate: {divisor: 7}}}
mats:
  pole: {type: ground, section: a, at: [0.05, -0.1TAIL]}
  ball: {type: mass, section: a, mass: 0.002, at: [0.05, 0.001TAIL], v: START}
  slow: {type: mass, section: s, mass: 0.01, at: [0.07, 0.001TAIL], v: START}
  wheel: {type: driven, section: a, at: [0.02, 0.01TAIL]}
generators:
  - {type: string, name: n, section: a, masses: 12, mass: 1e-3, stiffness: 2e4, damping: 0.01, from: [0, 0TAIL], to: [0.1, 0TAIL]}
lias:
  touch: {type: contact, between: [n@0.43, ball], stiffness: 5000, damping: 0.1, threshold: 0.0012}
  scrape: {type: friction, between: [ball, n@0.43], normal: touch, steady: 0.4, parts: [[0.6, 0.05]]}
  brake: {type: friction, between: [n.5, pole], normal: 0.5*$p, steady: 0.2}
  again: {type: friction, between: [n.5, n.6], normal: 0.2, table: [[0, 1], [0.1, 0.4], [2, 0.5]]}
  turn: {type: friction, between: [wheel, n.3], normal: $p, steady: 0.3, parts: [[0.5, 0.1]]}
  hang: {type: friction, between: [n.9, slow], normal: 0.3, steady: 0.3, scheme: energy_stable}
inputs: {wheel: {mat: wheel, quantity: position, channel: 1, gain: 1e-4}}
outputs: {v: {at: n.4, quantity: velocity, channel: 1}}
)";

scene::Scene rubbedNet(const std::string& geometry) {
  std::string text = kRubbedNet;
  const std::string start = geometry == "scalar"  ? "0.5"
                            : geometry == "plane" ? "[0.5, -0.5]"
                                                  : "[0.5, -0.5, 0.3]";
  for (const auto& [word, by] :
       {std::pair<std::string, std::string>{"GEOMETRY", "geometry: " + geometry},
        {"START", start},
        {"TAIL", geometry == "scalar" ? "" : ", 0"}}) {
    for (std::size_t place = text.find(word); place != std::string::npos; place = text.find(word)) {
      text.replace(place, word.size(), by);
    }
  }
  return rubbedScene(text);
}

std::string verdictNameOf(const scene::Scene& scene) {
  return toString(certify(settle(scene, kRates).scene, kRates).verdict);
}

TEST(FrictionTest, IsBoundedButOnSlowerMasses) {
  EXPECT_EQ(verdictNameOf(rubbedScene(pulledBlock("$press"))), "bounded");
  EXPECT_EQ(verdictNameOf(pressedFromAfar("gestural")), "bounded");
  EXPECT_EQ(verdictNameOf(rubbedNet("scalar")), "unproven");
}

TEST(FrictionTest, BalancesInEveryGeometryAndAcrossRates) {
  for (const char* geometry : {"scalar", "plane", "space"}) {
    Player player(rubbedNet(geometry), kRates);
    EXPECT_LT(imbalanceOf(player, 3000), 1e-10) << geometry;
  }
}

TEST(FrictionTest, ChangesNoBitWithoutEnergiesAndGoesOnFromWhereItWasSaved) {
  for (const char* geometry : {"scalar", "space"}) {
    const scene::Scene settled = settle(rubbedNet(geometry), kRates).scene;
    CompileOptions plain(Precision::kDouble);
    plain.metered = false;
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
    EXPECT_EQ(metered.heard, other.heard) << geometry;
    EXPECT_TRUE(std::equal(late.heard[0].rbegin(), late.heard[0].rend(), other.heard[0].rbegin()))
        << geometry;
  }
}

/// Nothing drives it: what is stored never rises above what was there.
TEST(FrictionTest, GivesNoMoreThanItTookWhateverPresses) {
  for (const double kappa : {0.5, 2.0, 3.0, 3.9}) {
    for (const double normal : {0.01, 0.3, 10.0}) {
      SceneBuilder b;
      const double k = kappa / 4.0 * 1e-3 * kRate * kRate;
      const int first = b.chain(8, 1e-3, k);
      for (int i = 1; i <= 8; ++i) {
        scene::setVelocity(b.scene.mats[at(first + i)], (i % 3 - 1.1) * Eigen::Vector3d::UnitX());
      }
      for (const int mass : {first + 2, first + 2, first + 3, first + 6}) {
        Lia& lia = b.scene.lias[at(b.link(LiaType::kFriction, mass, first, 0.0))];
        lia.scheme = Scheme::kEnergyStable;
        lia.law.edit().normal = {normal};
        lia.law.edit().steady = 0.3;
        lia.law.edit().falls = {{{0.9, 0.1}, {0.0, 1.0}}};
      }
      Player player(b.scene, kRates);
      player.tick();
      const double start = energiesOf(player).stored;
      double most = 0.0;
      for (int n = 0; n < 2000; ++n) {
        player.tick();
        most = std::max(most, energiesOf(player).stored);
      }
      EXPECT_LT(most, start * (1.0 + 1e-9)) << kappa << " " << normal;
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
