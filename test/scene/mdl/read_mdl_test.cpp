// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "scene/bad_text.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kTwo = "@a mass 1 0 0\n@b mass 1 0 0\n";

Lia linkOf(const std::string& line) {
  return readMdl(kTwo + line, "m.mdl").lias.at(0);
}

TEST(ReadMdlTest, SceneCountsTimeInSamplesOfOneAudioSection) {
  const Scene s = readMdl(kTwo, "dir/two.mdl");
  EXPECT_EQ(s.name, "two");
  EXPECT_EQ(s.file, "dir/two.mdl");
  EXPECT_EQ(s.text, kTwo);
  EXPECT_EQ(s.time_unit_s, 1.0 / 44100.0);
  ASSERT_EQ(s.sections.size(), 1U);
  EXPECT_FALSE(s.sections[0].gestural);
  EXPECT_EQ(s.sections[0].divisor, 1);
  EXPECT_EQ(s.sections[0].gravity.x(), 0.0);
}

TEST(ReadMdlTest, MassTakesPlaceFromXYAndMotionFromZ) {
  const Mat m = readMdl("@m mass 2.5 [1 2 3] [4 5 44.1]\n", "m.mdl").mats.at(0);
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.type, MatType::kMass);
  EXPECT_EQ(m.mass.factor, 2.5);
  EXPECT_EQ(m.rest.y(), 1.0);
  EXPECT_EQ(m.rest.z(), 2.0);
  EXPECT_EQ(m.position.x(), 3.0);
  EXPECT_EQ(m.rest.x(), 0.0);
  EXPECT_DOUBLE_EQ(m.push->velocity.x(), 0.001);
  EXPECT_EQ(m.push->force.x(), 0.0);
}

TEST(ReadMdlTest, GravityIsAForceForEachStepWhateverTheMass) {
  const Scene s = readMdl("@m mass 2 9.81 0 0\n@o osc 3 0.1 0.2 9.81 0 0\n", "m.mdl");
  EXPECT_DOUBLE_EQ(s.mats[0].push->force.x(), -9.81 / 44100.0);
  EXPECT_DOUBLE_EQ(s.mats[1].push->force.x(), -9.81 / 44100.0);
}

TEST(ReadMdlTest, OscIsACellThatRestsAtTheOrigin) {
  const Mat m = readMdl("@o osc 3 0.1 0.2 [1 2 0.5] -1\n", "m.mdl").mats.at(0);
  EXPECT_EQ(m.type, MatType::kCell);
  EXPECT_EQ(m.mass.factor, 3.0);
  EXPECT_EQ(m.stiffness.factor, 0.1);
  EXPECT_EQ(m.damping.factor, 0.2);
  EXPECT_EQ(m.position.x(), 0.5);
  EXPECT_EQ(m.rest.x(), 0.0);
  EXPECT_DOUBLE_EQ(m.push->velocity.x(), -1.0 / 44100.0);
}

TEST(ReadMdlTest, GroundRestsWhereItIs) {
  const Mat m = readMdl("@g ground 1.5\n", "m.mdl").mats.at(0);
  EXPECT_EQ(m.type, MatType::kGround);
  EXPECT_EQ(m.position.x(), 1.5);
  EXPECT_EQ(m.rest.x(), 1.5);
}

TEST(ReadMdlTest, PosInputIsADrivenModuleWithItsInput) {
  const Scene s = readMdl("@in3 posInput [1 2 0.25]\n", "m.mdl");
  EXPECT_EQ(s.mats.at(0).type, MatType::kDriven);
  EXPECT_EQ(s.mats[0].position.x(), 0.25);
  ASSERT_EQ(s.inputs.size(), 1U);
  EXPECT_EQ(s.inputs[0].name, "in3");
  EXPECT_EQ(s.inputs[0].quantity, Quantity::kPosition);
  EXPECT_EQ(s.inputs[0].channel, 2);
  EXPECT_EQ(s.inputs[0].mat, 0);
  EXPECT_EQ(s.inputs[0].gain.factor, 1.0);
}

TEST(ReadMdlTest, ForceInputsMayShareAChannel) {
  const Scene s = readMdl(kTwo + "@in2 frcInput @a\n@in2 frcInput @b\n", "m.mdl");
  ASSERT_EQ(s.inputs.size(), 2U);
  EXPECT_EQ(s.inputs[0].name, "in2");
  EXPECT_EQ(s.inputs[0].quantity, Quantity::kForce);
  EXPECT_EQ(s.inputs[0].mat, 0);
  EXPECT_EQ(s.inputs[1].channel, 1);
  EXPECT_EQ(s.inputs[1].mat, 1);
  EXPECT_EQ(s.inputChannels(), 2);
}

