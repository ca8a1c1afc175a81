// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

/// The same modules, links, points, inputs and outputs; rounded as the texts say.
void expectSameModel(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.mats.size(), b.mats.size());
  for (std::size_t i = 0; i < a.mats.size(); ++i) {
    const Mat& m = a.mats[i];
    const Mat& n = b.mats[i];
    SCOPED_TRACE(m.name);
    EXPECT_EQ(m.name, n.name.str());
    EXPECT_EQ(m.type, n.type);
    EXPECT_EQ(m.mass.factor, n.mass.factor);
    EXPECT_EQ(m.stiffness.factor, n.stiffness.factor);
    EXPECT_EQ(m.damping.factor, n.damping.factor);
    EXPECT_EQ(m.position.x(), n.position.x());
    EXPECT_NEAR(m.push->velocity.x(), n.push->velocity.x(), 1e-15);
    EXPECT_DOUBLE_EQ(m.push->force.x(), n.push->force.x());
  }
  ASSERT_EQ(a.lias.size(), b.lias.size());
  for (std::size_t i = 0; i < a.lias.size(); ++i) {
    const Lia& l = a.lias[i];
    const Lia& k = b.lias[i];
    SCOPED_TRACE(l.name);
    EXPECT_EQ(l.type, k.type);
    EXPECT_EQ(std::pair(l.a, l.b), std::pair(k.a, k.b));
    EXPECT_EQ(l.stiffness.factor, k.stiffness.factor);
    EXPECT_EQ(l.damping.factor, k.damping.factor);
    EXPECT_EQ(l.law->width.factor, k.law->width.factor);
    EXPECT_EQ(l.law->nonlinearity.factor, k.law->nonlinearity.factor);
  }
  ASSERT_EQ(a.connections.size(), b.connections.size());
  for (std::size_t i = 0; i < a.connections.size(); ++i) {
    EXPECT_EQ(a.connections[i].along.at.factor, b.connections[i].along.at.factor);
    EXPECT_EQ(a.connections[i].across.at.factor, b.connections[i].across.at.factor);
  }
  ASSERT_EQ(a.inputs.size(), b.inputs.size());
  for (std::size_t i = 0; i < a.inputs.size(); ++i) {
    EXPECT_EQ(a.inputs[i].mat, b.inputs[i].mat);
  }
  ASSERT_EQ(a.outputs.size(), b.outputs.size());
  for (std::size_t i = 0; i < a.outputs.size(); ++i) {
    EXPECT_EQ(a.outputs[i].point.mat, b.outputs[i].point.mat);
    EXPECT_EQ(a.outputs[i].quantity, b.outputs[i].quantity);
  }
}

TEST(MdlDialectTest, BothLanguagesSayTheSameModel) {
  const std::string older = R"(
# a drum of the older language
@K param 0.05
@a mass 2 0.5 0.49
@f massG 1 0.001 1 1 drum 3 4
@o osc 1 0.1 K 0.2 0.2 drum 0 0
@g ground 0.25 drum 1 1
@in1 posInput 0.1
@s spring @a @g K
@d spring @a @o K 0.002
@n nlSpring @f @g K 0.3 0.001
@str string 6 1 K 0.01 0
@rod stiffString 5 1 K 0.02 0.01 0.5
@whole chain 4 1 K 0.01 0
@skin closedMesh 4 5 1 K 0.01 0.125
@sheet cornerMesh 3 3 1 K 0.01 0
@net mesh 2 3 1 K 0.01 0
@c contact @skin @in1 K 0.01 0. 0.3:0.6
@b nlBow @in1 @str 0.3 0.01 0.2
@p nlPluck @str @rod 0.1 0.02 0.4 K*2
@r spring @net @sheet K 0.01 0.5:0.5 0.1:0.9
@t spring @whole @a K 1
@in2 frcInput @str 0.7
@out1 posOutput @skin 0.2:0.8
@out2 frcOutput @a
@out3 frcOutput @rod 0.4
)";
  const std::string newer = R"(
@K param 0.05
@a mass 2 [0 0 0.5] 441
@f mass 1 44.1 1 0
@o osc 1 0.1 K 0.2 0
@g ground 0.25
@in1 posInput 0.1
@s spring @a @g K
@d springDamper @a @o K 0.002
@n nlSpring2 @f @g K 0.3 0.001
@str string 6 1 K 0.01 0 0
@rod stiffString 5 1 K 0.02 0.01 0.5 0
@whole chain 4 1 K 0.01 0 0
@skin closedMesh 4 5 1 K 0.01 0.125 0
@sheet cornerMesh 3 3 1 K 0.01 0 0
@net mesh 2 3 1 K 0.01 0 0
@c contact [@skin 0.3 0.6] @in1 K 0.01 0.
@b nlBow @in1 [@str 0.2] 0.3 0.01
@p nlPluck [@str 0.4] [@rod K*2] 0.1 0.02
@r springDamper [@net 0.5 0.5] [@sheet 0.1 0.9] K 0.01
@t spring [@whole 1] @a K
@in2 frcInput [@str 0.7]
@out1 posOutput [@skin 0.2 0.8]
@out2 frcOutput @a
@out3 frcOutput [@rod 0.4]
)";
  const Scene scene = readMdl(older, "m.mdl");
  expectSameModel(scene, readMdl(newer, "m.mdl"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.connections.size(), 10U);
}

TEST(MdlDialectTest, AnythingThatOnlyOneLanguageSaysTells) {
  const auto velocity = [](const std::string& line) {
    const Scene scene = readMdl("@m mass 1 0.5 0.25\n@n ground 0\n" + line + "\n", "m.mdl");
    EXPECT_TRUE(scene.warnings.empty()) << line;
    return scene.mats[0].push->velocity.x();
  };
  for (const char* line :
       {"@x massG 1 2 0 0", "@x nlSpring @m @n 1 2 3", "@x spring @m @n 1 0.1",
        "@x mass 1 0 0 buffer 1 2", "@x osc 1 1 1 0 0 buffer 1 2", "@x ground 0 buffer 1 2",
        "@in1 posInput 0 buffer 1 2", "@x string 5 1 1 0 0", "@x stiffString 5 1 1 1 0 0",
        "@x chain 5 1 1 0 0", "@x mesh 5 5 1 1 0 0", "@x closedMesh 5 5 1 1 0 0"}) {
    EXPECT_EQ(velocity(line), 0.25) << line;
  }
  for (const char* line :
       {"@x mass 1 2 0 0", "@x osc 1 1 1 2 0 0", "@x ground [0 0 0]", "~begin a\n~end a",
        "@x nlContact @m @n 1 2 3 4", "@x nlSpringDamper @m @n 1 2 3 4", "@x string 5 1 1 0 0 0",
        "@x stiffString 5 1 1 1 0 0 0 0", "@x mesh 5 5 1 1 0 0 0"}) {
    EXPECT_EQ(velocity(line), 0.25 / 44100.0) << line;
  }
}

TEST(MdlDialectTest, WhereNothingTellsTheNewerOneIsReadAndTheOtherWrittenOut) {
  const Scene scene = readMdl("@m mass 1 0.5 0.25\n", "m.mdl");
  EXPECT_EQ(scene.mats[0].push->velocity.x(), 0.25 / 44100.0);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_THAT(scene.warnings[0], HasSubstr("which here is [0 0 11025]"));
}

}  // namespace
}  // namespace ergotic::scene
