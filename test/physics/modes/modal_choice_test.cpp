// SPDX-License-Identifier: BSD-3-Clause

#include "physics/modes/modal_choice.hpp"

#include "physics/modes/modal_plan.hpp"
#include "physics/modes/modal_scenes.hpp"
#include "physics/note.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

ModalPlan planOf(const scene::Scene& scene) {
  ModalPlan plan;
  std::vector<std::string> notes;
  EXPECT_TRUE(planModes(Network(scene), kModalRates, 0, plan, notes));
  return plan;
}

/// A plate that is heard in two places and pushed in one of them and in a third.
Plate pushedPlate() {
  Plate b(0.2 * Plate::kMass * kRate * kRate, 0.01);
  b.hear(b.of(3, 4), 0);
  b.hear(b.of(9, 2), 1);
  b.push(b.of(3, 4), 0);
  b.push(b.of(5, 8), 1);
  return b;
}

/// Largest difference of what is heard.
double largestError(const Player& a, const Player& b) {
  double largest = 0.0;
  for (std::size_t c = 0; c < a.heard.size(); ++c) {
    for (std::size_t n = 0; n < a.heard[c].size(); ++n) {
      largest = std::max(largest, std::abs(a.heard[c][n] - b.heard[c][n]));
    }
  }
  return largest;
}

TEST(ModalChoiceTest, KickOfAModeGoesNoFurtherThanItsBound) {
  for (const double pull : {0.0, 1e-4, 0.02, 0.5, 1.9, 3.5}) {
    for (const double loss : {0.0, 1e-4, 0.01, 0.2}) {
      double x = 0.0;
      double d = 1.0;
      double reached = 0.0;
      for (int n = 0; n < 20000; ++n) {
        x += d;
        reached = std::max(reached, std::abs(x));
        d = (1.0 - loss) * d - pull * x;
      }
      const double bound = peakAfterKick(pull, loss);
      EXPECT_LE(reached, bound * (1.0 + 1e-9)) << pull << " " << loss;
      if (pull > 0.0 && pull < 0.1 && loss < 1e-3) {
        EXPECT_GT(reached, 0.9 * bound) << pull << " " << loss;
      }
    }
  }
}

TEST(ModalChoiceTest, ErrorAfterImpulsesStaysBelowTheBoundThatIsPrinted) {
  const scene::Scene scene = pushedPlate().scene;
  for (const int modes : {20, 60, 110}) {
    const scene::Scene reduced = withModes(scene, modes);
    const double bound = planOf(reduced).error.per_impulse;
    Player network(scene, kModalRates);
    Player modal(reduced, kModalRates);
    double impulse = 0.0;
    for (int n = 0; n < 300; ++n) {
      for (std::size_t i = 0; i < network.inputs.size(); ++i) {
        const double force = n < 20 ? std::sin(1.7 * static_cast<double>(i) + n) : 0.0;
        network.inputs[i] = modal.inputs[i] = force;
        impulse += std::abs(force) / kRate;
      }
      network.tick();
      modal.tick();
    }
    EXPECT_LE(largestError(network, modal), bound * impulse) << modes;
    EXPECT_GT(largestError(network, modal), 1e-6 * bound * impulse) << modes;
    EXPECT_THAT(described(reduced), HasSubstr(shortly(bound) + " m at any time after impulses"));
  }
}

TEST(ModalChoiceTest, GiveUnderAConstantForceIsShortByTheShareThatIsPrinted) {
  const scene::Scene scene = pushedPlate().scene;
  const scene::Scene reduced = withModes(scene, 40);
  Player network(scene, kModalRates);
  Player modal(reduced, kModalRates);
  for (std::size_t i = 0; i < network.inputs.size(); i += 2) {
    network.inputs[i] = modal.inputs[i] = 1.0;
  }
  network.ticks(20000);
  modal.ticks(20000);
  const double whole = network.heard[0].back();
  const double share = 1.0 - modal.heard[0].back() / whole;
  EXPECT_GT(share, 0.01);
  EXPECT_LE(share, planOf(reduced).error.static_share * (1.0 + 1e-6));
}

TEST(ModalChoiceTest, MotionAtTheStartIsOffByNoMoreThanTheBound) {
  Plate b = pushedPlate();
  for (int i = 0; i < Plate::kColumns * Plate::kRows; ++i) {
    b.scene.mats[at(i)].position.x() = 1e-4 * std::cos(0.9 * i);
    b.scene.mats[at(i)].push.edit().velocity.x() = 0.1 * std::sin(0.4 * i);
    b.scene.mats[at(i)].push.edit().force.x() = 0.2 * std::cos(1.3 * i);
  }
  const scene::Scene reduced = withModes(b.scene, 50);
  Player network(b.scene, kModalRates);
  Player modal(reduced, kModalRates);
  network.ticks(500);
  modal.ticks(500);
  const double bound = planOf(reduced).error.at_start;
  EXPECT_LE(largestError(network, modal), bound);
  EXPECT_GT(largestError(network, modal), 0.01 * bound);
}