TEST(ReadMdlTest, OutputsTapPositionAndForce) {
  const Scene s = readMdl(kTwo + "@out4 posOutput @b\n@out1 frcOutput @a\n", "m.mdl");
  EXPECT_EQ(s.outputs.at(0).name, "out4");
  EXPECT_EQ(s.outputs[0].quantity, Quantity::kPosition);
  EXPECT_EQ(s.outputs[0].channel, 3);
  EXPECT_EQ(s.outputs[0].point.mat, 1);
  EXPECT_EQ(s.outputs[0].point.next, -1);
  EXPECT_EQ(s.outputs[1].quantity, Quantity::kForce);
  EXPECT_EQ(s.outputs[1].channel, 0);
  EXPECT_EQ(s.outputChannels(), 4);
}

struct ReadLink {
  const char* text;
  LiaType type;
  double stiffness;
  double damping;
  double nonlinearity = 0.0;
  double stiffness_limit = 0.0;
  double width = 0.0;
};

TEST(ReadMdlTest, LinksTakeTheirArgumentsInOrderAndOptionalOnes) {
  const ReadLink links[] = {
      {"spring @a @b 0.5", LiaType::kSpringDamper, 0.5, 0.0},
      {"damper @a @b 0.5", LiaType::kSpringDamper, 0.0, 0.5},
      {"springDamper @a @b 0.5 0.25", LiaType::kSpringDamper, 0.5, 0.25},
      {"contact @a @b 1 2", LiaType::kContact, 1.0, 2.0},
      {"contact @a @b 1 2 -0.5", LiaType::kContact, 1.0, 2.0, 0.0, 0.0, -0.5},
      {"nlContact @a @b 1 2 3 4", LiaType::kCubicContact, 1.0, 4.0, 2.0, 3.0},
      {"nlContact @a @b 1 2 3 4 0.5", LiaType::kCubicContact, 1.0, 4.0, 2.0, 3.0, 0.5},
      {"nlContact @a @b 3 2 3 4", LiaType::kContact, 3.0, 4.0},  // it starts at its limit
      {"nlSpring2 @a @b 1 2 3", LiaType::kQuadratic, 1.0, 3.0, 2.0},
      {"nlSpring3 @a @b 1 -2 3", LiaType::kCubic, 1.0, 3.0, -2.0},
      {"nlSpringDamper @a @b 1 2 3 4", LiaType::kClippedCubic, 1.0, 4.0, 2.0, 3.0},
      {"nlPluck @a @b 1 0.1", LiaType::kPluck, 1.0, 0.0, 0.0, 0.0, 0.1},
      {"nlPluck @a @b 1 0.1 0.2", LiaType::kPluck, 1.0, 0.2, 0.0, 0.0, 0.1},
      {"nlBow @a @b 0.3 0.01", LiaType::kBow, 0.0, 0.3, 0.0, 0.0, 0.01},
      {"nlBow @a @b 0.3 0.01 0", LiaType::kBow, 0.0, 0.3, 0.0, 0.0, 0.01},
      {"nlBow @a @b 0.3 0.01 1", LiaType::kSmoothBow, 0.0, 0.3, 0.0, 0.0, 0.01},
  };
  for (const ReadLink& link : links) {
    const Lia read = linkOf(std::string("@l ") + link.text + "\n");
    EXPECT_EQ(read.name, "l");
    EXPECT_EQ(read.type, link.type) << link.text;
    EXPECT_EQ(std::pair(read.a, read.b), std::pair(0, 1)) << link.text;
    EXPECT_EQ(read.stiffness.factor, link.stiffness) << link.text;
    EXPECT_EQ(read.damping.factor, link.damping) << link.text;
    EXPECT_EQ(read.law->nonlinearity.factor, link.nonlinearity) << link.text;
    EXPECT_EQ(read.law->stiffness_limit.factor, link.stiffness_limit) << link.text;
    EXPECT_EQ(read.law->limit_damping.factor > 0.0, link.type == LiaType::kClippedCubic)
        << link.text;
    EXPECT_EQ(read.law->width.factor, link.width) << link.text;
  }
  EXPECT_EQ(linkOf("@l damper @b @a 0.5\n").a, 1);
}

