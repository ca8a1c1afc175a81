// SPDX-License-Identifier: BSD-3-Clause
// Hands inside a scene, beside those of players.

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// Moves the ports of agents as time goes on.
void moveAgents(Player& player, int tick) {
  const scene::Scene& scene = player.instrument->scene();
  for (std::size_t p = 0; p < scene.ports.size(); ++p) {
    if (scene.ports[p].agent >= 0) {
      const auto agent = static_cast<std::size_t>(scene.ports[p].agent);
      player.positions[p] = scene.agents[agent].at(tick * kTick);
    }
  }
}

double displacementOf(const Player& player, std::size_t coordinate) {
  std::vector<float> all(static_cast<std::size_t>(player.instrument->scene().coordinates()));
  player.instrument->readDisplacements(all.data());
  return static_cast<double>(all[coordinate]);
}

/// Elongation left k ticks after a jump of 1 of the target, by the poles of the scheme.
double leftAfter(int k, double mass, double stiffness, double damping) {
  const double kappa = kTick * kTick * stiffness / mass;
  const double zeta = kTick * damping / mass;
  const double radius = std::sqrt(1.0 - zeta);
  const double angle = std::acos((2.0 - kappa - zeta) / (2.0 * radius));
  const double sine = (1.0 - kappa - zeta - radius * std::cos(angle)) / (radius * std::sin(angle));
  return std::pow(radius, k) * (std::cos(k * angle) + sine * std::sin(k * angle));
}

std::string stepAgent(char axis, double damping) {
  return std::string("agents: {a: {mat: m, axis: ") + axis +
         ", stiffness: 200, damping: " + std::to_string(damping) +
         ",\n             points: [[0, 0], [0.01, 0], [0.010001, 0.02]]}}\n";
}
constexpr int kBefore = 31;  // ticks up to the step

struct StepCase {
  char axis;
  double damping;    ///< of the hand, N s/m
  double tolerance;  ///< m
};

/// Along its axis, and along no other. In space a hand without a damper is explicit, as in scalar
/// sections; one with a damper is energy-stable, whose poles are another scheme's: within 0.5 % of
/// the step.
TEST(AgentsTest, AStepPullsAMassAsThePolesOfTheSchemeSay) {
  for (const auto& [axis, damping, tolerance] :
       {StepCase{'x', 1.5, 2e-9}, StepCase{'y', 0.0, 2e-9}, StepCase{'y', 1.5, 1e-4}}) {
    const std::string space = axis == 'x' ? "" : ", geometry: space";
    const std::string place = axis == 'x' ? "" : ", at: [1, 2, 3]";
    const std::string step = stepAgent(axis, damping);
    Player player(
        scene::readYaml("ergotic: 1\nsections: {h: {rate: gestural" + space +
                            "}}\nmats: {m: {type: mass, mass: 0.1" + place + "}}\n" + step,
                        "agent.yaml"),
        kRates);
    for (int n = 0; n < 400; ++n) {
      moveAgents(player, n);
      player.tick();
      const int k = n - kBefore - 1;
      const double expected = k < 0 ? 0.0 : 0.02 * (1.0 - leftAfter(k, 0.1, 200.0, damping));
      EXPECT_NEAR(displacementOf(player, axis == 'x' ? 0 : 1), expected, tolerance)
          << axis << ", " << damping << " N s/m, tick " << n;
      if (axis == 'y') {
        EXPECT_EQ(displacementOf(player, 0), 0.0);
        EXPECT_EQ(displacementOf(player, 2), 0.0);
      }
    }
  }
}

TEST(AgentsTest, APlayerAtAnotherPortFeelsNothingButTheModel) {
  const auto feel = [](const std::string& agents) {
    Player player(scene::readYaml("ergotic: 1\nsections: {h: {rate: gestural}}\n"
                                  "mats: {m: {type: mass, mass: 0.1}, n: {type: mass, mass: 0.1},\n"
                                  "       k: {type: slice}}\n"
                                  "lias: {l: {type: spring, between: [k, n], stiffness: 100}}\n"
                                  "ports: {key: {mat: k, slice: 0}}\n" +
                                      agents,
                                  "agent.yaml"),
                  kRates);
    std::vector<double> felt;
    for (int n = 0; n < 200; ++n) {
      moveAgents(player, n);
      player.positions[0] = 0.01 * std::sin(0.1 * n);
      player.tick();
      felt.push_back(player.forces[0]);
    }
    return felt;
  };
  EXPECT_EQ(feel(stepAgent('x', 1.5)), feel(""));
  EXPECT_NE(feel("agents: {a: {mat: n, stiffness: 20, points: [[0, 0], [1, 1]]}}\n"), feel(""));
}

TEST(AgentsTest, AStiffHandIsJudgedAsALinkAndNotAsAPort) {
  const auto certificate = [](const std::string& stiffness) {
    const scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections: {h: {rate: gestural}}\nmats: {m: {type: mass, mass: 0.1}}\n"
        "agents: {a: {mat: m, stiffness: " +
            stiffness + ", points: [[0, 0]]}}\n",
        "agent.yaml");
    return certify(scene, kRates);
  };
  const double stable = 4.0 * 0.1 / (kTick * kTick);
  const Certificate stiff = certificate(std::to_string(0.99 * stable));
  EXPECT_TRUE(stiff.ports.empty());
  EXPECT_EQ(stiff.verdict, Verdict::kPassive);
  EXPECT_TRUE(stiff.findings.empty());
  EXPECT_EQ(certificate(std::to_string(1.01 * stable)).verdict, Verdict::kUnstable);
}

}  // namespace
}  // namespace ergotic::physics