TEST(ModalChoiceTest, MoreModesAreNeverWorse) {
  const scene::Scene scene = pushedPlate().scene;
  double before = planOf(withModes(scene, 1)).error.per_impulse;
  for (int modes = 10; modes <= 120; modes += 10) {
    const double now = planOf(withModes(scene, modes)).error.per_impulse;
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0.0);
}

TEST(ModalChoiceTest, AutomaticModesArePlayedWhereTheyCostLessAndCanBe) {
  SceneBuilder random;
  for (int i = 0; i < 200; ++i) {
    random.mass(1e-3);
    for (int step = 1; step <= 3 && i > 0; ++step) {
      random.spring((i * 37 * step) % i, i, 1e4);
    }
  }
  random.hear(20);
  SceneBuilder even;
  const int first = even.chain(100, 1e-3, 1e5);
  even.hear(first + 10);
  even.hear(first + 70);
  SceneBuilder moving = dampedString();
  moving.point(moving.grid(0, 32), 0.3);
  moving.scene.connections.back().along.guide = 3;
  const auto chosen = [](const SceneBuilder& b) {
    return described(withModes(b.scene, scene::kAutomaticModes));
  };
  EXPECT_THAT(chosen(random), HasSubstr("is played by 200 modes, touched at 1 places"));
  EXPECT_THAT(chosen(even), HasSubstr("stays a network: by 100 modes, touched at 2 places"));
  EXPECT_THAT(chosen(moving), HasSubstr("stays a network: point 'p32' can move"));
}

/// What modes cannot play, and what is said of it.
struct Refused {
  const char* message;
  std::function<void(SceneBuilder& b, int first)> change;  ///< of a chain of 200 masses
};
const Refused kRefused[] = {
    {"built.yaml:101:1: error: section 'audio' cannot be played by its modes: link 'l1' has "
     "damping / stiffness = 2e-06, most have 1e-06",
     [](SceneBuilder& b, int) {
       for (std::size_t l = 0; l < b.scene.lias.size(); ++l) {
         b.scene.lias[l].damping.factor *= 1.0 + static_cast<double>(l);
       }
     }},
    {"built.yaml:3:1: error: section 'audio' cannot be played by its modes: module 'm2' loses",
     [](SceneBuilder& b, int) {
       b.scene.sections[0].medium = {1e-3};
       for (std::size_t m = 2; m < b.scene.mats.size(); ++m) {
         b.scene.mats[m].mass.factor *= 1.0 + 0.02 * static_cast<double>(m);
       }
     }},
    {"built.yaml:100:1: error: section 'audio' cannot be played by its modes: link 'l0' follows a "
     "parameter",
     [](SceneBuilder& b, int) {
       b.scene.parameters.push_back({"tension", 1.0, 0.5, 2.0, {}});
       for (Lia& lia : b.scene.lias) {
         lia.stiffness.parameter = 0;
       }
     }},
    {"the force on module 'm1' is an output",
     [](SceneBuilder& b, int first) {
       for (int m = first + 1; m <= first + 200; ++m) {
         b.hear(m, 0, Quantity::kForce);
       }
     }},
    {"built.yaml:500:1: error",
     [](SceneBuilder& b, int first) {
       b.hear(first, 1, Quantity::kForce);
       b.hear(b.point(b.grid(first, 202), 0.4 / 201.0), 2);
     }},
    {"65 of its modules are touched by what is not part of the modes, allowed: at most 64",
     [](SceneBuilder& b, int first) {
       for (int i = 1; i <= kMaxModalTouches; ++i) {
         b.push(first + 10 + i);
       }
     }},
};

TEST(ModalChoiceTest, WhatCannotBePlayedIsRefusedWithItsPlace) {
  for (const Refused& refused : kRefused) {
    SceneBuilder b;
    const int first = b.chain(200, 1e-3, 1e5, 0.1);
    b.hear(first + 3);
    refused.change(b, first);
    EXPECT_THAT(errorOf(withModes(b.scene, scene::kAllModes)), HasSubstr(refused.message));
  }
}

/// Two masses at 7 Hz, of which one is damped, beside something stiff that is damped more.
TEST(ModalChoiceTest, WhatIsSoftBesideTheRestSharesModesOrIsRefused) {
  SceneBuilder b;
  const int ground = b.ground();
  const int damped = b.cell(1.0, 0.0, 4.41);
  const int free = b.mass(1.0);
  const int stiff = b.cell(1e-4, 1e5, 4.41);
  for (const int mass : {damped, free}) {
    b.spring(mass, ground, 1945.0);
  }
  b.spring(damped, free, 1945.0);
  b.spring(damped, stiff, 4e-3);
  b.hear(free);
  EXPECT_THAT(
      errorOf(withModes(b.scene, scene::kAllModes)),
      HasSubstr("cannot be played by its modes: module 'm2' loses 0 of its speed per step"));
}

}  // namespace
}  // namespace ergotic::physics