TEST(ReadMdlTest, LinksMayShareANameWithAWarning) {
  const Scene s = readMdl(kTwo + "@r spring @a @b 1\n@r spring @a @b 2\n@r.2 damper @a @b 3\n" +
                              "@r contact @a @b 4 0\n",
                          "m.mdl");
  ASSERT_EQ(s.lias.size(), 4U);
  EXPECT_EQ(s.lias[0].name, "r");
  EXPECT_EQ(s.lias[1].name, "r.2");
  EXPECT_EQ(s.lias[2].name, "r.2.2");
  EXPECT_EQ(s.lias[3].name, "r.3");
  ASSERT_EQ(s.warnings.size(), 3U);
  EXPECT_THAT(s.warnings[0], HasSubstr("m.mdl:4:1: warning: link '@r' has the name of that in line "
                                       "3, it is called 'r.2' here"));
}

TEST(ReadMdlTest, DetentIsTheOldNameOfAContact) {
  const Scene s =
      readMdl("@a mass 1 0. 0.5\n@b mass 1 0. 0.\n@d detent @a @b 0.1 0.2 0.3\n", "m.mdl");
  EXPECT_EQ(s.lias.at(0).type, LiaType::kContact);
  EXPECT_EQ(s.lias[0].law->width.factor, 0.3);
  EXPECT_DOUBLE_EQ(s.mats[0].push->velocity.x(), -0.5) << "its file is of the older language";
}

TEST(ReadMdlTest, OnlyLinksThatComeAndGoMayBecomeEnergyStable) {
  const auto schemeOf = [](const std::string& line) { return linkOf("@l " + line + "\n").scheme; };
  EXPECT_EQ(schemeOf("contact @a @b 1 0"), Scheme::kExplicitIfStable);
  EXPECT_EQ(schemeOf("nlContact @a @b 1 2 3 0"), Scheme::kExplicitIfStable);
  EXPECT_EQ(schemeOf("spring @a @b 1"), Scheme::kExplicit);
  EXPECT_EQ(schemeOf("nlBow @a @b 1 0.1"), Scheme::kExplicit);
  EXPECT_EQ(schemeOf("contact @a @b p 0\n@p audioParam @in1"), Scheme::kExplicit);
}

/// The one audio parameter that is made of an expression.
AudioParameter madeOf(const std::string& text) {
  const Scene s = readMdl("@p audioParam @in2\n" + kTwo + text, "m.mdl");
  EXPECT_EQ(s.audio_parameters.size(), 2U) << text;
  return s.audio_parameters.back();
}

TEST(ReadMdlTest, StraightLinesOfAnAudioParamBecomeOneOfTheirOwn) {
  const AudioParameter p = madeOf("@s spring @a @b [0.5 - 2*p/4]\n@t damper @a @b [0.5 - 2*p/4]\n");
  EXPECT_EQ(p.name, "0.5 - 2*p/4");
  EXPECT_EQ(p.channel, 1);
  EXPECT_EQ(p.at(0.0), 0.5);
  EXPECT_EQ(p.at(3.0), -1.0);
  EXPECT_EQ(p.place.line, 4);
  EXPECT_EQ(p.place.column, 18);
}

TEST(ReadMdlTest, WhatMustBeAboveZeroIsKeptThere) {
  for (const char* text : {"@m mass p 0 0\n", "@s nlBow @a @b 1 p\n", "@s nlPluck @a @b 1 2*p\n"}) {
    const AudioParameter p = madeOf(text);
    EXPECT_GT(p.value, 0.0) << text;
    EXPECT_EQ(p.at(-1.0), p.minimum) << text;
    EXPECT_LT(p.minimum, 1e-6) << text;
  }
  EXPECT_EQ(madeOf("@s nlPluck @a @b 1 2*p\n").at(3.0), 6.0);
}

TEST(ReadMdlTest, ExpressionsFollowTheUsualPrecedence) {
  const auto massOf = [](const std::string& expression) {
    return readMdl("@m mass " + expression + " 0 0\n@p param 3\n@q param [p + 1]\n", "m.mdl")
        .mats.at(0)
        .mass.factor;
  };
  EXPECT_EQ(massOf("p"), 3.0);
  EXPECT_EQ(massOf("q"), 4.0);
  EXPECT_EQ(massOf("0.5*p"), 1.5);
  EXPECT_EQ(massOf("p-0.5"), 2.5);
  EXPECT_EQ(massOf("[p + 2 * q - 4 / 2]"), 9.0);
  EXPECT_EQ(massOf("[(p + 2) * -(1 - q)]"), 15.0);
  EXPECT_EQ(massOf("12/p/2"), 2.0);
  EXPECT_EQ(massOf("9-p-q"), 2.0);
  EXPECT_EQ(massOf("'pow(2, p) + sqrt(q)'"), 10.0);
  EXPECT_DOUBLE_EQ(massOf("[exp(1) + log(2) + sin(0.5) + cos(0.5) + abs(-1)]"),
                   std::exp(1.0) + std::log(2.0) + std::sin(0.5) + std::cos(0.5) + 1.0);
  EXPECT_EQ(massOf("[min(p, q) + 10 * max(p, q)]"), 43.0);
  EXPECT_EQ(massOf("1e-3"), 1e-3);
  EXPECT_EQ(massOf("[1e+3]"), 1000.0);
  EXPECT_EQ(massOf(".5"), 0.5);
}

