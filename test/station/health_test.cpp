// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/health.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/performer.hpp"
#include "support/alloc_count.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

/// Three links: l0, l1, l2.
scene::Scene links() {
  test::SceneBuilder b;
  const int mass = b.mass(1.0);
  for (int i = 0; i < 3; ++i) {
    b.spring(mass, b.ground(), 1.0);
  }
  return b.scene;
}

TEST(HealthTest, TellsOfLinksThatAreCutInMoreThanFivePercentOfTheirStepsWorstFirst) {
  EXPECT_THAT(tankWarnings(links(), {}, {{0, 1000, 60}, {1, 1000, 50}, {2, 200, 150}}),
              ElementsAre(AllOf(HasSubstr("built.yaml:"), HasSubstr("warning: link 'l2'"),
                                HasSubstr("75 % of 200 steps"), HasSubstr("Lower its 'damping'")),
                          AllOf(HasSubstr("link 'l0'"), HasSubstr("6 % of 1000 steps"))));
}

TEST(HealthTest, SaysHowStiffALinkCanBeForItsMassesAndThoseThatShareThem) {
  scene::Scene scene = links();  // of 1 kg and the ground
  for (scene::Lia& lia : scene.lias) {
    lia.scheme = scene::Scheme::kEnergyStable;
  }
  const double alone = 44100.0 * 44100.0;
  EXPECT_NEAR(mostStiffness(scene, scene.lias[0], {}), alone / 3.0, 1e-6 * alone);
  scene.lias[1].stiffness.factor = 6.6e8;
  EXPECT_THAT(tankWarnings(scene, {}, {{1, 1000, 60}}),
              ElementsAre(HasSubstr("its 'stiffness' is 6.6e+08, and from about 6.5e+08 down")));
}

/// A gram that three damped contacts share falls onto them and stays there. \param share  of the
/// stiffness that is told to be the most
std::vector<std::string> warningsOfABall(double share) {
  constexpr double kMax = 1e-3 * 44100.0 * 44100.0 / 3.0;
  std::ostringstream text;
  text << "ergotic: 1\nsections: {s: {rate: audio, gravity: -9.81}}\nmats:\n"
          "  ground: {type: ground, section: s, at: [0, 0]}\n"
          "  ball: {type: mass, section: s, mass: 1 g, at: [0, 0], x: 0.002}\n"
          "  rider: {type: mass, section: s, mass: 1 g, at: [0.1, 0], x: 0.0005}\n"
          "lias:\n"
          "  tie: {type: spring_damper, between: [ball, rider], stiffness: 500, damping: 0.02,\n"
          "        rest_length: 0.0015}\n";
  for (int i = 0; i < 3; ++i) {
    text << "  c" << i << ": {type: contact, between: [ground, ball], stiffness: " << share * kMax
         << ", damping: 0.05, scheme: energy_stable}\n";
  }
  const physics::Rates rates{44100.0, 14};
  const auto performer =
      makePerformer(scene::readYaml(text.str(), "ball.yaml"), rates, physics::Precision::kDouble);
  for (int tick = 0; tick < 3 * 3150; ++tick) {
    performer->instrument->tick({performer->positions.data(), performer->forces.data(),
                                 performer->inputs.data(), performer->outputs.data()});
  }
  std::vector<physics::TankReport> tanks = performer->instrument->makeTankReports();
  performer->instrument->readTanks(tanks);
  return tankWarnings(performer->instrument->scene(), rates, tanks);
}

TEST(HealthTest, TheStiffnessThatItTellsIsCutNoMore) {
  EXPECT_THAT(warningsOfABall(9.0), Contains(HasSubstr("and from about 6.5e+05 down")));
  EXPECT_THAT(warningsOfABall(1.0), IsEmpty());
  EXPECT_THAT(warningsOfABall(0.3), IsEmpty());
}

// A lower damping would not help there.
TEST(HealthTest, SaysWhatTakesFromAContactOnAPointThatMovesOrOnABodyThatIsStretched) {
  const auto warningOf = [](const std::string& along) {
    const scene::Scene scene = physics::settle(scene::readYaml(R"(
ergotic: 1
sections: {s: {rate: audio}, keys: {rate: gestural}}
mats:
  guide: {type: slice, section: keys}
  tip: {type: mass, section: s, mass: 10 g, x: -1 mm, rest: -1 mm}
  under: {type: point, along: )" + along + R"(, at: 0.5, guide: {mat: guide, scale: 10}}
generators:
  - {type: string, name: led, section: s, masses: 20, mass: 1 g, from: [0, 0], to: [0.2, 0], stiffness: 2000}
  - {type: string, name: stretched, section: s, masses: 20, mass: 1 g, from: [0, 0], to: [0.2, 0], stiffness: 2000}
lias:
  tension: {type: stretch, of: stretched, spacing: 0.01, hardening: 40}
  touch: {type: contact, between: [tip, under], stiffness: 500, damping: 0.1, scheme: energy_stable}
)",
                                                               "led.yaml"),
                                               {})
                                   .scene;
    const auto touch = std::find_if(scene.lias.begin(), scene.lias.end(), [](const auto& lia) {
      return std::string(lia.name) == "touch";
    });
    const auto warnings =
        tankWarnings(scene, {}, {{static_cast<int>(touch - scene.lias.begin()), 1000, 600}});
    return warnings.size() == 1 ? warnings.front() : "";
  };
  EXPECT_THAT(warningOf("led"), HasSubstr("moves over a body, which takes what it holds"));
  EXPECT_THAT(warningOf("stretched"), HasSubstr("what 'tension' holds in one tank"));
}

