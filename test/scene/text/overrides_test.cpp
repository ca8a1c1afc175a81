// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/overrides.hpp"

#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kYaml =
    "ergotic: 1\n"
    "parameters: {loss: {value: 0.001, range: [0, 0.01]}, size: {value: 2, range: [1, 4]}}\n"
    "sections: {a: {}}\n"
    "mats: {m: {type: cell, mass: 0.5*$size, damping: $loss}}\n";

const std::string kMdl =
    "@s param [2 * K + 1]\n"
    "@K param 0.1\n"
    "@m osc 1 K s 0 0\n";

std::string refusal(const std::string& text, const std::string& name, const Overrides& overrides) {
  return complaintOf([&] { readScene(text, name, overrides); });
}

TEST(OverridesTest, ReplaceTheValueOfAParameterAndNothingElse) {
  const Scene s = readYaml(kYaml, "a.yaml", {{"size", 3.0}});
  EXPECT_EQ(s.parameters[1].value, 3.0);
  EXPECT_EQ(s.parameters[1].minimum, 1.0);
  EXPECT_EQ(s.parameters[1].maximum, 4.0);
  EXPECT_EQ(s.parameters[0].value, 0.001);
  EXPECT_EQ(s.valueOf(s.mats[0].mass), 1.5);
  EXPECT_EQ(s.text, kYaml);
}

TEST(OverridesTest, SetTheGesturalRateOfEitherFormat) {
  EXPECT_EQ(readYaml(kYaml, "a.yaml", {{"gestural_rate", 44100.0}}).gestural_rate_hz, 44100.0);
  EXPECT_EQ(readMdl(kMdl, "a.mdl", {{"gestural_rate", 5000.0}}).gestural_rate_hz, 5000.0);
}

TEST(OverridesTest, ReplaceAParamOfMdlBeforeOthersUseIt) {
  const Scene s = readMdl(kMdl, "a.mdl", {{"K", 0.25}});
  EXPECT_EQ(s.mats[0].stiffness.factor, 0.25);
  EXPECT_EQ(s.mats[0].damping.factor, 1.5);
  EXPECT_EQ(s.text, kMdl);
  EXPECT_TRUE(s.parameters.empty());
}

TEST(OverridesTest, TextNameAndOverridesGiveTheSameSceneAgain) {
  const Overrides overrides = {{"size", 4.0}, {"loss", 0.01}, {"gestural_rate", 2000.0}};
  const Scene once = readScene(kYaml, "a.yaml", overrides);
  const Scene again = readScene(once.text, once.file, overrides);
  EXPECT_EQ(again.text, once.text);
  EXPECT_EQ(again.gestural_rate_hz, once.gestural_rate_hz);
  EXPECT_EQ(again.valueOf(again.mats[0].mass), once.valueOf(once.mats[0].mass));
  EXPECT_EQ(again.valueOf(again.mats[0].damping), 0.01);
}

TEST(OverridesTest, OutsideTheRangeAreRefusedAtBothEnds) {
  EXPECT_THAT(refusal(kYaml, "a.yaml", {{"size", 4.5}}),
              AllOf(HasSubstr("'size' = 4.5"), HasSubstr("allowed: 1...4")));
  EXPECT_THAT(refusal(kYaml, "a.yaml", {{"loss", -1.0}}), HasSubstr("allowed: 0...0.01"));
  EXPECT_EQ(refusal(kYaml, "a.yaml", {{"loss", 0.01}}), "");
  EXPECT_THAT(refusal(kYaml, "a.yaml", {{"gestural_rate", 100.0}}),
              HasSubstr("allowed: 500...48000 Hz"));
}

TEST(OverridesTest, UnknownNamesAreRefusedWithAllThatAreKnown) {
  EXPECT_THAT(refusal(kYaml, "a.yaml", {{"los", 1.0}}),
              AllOf(HasSubstr("'los'"), HasSubstr("known: loss, size, gestural_rate")));
  EXPECT_THAT(refusal(kMdl, "a.mdl", {{"k", 1.0}}),
              AllOf(HasSubstr("'k'"), HasSubstr("known: s, K, faust_clip, gestural_rate")));
}

TEST(OverridesTest, ThatAreNoFiniteNumberAreRefused) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal(kYaml, "a.yaml", {{"size", bad}}), HasSubstr("is not a finite number"));
    EXPECT_THAT(refusal(kMdl, "a.mdl", {{"K", bad}}), HasSubstr("is not a finite number"));
  }
}

TEST(OverridesTest, ThatMakeAnMdlModelIllegalAreRefusedWhereTheyAreUsed) {
  EXPECT_THAT(refusal(kMdl, "a.mdl", {{"K", -1.0}}),
              HasSubstr("a.mdl:3:10: error: stiffness of '@m' = -1 is out of range"));
}

}  // namespace
}  // namespace ergotic::scene