TEST(ReadMdlTest, CommentsGroupsAndProseAreSkipped) {
  const Scene s = readMdl(
      "This is a model of two masses.\n\n# @x mass 1 0 0\n~begin group\n"
      "  \t@a mass 1 0 0 # [trailing @b mass]\n~end group\n"
      "# caf\xE9 in Latin-1\n@b mass 1 0 0#close\n",
      "m.mdl");
  EXPECT_EQ(s.mats.size(), 2U);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(ReadMdlTest, LinksMayComeBeforeTheirModules) {
  const Scene s =
      readMdl("@out1 posOutput @b\n@l spring @b @a k\n" + kTwo + "@k param 1\n", "m.mdl");
  EXPECT_EQ(s.lias.at(0).a, 1);
  EXPECT_EQ(s.outputs.at(0).point.mat, 1);
  EXPECT_EQ(s.mats[0].name, "a");
}

TEST(ReadMdlTest, WindowsLineEndsAndByteOrderMarkChangeNothing) {
  const Scene s = readMdl("\xEF\xBB\xBF@a mass 1 [0 0 2] 0\r\n@b ground 3\r\n", "m.mdl");
  ASSERT_EQ(s.mats.size(), 2U);
  EXPECT_EQ(s.mats[0].position.x(), 2.0);
  EXPECT_EQ(s.mats[1].position.x(), 3.0);
}

TEST(ReadMdlTest, VelocityWithoutAnyVectorIsWarnedOf) {
  const Scene doubtful = readMdl("@a mass 1 0 0.5\n", "m.mdl");
  ASSERT_EQ(doubtful.warnings.size(), 1U);
  EXPECT_THAT(doubtful.warnings[0], HasSubstr("m.mdl:1:13: warning: the last number of '@a'"));
  EXPECT_TRUE(readMdl("@a mass 1 0 [0 0 0.5]\n", "m.mdl").warnings.empty());
}

TEST(ReadMdlTest, ElementWithoutItsAtSignIsWarnedOf) {
  const Scene s = readMdl("@a mass 1 0 0\n b mass 1 0 0\n", "m.mdl");
  EXPECT_EQ(s.mats.size(), 1U);
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_THAT(s.warnings[0], HasSubstr("m.mdl:2:2: warning: this line is skipped"));
}

TEST(MdlErrorsTest, BytesThatNoTextHasAreRefusedAtTheirPlace) {
  expectRefused({"@a mass 1 0 0\n@\xC3\xA9 mass 1 0 0\n@c<!>\xE9 mass 1 0 0\n", "not UTF-8"},
                "bad.mdl");
  expectRefused({"@a mass 1 0 <!>\x01\n", "control character 0x01"}, "bad.mdl");
}

TEST(MdlErrorsTest, UnusedParamsAreEvaluatedToo) {
  expectRefused({"@p param 1<!>/0\n", "division by zero"}, "bad.mdl");
}

TEST(MdlErrorsTest, DeepExpressionsAndLongChainsAreErrorsNotCrashes) {
  std::string deep = "@a mass ";
  deep += std::string(100000, '(') + "1" + std::string(100000, ')') + " 0 0\n";
  EXPECT_THROW(readMdl(deep, "deep.mdl"), TextError);
  EXPECT_THROW(readMdl("@a mass " + std::string(100000, '-') + "1 0 0\n", "minus.mdl"), TextError);
  std::string chain;
  for (int i = 0; i < 100000; ++i) {
    chain += "@p" + std::to_string(i) + " param p" + std::to_string(i + 1) + "\n";
  }
  EXPECT_THROW(readMdl(chain + "@p100000 param 1\n", "chain.mdl"), TextError);
}

TEST(MdlErrorsTest, DeepestExpressionsInTheLongestChainAreStillRead) {
  std::string text = "@m mass p0 0 0\n";
  for (int i = 0; i < 63; ++i) {
    text += "@p" + std::to_string(i) + " param " + std::string(31, '(') + "p" +
            std::to_string(i + 1) + std::string(31, ')') + "\n";
  }
  EXPECT_EQ(readMdl(text + "@p63 param 2\n", "chain.mdl").mats.at(0).mass.factor, 2.0);
}

}  // namespace
}  // namespace ergotic::scene
