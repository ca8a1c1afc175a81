// SPDX-License-Identifier: BSD-3-Clause
// How faster sections see a slice that leaves it to the station.

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using scene::Coupling;

/// A slice on a spring to a string, or to a mass beside it.
SceneBuilder touched(double stiffness, Coupling coupling, int section = SceneBuilder::kAudio) {
  SceneBuilder b;
  const int first = b.chain(20, 1e-3, 2e4, 1e-3);
  const int other = section == SceneBuilder::kAudio ? first + 7 : b.ground(0.0, section);
  const int hand = b.slice(0);
  b.spring(hand, other, stiffness);
  b.scene.mats[at(hand)].name = "key";
  b.scene.mats[at(hand)].coupling = coupling;
  return b;
}

struct Chosen {
  Coupling coupling = Coupling::kHold;
  std::size_t chaplets = 0;
  std::vector<std::string> notes;
};

Chosen chosenFor(const SceneBuilder& b, const Rates& rates = kRates) {
  Settled settled = settle(b.scene, rates);
  Chosen chosen;
  for (const scene::Mat& mat : settled.scene.mats) {
    chosen.coupling = mat.name == "key" ? mat.coupling : chosen.coupling;
    chosen.chaplets += std::string(mat.name).find(".filter.1") != std::string::npos ? 1 : 0;
  }
  chosen.notes = std::move(settled.notes);
  return chosen;
}

TEST(CouplingChoiceTest, WhatAHandBearsIsInterpolated) {
  const Chosen chosen = chosenFor(touched(60.0, Coupling::kAuto));
  EXPECT_EQ(chosen.coupling, Coupling::kSmooth);
  EXPECT_EQ(chosen.chaplets, 0U);
  EXPECT_THAT(
      chosen.notes,
      Contains(AllOf(HasSubstr("slice 'key' gets coupling smooth: steps of 3.65e-05 %"),
                     HasSubstr("passive up to 2.1e+03 N/m"), HasSubstr("; hold: steps of 1.15 %"),
                     HasSubstr("passive up to 4.2e+03 N/m"),
                     HasSubstr("; chaplet: steps of 0.0288 %"))));
}

TEST(CouplingChoiceTest, WhatItBearsOnlyHeldIsHeld) {
  EXPECT_EQ(chosenFor(touched(60.0, Coupling::kAuto), {44100.0, 2}).coupling, Coupling::kSmooth);
  SceneBuilder b = touched(1500.0, Coupling::kAuto);
  b.scene.sections[1].geometry = Geometry::kPlane;  // where there is no chaplet
  b.scene.ports[0].axis = 0;
  const Chosen chosen = chosenFor(b);
  EXPECT_EQ(chosen.coupling, Coupling::kHold);
  EXPECT_THAT(chosen.notes, Contains(AllOf(HasSubstr("gets coupling hold"), HasSubstr("; smooth: "),
                                           HasSubstr("it may buzz"))));
}

TEST(CouplingChoiceTest, WhatIsAttachedToAHandForGoodIsNotDampedByAChaplet) {
  const Chosen chosen = chosenFor(touched(300.0, Coupling::kAuto));
  EXPECT_EQ(chosen.chaplets, 0U);
  EXPECT_THAT(chosen.notes,
              Contains(AllOf(HasSubstr("gets coupling "), HasSubstr("; chaplet: steps of 0.0288 %"),
                             HasSubstr("it damps what is attached there"))));
  SceneBuilder b = touched(300.0, Coupling::kAuto);
  b.scene.lias.back().type = scene::LiaType::kContact;
  EXPECT_THAT(chosenFor(b).notes, Not(Contains(HasSubstr("it damps"))));
}

TEST(CouplingChoiceTest, BehindAChapletAHandBearsWhatIsStiff) {
  const Chosen chosen = chosenFor(touched(50000.0, Coupling::kAuto));
  EXPECT_EQ(chosen.coupling, Coupling::kHold);
  EXPECT_EQ(chosen.chaplets, 1U);
  EXPECT_THAT(chosen.notes, Contains(AllOf(HasSubstr("gets coupling chaplet: steps of"),
                                           HasSubstr(" of 5e+04 N/m"), HasSubstr("it will buzz"))));
}

TEST(CouplingChoiceTest, WhatNothingFasterTouchesIsHeldWithoutAWord) {
  const Chosen chosen = chosenFor(touched(500.0, Coupling::kAuto, SceneBuilder::kGestural));
  EXPECT_EQ(chosen.coupling, Coupling::kHold);
  EXPECT_THAT(chosen.notes, Not(Contains(HasSubstr("coupling"))));
}

TEST(CouplingChoiceTest, WhatIsSaidIsKept) {
  EXPECT_EQ(chosenFor(touched(5e4, Coupling::kSmooth)).coupling, Coupling::kSmooth);
  EXPECT_EQ(chosenFor(touched(500.0, Coupling::kHold)).coupling, Coupling::kHold);
  EXPECT_EQ(chosenFor(touched(500.0, Coupling::kChaplet)).chaplets, 1U);
  EXPECT_THAT(chosenFor(touched(500.0, Coupling::kSmooth)).notes,
              Not(Contains(HasSubstr("gets coupling"))));
}

TEST(CouplingChoiceTest, AChapletThatCannotBeIsRefusedWithItsPlace) {
  EXPECT_THROW(settle(touched(500.0, Coupling::kChaplet).scene, {44100.0, 2}), TextError);
}

}  // namespace
}  // namespace ergotic::physics