TEST(HealthTest, KeepsQuietAboutLinksThatHardlyPushed) {
  EXPECT_THAT(tankWarnings(links(), {}, {{0, 199, 199}, {1, 0, 0}}), IsEmpty());
}

TEST(HealthTest, MeasuresTheResidualAgainstAllTheEnergyThatThereWas) {
  physics::Energies energies;
  EXPECT_EQ(relativeResidual(energies), 0.0);
  energies.sections.resize(2);
  energies.couplings.resize(1);
  energies.stored = 1.0;
  energies.residual = -1e-9;
  EXPECT_DOUBLE_EQ(relativeResidual(energies), -1e-9);
  energies.sections[1].dissipated = 2.0;
  energies.couplings[0].dissipated = 1.0;
  EXPECT_DOUBLE_EQ(relativeResidual(energies), -0.25e-9);
}

constexpr physics::Rates kLoadRates{44100.0, 12};

/// Two plates at two rates, half as many modules and links in strings.
std::string scene(int strings, int side) {
  std::string text = "ergotic: 1\nsections: {a: {}, b: {rate: {divisor: 2}}}\ngenerators:\n";
  for (int i = 0; i < strings; ++i) {
    text += "  - {type: string, name: s" + std::to_string(i) +
            ", section: a, masses: 99, mass: 1e-4, frequency: " + std::to_string(50 + i % 50) +
            ", damping: 1e-4, to: [0.6, 0]}\n";
  }
  for (const char* section : {"a", "b"}) {
    text += std::string("  - {type: mesh, name: plate_") + section + ", section: " + section +
            ", rows: " + std::to_string(side) + ", columns: " + std::to_string(side) +
            ", spacing: 0.01, mass: 1e-3, stiffness: 1e5, neighbours: 8}\n";
  }
  return text + "outputs: {o: {at: s0@0.3, quantity: position, channel: 1}}\n";
}

std::size_t partsOf(const physics::Instrument& instrument) {
  return instrument.scene().mats.size() + instrument.scene().lias.size();
}

TEST(LoadTest, AModuleOrLinkTakesAtMostTwoHundredBytes) {
  if (!test::AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the heap is the sanitizer's";
  }
  const std::string text = scene(60, 32);
  const auto bytesOf = [](const std::string& what, std::size_t& parts) {
    const test::AllocationScope scope;
    const auto performer =
        makePerformer(scene::readYaml(what, "load.yaml"), kLoadRates, physics::Precision::kFloat);
    parts = partsOf(*performer->instrument);
    return scope.bytes();
  };
  std::size_t few = 0;
  std::size_t many = 0;
  const std::int64_t fixed = bytesOf(scene(1, 3), few);
  const std::int64_t all = bytesOf(text, many);
  ASSERT_GE(many, 20000U);
  EXPECT_LE(static_cast<double>(all - fixed) / static_cast<double>(many - few), 200.0);
}

TEST(LoadTest, TwoHundredThousandModulesAndLinksLoad) {
  const auto performer = makePerformer(scene::readYaml(scene(500, 100), "load.yaml"), kLoadRates,
                                       physics::Precision::kFloat);
  EXPECT_GE(partsOf(*performer->instrument), 190000U);
  EXPECT_EQ(performer->certificate.verdict, physics::Verdict::kPassive);
  for (int i = 0; i < 2; ++i) {
    performer->instrument->tick({performer->positions.data(), performer->forces.data(),
                                 performer->inputs.data(), performer->outputs.data()});
  }
  EXPECT_TRUE(performer->instrument->isFinite());
}

TEST(LoadTest, TheListenerHearsEveryStage) {
  std::vector<std::string> stages;
  PerformerPolicy policy;
  policy.on_stage = [&](const std::string& stage) { stages.push_back(stage); };
  makePerformer(scene::readYaml(scene(1, 3), "load.yaml"), kLoadRates, physics::Precision::kFloat,
                policy);
  ASSERT_EQ(stages.size(), 3U);
  EXPECT_EQ(stages[0].substr(0, 9), "validate ");
  EXPECT_EQ(stages[1].substr(0, 8), "certify ");
  EXPECT_EQ(stages[2].substr(0, 8), "compile ");
}

TEST(LoadTest, ARefusalCarriesItsVerdict) {
  const char* const stiff =
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n"
      "  - {type: string, name: s, masses: 9, mass: 1, stiffness: 1e12, to: [1, 0]}\n";
  try {
    makePerformer(scene::readYaml(stiff, "stiff.yaml"), kLoadRates, physics::Precision::kFloat);
    FAIL() << "was not refused";
  } catch (const RefusedScene& refusal) {
    EXPECT_EQ(refusal.verdict(), physics::Verdict::kUnstable);
  }
}

}  // namespace
}  // namespace ergotic::station
