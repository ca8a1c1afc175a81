// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/performer.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_device.hpp"

namespace ergotic::station {
namespace {

using test::kRates;

/// The default instrument on a `virtual_tgr` that is a process of its own, with all defaults.
TEST(PerformerTest, DefaultInstrumentGreetsWithoutAWarning) {
  const double rate_hz = tgr::VirtualDeviceConfig().rate_hz;
  for (const double audio_hz : {44100.0, 48000.0}) {
    const scene::Scene scene = scene::readSceneFile(test::repository("models/string.yaml"));
    const physics::Rates rates = physics::chooseRates(scene, audio_hz, 0.0);
    PerformerPolicy policy;
    policy.device.delay_ticks = 1.0 + std::ceil(2.0 / rate_hz * rates.gesturalHz());
    EXPECT_EQ(policy.device.delay_ticks, 2.0);
    const auto performer = makePerformer(scene, rates, physics::Precision::kFloat, policy);
    for (const std::string& warning : performer->warnings) {
      EXPECT_THAT(warning, Not(HasSubstr("warning")));
    }
  }
}

std::unique_ptr<Performer> make(const scene::Scene& scene, const PerformerPolicy& policy = {}) {
  return makePerformer(scene, kRates, physics::Precision::kDouble, policy);
}

/// A struck oscillator under slice 3.
test::SceneBuilder oscillator(double stiffness) {
  test::SceneBuilder b;
  const int mass = b.mass(1e-3, 1e-3);
  b.spring(mass, b.ground(), stiffness);
  b.link(scene::LiaType::kContact, b.slice(3), mass, 1e3, 0.1);
  b.scene.lias.back().scheme = scene::Scheme::kEnergyStable;
  b.hear(mass);
  return b;
}

std::string refusalOf(const scene::Scene& scene, const PerformerPolicy& policy = {}) {
  return complaintOf([&] { make(scene, policy); });
}

TEST(PerformerTest, HoldsBuffersForEveryPortAndChannelOfATick) {
  const auto performer = make(oscillator(1e3).scene);
  EXPECT_EQ(performer->positions.size(), 1U);
  EXPECT_EQ(performer->forces.size(), 1U);
  EXPECT_EQ(performer->inputs.size(), 0U);
  EXPECT_EQ(performer->outputs.size(), 14U);
  EXPECT_EQ(performer->rig->slicesInUse(), 1U << 3U);
  EXPECT_EQ(performer->motion.draft().displacement.size(), 3U);
}

TEST(PerformerTest, StartsInTheStateThatWasCompiled) {
  const scene::Scene scene = oscillator(1e3).scene;
  const auto performer = make(scene);
  const auto fresh = physics::compile(scene, kRates, physics::Precision::kDouble);
  std::vector<unsigned char> warm(performer->instrument->stateSize());
  std::vector<unsigned char> cold(fresh->stateSize());
  performer->instrument->saveState(warm.data());
  fresh->saveState(cold.data());
  EXPECT_EQ(warm, cold);
}

TEST(PerformerTest, PlaysTheSettledSceneAndTellsWhatWasChosen) {
  scene::Scene scene = oscillator(1e3).scene;
  scene.lias[1].scheme = scene::Scheme::kAuto;
  scene.warnings = {"read"};
  const auto performer = make(scene);
  EXPECT_EQ(performer->instrument->scene().lias[1].scheme, scene::Scheme::kEnergyStable);
  EXPECT_EQ(performer->warnings.front(), "read");
  EXPECT_THAT(performer->warnings.back(), HasSubstr("note: link 'l1': energy-stable"));
}

TEST(PerformerTest, ShowsTheModelBeforeItsFirstTick) {
  const auto performer = make(oscillator(1e3).scene);
  ASSERT_TRUE(performer->motion.refresh());
  EXPECT_FLOAT_EQ(performer->motion.latest().displacement[0], 1e-3F);
}

TEST(PerformerTest, ShowsTheEnergyOfTheModelBeforeItsFirstTick) {
  const auto performer = make(oscillator(1e3).scene);
  ASSERT_TRUE(performer->motion.refresh());
  const physics::Energies& energies = performer->motion.latest().energies;
  ASSERT_EQ(energies.sections.size(), performer->instrument->scene().sections.size());
  EXPECT_NEAR(energies.stored, 0.5 * 1e3 * 1e-3 * 1e-3, 1e-12) << "a spring of 1e3 N/m, by 1 mm";
}

TEST(PerformerTest, HoldsAsManyNumbersOfMotionAsCoordinatesMove) {
  test::SceneBuilder b = oscillator(1e3);
  scene::Section net;
  net.name = "net";
  net.geometry = scene::Geometry::kSpace;
  b.scene.sections.push_back(net);
  b.scene.mats.push_back(b.scene.mats[0]);
  b.scene.mats.back().name = "loose";
  b.scene.mats.back().section = static_cast<int>(b.scene.sections.size()) - 1;
  b.scene.mats.back().position = {0.1, 0.2, 0.3};
  const auto performer = make(b.scene);
  ASSERT_TRUE(performer->motion.refresh());
  const std::vector<float>& displacement = performer->motion.latest().displacement;
  ASSERT_EQ(displacement.size(), 6U);
  EXPECT_FLOAT_EQ(displacement[4], 0.2F);
  EXPECT_FLOAT_EQ(displacement[5], 0.3F);
}

TEST(PerformerTest, RefusesAnUnstableSceneWithTheFindings) {
  const std::string refusal = refusalOf(oscillator(1e9).scene);
  EXPECT_THAT(refusal, HasSubstr("unstable"));
  EXPECT_THAT(refusal, HasSubstr("built.yaml:"));
}

TEST(PerformerTest, PlaysAnUnstableSceneOnlyIfAskedAndWarns) {
  PerformerPolicy policy;
  policy.allow_unproven = true;
  EXPECT_NE(refusalOf(oscillator(1e9).scene, policy), "");
  policy.allow_unstable = true;
  const auto performer = make(oscillator(1e9).scene, policy);
  EXPECT_EQ(performer->certificate.verdict, physics::Verdict::kUnstable);
  EXPECT_FALSE(performer->warnings.empty());
}

TEST(PerformerTest, PlaysAnUnprovenSceneOnlyIfAsked) {
  test::SceneBuilder b = oscillator(1e3);
  b.link(scene::LiaType::kCubic, 0, 1, 10.0);  // its slope has no bound
  b.scene.lias.back().law.edit().nonlinearity = {1e3};
  EXPECT_THAT(refusalOf(b.scene), HasSubstr("unproven"));
  PerformerPolicy policy;
  policy.allow_unproven = true;
  EXPECT_EQ(make(b.scene, policy)->certificate.verdict, physics::Verdict::kUnproven);
}

TEST(PerformerTest, PassesOnTheWarningsOfTheReader) {
  scene::Scene scene = oscillator(1e3).scene;
  scene.warnings.emplace_back("built.yaml:1:1: warning: look");
  ASSERT_FALSE(make(scene)->warnings.empty());
  EXPECT_EQ(make(scene)->warnings[0], "built.yaml:1:1: warning: look");
}

TEST(PerformerTest, RefusesASliceThatTheDeviceDoesNotHave) {
  PerformerPolicy policy;
  policy.slices = 3;
  EXPECT_NE(refusalOf(oscillator(1e3).scene, policy).find("slice 3"), std::string::npos);
  policy.slices = 4;
  EXPECT_EQ(refusalOf(oscillator(1e3).scene, policy), "");
}

TEST(PerformerTest, RefusesAnInvalidScene) {
  scene::Scene scene = oscillator(1e3).scene;
  scene.mats[0].mass = {-1.0};
  EXPECT_THROW(make(scene), TextError);
}

}  // namespace
}  // namespace ergotic::station
