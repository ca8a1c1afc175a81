// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/model_loader.hpp"

#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(ModelLoaderTest, AnswersWhatPlaysWithWarningsAndWithoutNotes) {
  const std::string note =
      "a.yaml:3:1: note: link 'pluck': energy-stable\na.yaml:5:1: warning: group 'a' begins twice";
  EXPECT_EQ(answerOn("a string", note, true),
            "plays 'a string'; call engage for force\n"
            "a.yaml:5:1: warning: group 'a' begins twice");
  EXPECT_EQ(answerOn("a string", "", false), "plays 'a string'");
}

TEST(ModelLoaderTest, FindsWhatStandsOnTheSlicesBesideAScene) {
  const std::string drum = test::repository("models/drum.yaml");
  EXPECT_EQ(handsBeside(drum), test::repository("models/hands/drum.yaml"));
  EXPECT_EQ(handsBeside(drum + "#variant"), test::repository("models/hands/drum.yaml"));
  EXPECT_EQ(handsBeside(test::repository("models/string.yaml")), "");
  EXPECT_EQ(handsBeside("ergotic: 1\nname: drum\n"), "");
}

TEST(ModelLoaderTest, OnlySimulatedDevicesGetTheEndEffectorsOfAnInstrument) {
  const std::string drum = test::repository("models/drum.yaml");
  const std::string string = test::repository("models/string.yaml");
  EXPECT_EQ(endEffectorsWith(drum, string, false), handsBeside(drum));
  EXPECT_EQ(endEffectorsWith(string, drum, false), "none");
  EXPECT_EQ(endEffectorsWith(drum, drum, false), "");
  EXPECT_EQ(endEffectorsWith(string, string, false), "");
  EXPECT_EQ(endEffectorsWith(drum, string, true), "");
  EXPECT_EQ(endEffectorsWith(string, drum, true), "");
}

TEST(ModelLoaderTest, ListsTheParametersThatThereAre) {
  scene::Scene scene;
  EXPECT_EQ(unknownParameter("x", scene), "the model has no parameter 'x', and no other");
  scene.parameters.resize(2);
  scene.parameters[0] = {"loss", 0.1, 0.0, 0.5, "N s/m"};
  scene.parameters[1] = {"gain", 1.0, 0.25, 4.0, ""};
  EXPECT_EQ(unknownParameter("los\n", scene),
            "the model has no parameter 'los\\x0A', it has: loss = 0...0.5 N s/m, gain = 0.25...4");
  scene.parameters.resize(30, scene.parameters[1]);
  EXPECT_THAT(unknownParameter("x", scene), testing::EndsWith(", ..."));
}

}  // namespace
}  // namespace ergotic::node
