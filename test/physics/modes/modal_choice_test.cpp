// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_choice.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "physics/modes/modal_plan.hpp"
#include "physics/modes/modal_scenes.hpp"
#include "physics/note.hpp"
#include "support/mode_cache.hpp"

namespace ergotic::physics {
namespace {

using test::Player;

class ModalChoiceTest : public ::testing::Test {
 private:
  test::ModeCache cache_;
};

ModalPlan planOf(const scene::Scene& scene) {
  ModalPlan plan;
  std::vector<std::string> notes;
  EXPECT_TRUE(planModes(Network(scene), kRates, 0, plan, notes));
  return plan;
}

/// A plate that is heard in two places and pushed in one of them and in a third.
Plate pushedPlate() {
  Plate b;
  const double k = 0.2 * Plate::kMass * kRate * kRate;
  b.first = 0;
  for (int i = 0; i < Plate::kColumns * Plate::kRows; ++i) {
    b.cell(Plate::kMass, 0.01 * k, 1e-6 * 0.01 * k);
  }
  for (int row = 0; row < Plate::kRows; ++row) {
    for (int column = 0; column < Plate::kColumns; ++column) {
      if (column + 1 < Plate::kColumns) {
        b.spring(b.of(column, row), b.of(column + 1, row), k, 1e-6 * k);
      }
      if (row + 1 < Plate::kRows) {
        b.spring(b.of(column, row), b.of(column, row + 1), k, 1e-6 * k);
      }
    }
  }
  b.hear(b.of(3, 4), 0);
  b.hear(b.of(9, 2), 1);
  b.force(b.of(3, 4), 0);
  b.force(b.of(5, 8), 1);
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

TEST_F(ModalChoiceTest, KickOfAModeGoesNoFurtherThanItsBound) {
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

TEST_F(ModalChoiceTest, ErrorAfterImpulsesStaysBelowTheBoundThatIsPrinted) {
  const scene::Scene scene = pushedPlate().scene;
  for (const int modes : {20, 60, 110}) {
    const scene::Scene reduced = withModes(scene, modes);
    const double bound = planOf(reduced).error.per_impulse;
    Player network(scene, kRates);
    Player modal(reduced, kRates);
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
    EXPECT_NE(described(reduced).find(shortly(bound) + " m at any time after impulses"),
              std::string::npos);
  }
}

TEST_F(ModalChoiceTest, OneKickComesNearTheBound) {
  const scene::Scene scene = pushedPlate().scene;
  const scene::Scene reduced = withModes(scene, 119);
  Player network(scene, kRates);
  Player modal(reduced, kRates);
  network.inputs[0] = modal.inputs[0] = 1.0;
  for (int n = 0; n < 300; ++n) {
    network.tick();
    modal.tick();
    std::fill(network.inputs.begin(), network.inputs.end(), 0.0);
    modal.inputs = network.inputs;
  }
  const double bound = planOf(reduced).error.per_impulse / kRate;
  EXPECT_LE(largestError(network, modal), bound * (1.0 + 1e-9));
}

TEST_F(ModalChoiceTest, GiveUnderAConstantForceIsShortByTheShareThatIsPrinted) {
  const scene::Scene scene = pushedPlate().scene;
  const scene::Scene reduced = withModes(scene, 40);
  Player network(scene, kRates);
  Player modal(reduced, kRates);
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

TEST_F(ModalChoiceTest, MotionAtTheStartIsOffByNoMoreThanTheBound) {
  Plate b = pushedPlate();
  for (int i = 0; i < Plate::kColumns * Plate::kRows; ++i) {
    b.scene.mats[at(i)].position.x() = 1e-4 * std::cos(0.9 * i);
    b.scene.mats[at(i)].push.edit().velocity.x() = 0.1 * std::sin(0.4 * i);
    b.scene.mats[at(i)].push.edit().force.x() = 0.2 * std::cos(1.3 * i);
  }
  const scene::Scene reduced = withModes(b.scene, 50);
  Player network(b.scene, kRates);
  Player modal(reduced, kRates);
  network.ticks(500);
  modal.ticks(500);
  const double bound = planOf(reduced).error.at_start;
  EXPECT_LE(largestError(network, modal), bound);
  EXPECT_GT(largestError(network, modal), 0.01 * bound);
}

TEST_F(ModalChoiceTest, MoreModesAreNeverWorse) {
  const scene::Scene scene = pushedPlate().scene;
  double before = planOf(withModes(scene, 1)).error.per_impulse;
  for (int modes = 10; modes <= 120; modes += 10) {
    const double now = planOf(withModes(scene, modes)).error.per_impulse;
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0.0);
}

TEST_F(ModalChoiceTest, AutomaticModesArePlayedWhereTheyCostLess) {
  Built random;
  for (int i = 0; i < 200; ++i) {
    random.mass(1e-3);
    for (int step = 1; step <= 3 && i > 0; ++step) {
      random.spring((i * 37 * step) % i, i, 1e4);
    }
  }
  random.hear(20);
  const std::string chosen = described(withModes(random.scene, scene::kAutomaticModes));
  EXPECT_NE(chosen.find("is played by 200 modes, touched at 1 places"), std::string::npos)
      << chosen;
}

TEST_F(ModalChoiceTest, AutomaticModesAreLeftWhereANetworkCostsLess) {
  Built even;
  const int first = even.chain(100, 1e-3, 1e5);
  even.hear(first + 10);
  even.hear(first + 70);
  const std::string chosen = described(withModes(even.scene, scene::kAutomaticModes));
  EXPECT_NE(chosen.find("stays a network: by 100 modes, touched at 2 places"), std::string::npos)
      << chosen;
}

TEST_F(ModalChoiceTest, AutomaticModesAreLeftWhereTheyCannotBe) {
  Built b = dampedString();
  b.point(0, 32, 1, 0.3, 0.0);
  b.scene.connections.back().guide = 3;
  const std::string chosen = described(withModes(b.scene, scene::kAutomaticModes));
  EXPECT_NE(chosen.find("stays a network: point 'p32' can move"), std::string::npos) << chosen;
}

TEST_F(ModalChoiceTest, DampingOutOfProportionIsRefusedWithItsPlace) {
  Built b;
  const int first = b.chain(200, 1e-3, 1e5, 0.1);
  for (std::size_t l = 0; l < b.scene.lias.size(); ++l) {
    b.scene.lias[l].damping.factor *= 1.0 + static_cast<double>(l);
  }
  b.hear(first + 3);
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("built.yaml:101:1: error: section 'audio' cannot be played by its modes: "
                       "link 'l1' has damping / stiffness = 2e-06, most have 1e-06"),
            std::string::npos)
      << error;
}

TEST_F(ModalChoiceTest, UnequalMassesInAMediumAreRefusedWithTheirPlace) {
  Built b = dampedString();
  b.scene.sections[0].medium = {1e-3};
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("built.yaml:3:1: error"), std::string::npos) << error;
  EXPECT_NE(error.find("module 'm2' loses"), std::string::npos) << error;
}

TEST_F(ModalChoiceTest, SpringsThatFollowAParameterAreRefusedWithTheirPlace) {
  Built b;
  b.scene.parameters.push_back({"tension", 1.0, 0.5, 2.0, {}});
  const int first = b.chain(20, 1e-3, 1e5);
  for (scene::Lia& lia : b.scene.lias) {
    lia.stiffness.parameter = 0;
  }
  b.hear(first + 3);
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("built.yaml:100:1: error"), std::string::npos) << error;
  EXPECT_NE(error.find("link 'l0' follows a parameter"), std::string::npos) << error;
}

TEST_F(ModalChoiceTest, ForcesOnFreeModulesAreRefusedAsOutputs) {
  Built b;
  const int first = b.chain(2, 1e-3, 1e5);
  b.hear(first + 1, 0, scene::Quantity::kForce);
  b.hear(first + 2, 0, scene::Quantity::kForce);
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("the force on module 'm1' is an output"), std::string::npos) << error;
}

TEST_F(ModalChoiceTest, GuardedLinksOnPlacesThatMoveEachOtherAreRefused) {
  const Plate b = playedPlate();
  const std::string error = errorOf(withModes(b.scene, 60));
  EXPECT_NE(error.find("guarded link"), std::string::npos) << error;
  EXPECT_NE(error.find("modes are left out"), std::string::npos) << error;
}

TEST_F(ModalChoiceTest, PlacesOnGroundsWhoseForceIsHeardAreRefused) {
  Built b = dampedString();
  b.hear(b.point(0, 32, 1, 0.4 / 31.0, 0.0), 4);
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("built.yaml:500:1: error"), std::string::npos) << error;
  EXPECT_NE(error.find("whose force is an output"), std::string::npos) << error;
}

TEST_F(ModalChoiceTest, TooManyTouchedPlacesAreRefused) {
  Built b;
  const int first = b.chain(100, 1e-3, 1e5);
  for (int i = 1; i <= kMostTouches + 1; ++i) {
    b.force(first + i);
  }
  const std::string error = errorOf(withModes(b.scene, scene::kAllModes));
  EXPECT_NE(error.find("65 of its modules are touched by what is not part of the modes, allowed: "
                       "at most 64"),
            std::string::npos)
      << error;
}

}  // namespace
}  // namespace ergotic::physics
