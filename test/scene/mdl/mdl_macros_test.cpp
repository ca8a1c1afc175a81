// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>

#include <Eigen/Eigenvalues>

#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

Scene sceneOf(const std::string& text) {
  return readMdl(text, "m.mdl");
}

/// omega^2 of a scene of springs and masses, in rising order.
std::vector<double> eigenvalues(const Scene& scene) {
  std::vector<int> row(scene.mats.size(), -1);
  int moving = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    row[i] = scene.mats[i].type == MatType::kGround ? -1 : moving++;
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(moving, moving);
  for (const Lia& lia : scene.lias) {
    const int a = row[static_cast<std::size_t>(lia.a)];
    const int b = row[static_cast<std::size_t>(lia.b)];
    const double k = lia.stiffness.factor /
                     scene.mats[static_cast<std::size_t>(a >= 0 ? lia.a : lia.b)].mass.factor;
    for (const int end : {a, b}) {
      if (end >= 0) {
        matrix(end, end) += k;
      }
    }
    if (a >= 0 && b >= 0) {
      matrix(a, b) -= k;
      matrix(b, a) -= k;
    }
  }
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  return {values.data(), values.data() + values.size()};
}

/// 4 k sin^2 of half the angle: of a row of springs k of mass 1.
double rowMode(double k, double angle) {
  return 4.0 * k * std::pow(std::sin(0.5 * angle), 2);
}

/// Modes of `masses` between two grounds, 1...; of a free row, 0...
std::vector<double> fixedModes(double k, int masses) {
  std::vector<double> modes;
  for (int i = 1; i <= masses; ++i) {
    modes.push_back(rowMode(k, i * M_PI / (masses + 1)));
  }
  return modes;
}
std::vector<double> freeModes(double k, int masses) {
  std::vector<double> modes;
  for (int i = 0; i < masses; ++i) {
    modes.push_back(rowMode(k, i * M_PI / masses));
  }
  return modes;
}

/// Of a net that is the product of two rows.
std::vector<double> sums(const std::vector<double>& rows, const std::vector<double>& columns) {
  std::vector<double> modes;
  for (const double row : rows) {
    for (const double column : columns) {
      modes.push_back(row + column);
    }
  }
  return modes;
}

void expectModes(const std::string& text, std::vector<double> wanted) {
  SCOPED_TRACE(text);
  std::sort(wanted.begin(), wanted.end());
  const std::vector<double> got = eigenvalues(sceneOf(text));
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i], wanted[i], 1e-12) << i;
  }
}

TEST(MdlMacrosTest, VibrateInTheModesOfTheirClosedForms) {
  expectModes("@s string 14 2 0.6 0.01 [0 0 0] [1 0 0]\n", fixedModes(0.3, 12));
  expectModes("@c chain 14 2 0.6 0.01 [0 0 0] [1 0 0]\n", freeModes(0.3, 14));
  expectModes("@m mesh 5 7 2 0.6 0.01 [0 0 0] [1 1 0]\n",
              sums(freeModes(0.3, 5), freeModes(0.3, 7)));
  expectModes("@m closedMesh 5 7 2 0.6 0.01 [0 0 0] [1 1 0]\n",
              sums(fixedModes(0.3, 3), fixedModes(0.3, 5)));
}

TEST(MdlMacrosTest, SecondSpringsOfAStiffStringAreTwoRowsThatInterlace) {
  // With K = 0: the odd masses lie between a ground and the end's own spring, as do the even ones.
  for (const int masses : {1, 2, 9, 10}) {
    std::vector<double> modes = fixedModes(0.2, (masses + 1) / 2);
    const std::vector<double> others = fixedModes(0.2, masses / 2);
    modes.insert(modes.end(), others.begin(), others.end());
    expectModes("@s stiffString " + std::to_string(masses + 2) + " 2 0 0.4 0.01 [0 0 0] [1 0 0]\n",
                modes);
  }
}

TEST(MdlMacrosTest, StiffStringsBeginAsStringsDo) {
  const Scene scene = sceneOf("@s stiffString 6 2 0.6 0.05 0.01 [0 0 0] [1 0 0]\n");
  ASSERT_EQ(scene.lias.size(), 5U + 2U + 4U);
  const auto ends = [&](std::size_t i) { return std::pair(scene.lias[i].a, scene.lias[i].b); };
  for (int i = 0; i < 5; ++i) {
    const Lia& lia = scene.lias[static_cast<std::size_t>(i)];
    EXPECT_EQ(ends(static_cast<std::size_t>(i)), std::pair(i, i + 1));
    EXPECT_EQ(lia.stiffness.factor, 0.6);
    EXPECT_EQ(lia.damping.factor, 0.01);
  }
  EXPECT_EQ(ends(5), std::pair(0, 1));
  EXPECT_EQ(ends(6), std::pair(0, 2));
  EXPECT_EQ(ends(9), std::pair(3, 5));
  EXPECT_EQ(ends(10), std::pair(4, 5));
  for (std::size_t i = 5; i < 11; ++i) {
    EXPECT_EQ(scene.lias[i].stiffness.factor, 0.05);
    EXPECT_EQ(scene.lias[i].damping.factor, 0.0);
  }
}

TEST(MdlMacrosTest, StringIsAGridWithAPitch) {
  const Scene scene = sceneOf("@s string 5 2 0.6 0.01 0.003 [0 1 0.5] [8 3 44.1]\n");
  ASSERT_EQ(scene.mats.size(), 5U);
  EXPECT_EQ(scene.mats[0].name, "s.0");
  EXPECT_EQ(scene.lias.at(3).name, "s.link.3");
  for (const std::size_t end : {0U, 4U}) {
    EXPECT_EQ(scene.mats[end].type, MatType::kGround);
    EXPECT_EQ(scene.mats[end].rest.x(), 0.5);
  }
  const Mat& second = scene.mats[2];
  EXPECT_EQ(second.type, MatType::kCell);
  EXPECT_FALSE(second.matched);
  EXPECT_EQ(second.mass.factor, 2.0);
  EXPECT_EQ(second.stiffness.factor, 0.0);
  EXPECT_EQ(second.damping.factor, 0.003);
  EXPECT_EQ(second.rest, Eigen::Vector3d(0.0, 4.0, 2.0));
  EXPECT_EQ(second.position.x(), 0.5);
  EXPECT_DOUBLE_EQ(second.push->velocity.x(), 0.001);
  ASSERT_EQ(scene.grids.size(), 1U);
  EXPECT_EQ(scene.grids[0].columns, 5);
  EXPECT_EQ(scene.grids[0].rows, 1);
  ASSERT_EQ(scene.strings.size(), 1U);
  const double angle =
      modeAngle(0.3 * stringEigenvalue(3, 1), 0.0015 + 0.005 * stringEigenvalue(3, 1));
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 44100.0), angle * 44100.0 / (2.0 * M_PI),
              1e-9);
}

TEST(MdlMacrosTest, WithoutDampingToTheGroundTheyAreMasses) {
  for (const char* text : {"@s chain 3 1 1 0 [0 0 0] [1 0 0]\n", "@s chain 3 1 1 0 0 0 0\n"}) {
    const Scene scene = sceneOf(text);
    EXPECT_EQ(scene.mats.at(1).type, MatType::kMass);
    EXPECT_TRUE(scene.strings.empty());
  }
}

TEST(MdlMacrosTest, FixedModulesAreAllAroundInTheCornersOrNowhere) {
  const auto grounds = [](const std::string& keyword) {
    std::string fixed;
    for (const Mat& mat : sceneOf("@m " + keyword + " 3 4 1 0.1 0 [0 0 0.5] [2 3 1]\n").mats) {
      fixed += mat.type == MatType::kGround ? '#' : '.';
    }
    return fixed;
  };
  EXPECT_EQ(grounds("mesh"), "............");
  EXPECT_EQ(grounds("cornerMesh"), "#..#....#..#");
  EXPECT_EQ(grounds("closedMesh"), "#####..#####");
}

TEST(MdlMacrosTest, RowsOfAMeshLieAlongX) {
  const Scene scene = sceneOf("@m mesh 3 4 1 0.1 0 [0 0 0.5] [2 30 0]\n");
  EXPECT_EQ(scene.mats.at(6).name, "m.1.2");
  EXPECT_EQ(scene.mats.at(6).rest, Eigen::Vector3d(0.0, 1.0, 20.0));
  EXPECT_EQ(scene.grids.at(0).rows, 3);
  EXPECT_EQ(scene.grids.at(0).columns, 4);
}

TEST(MdlPointsTest, FirstCoordinateOfAMeshCountsRows) {
  const Scene scene = sceneOf(
      "@out1 posOutput [@m L 1-L]\n@L param 0.25\n@g ground 0\n"
      "@l spring [@m L 1-L] @g 1\n@in1 frcInput [ @s  2*L ]\n"
      "@m mesh 3 4 1 0.1 0 0 0\n@s string 5 1 1 0 0 0\n");
  ASSERT_EQ(scene.connections.size(), 2U);
  const Connection& net = scene.connections[0];
  EXPECT_EQ(net.across.at.factor, 0.25);
  EXPECT_EQ(net.along.at.factor, 0.75);
  EXPECT_EQ(net.across.guide, -1);
  EXPECT_EQ(scene.outputs.at(0).point.mat, net.mat);
  EXPECT_EQ(scene.lias.back().a, net.mat);
  EXPECT_EQ(scene.mats[static_cast<std::size_t>(net.mat)].name, "m@0.25:0.75");
  EXPECT_EQ(scene.connections[1].along.at.factor, 0.5);
  EXPECT_EQ(scene.inputs.at(0).mat, scene.connections[1].mat);
}

TEST(MdlPointsTest, StartWhereTheirModulesAreAndMoveAsThese) {
  const Scene scene = sceneOf(
      "@s string 4 1 1 0 [0 0 0.5] [3 0 88.2]\n@out1 posOutput [@s 0.5]\n"
      "@out2 frcOutput [@s 0.5]\n");
  ASSERT_EQ(scene.connections.size(), 1U);
  const Mat& point = scene.mats.back();
  EXPECT_EQ(point.type, MatType::kPoint);
  EXPECT_DOUBLE_EQ(point.position.x(), 0.5);
  EXPECT_DOUBLE_EQ(point.push->velocity.x(), 0.002);
  EXPECT_EQ(scene.outputs.at(1).quantity, Quantity::kForce);
  EXPECT_EQ(scene.outputs[1].point.mat, scene.outputs[0].point.mat);
}

TEST(MdlPointsTest, CoordinatesBeyondTheEndsAreCutWithAWarning) {
  const Scene scene = sceneOf("@s chain 4 1 1 0 [0 0 0] 0\n@out1 posOutput [@s 1.5]\n");
  EXPECT_EQ(scene.connections.at(0).along.at.factor, 1.0);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_THAT(scene.warnings[0], HasSubstr("m.mdl:2:21: warning: coordinate 1.5 is taken as 1"));
}

TEST(MdlPointsTest, FollowAudioParams) {
  const Scene scene = sceneOf(
      "@p audioParam @in1\n@q audioParam @in2\n@s chain 5 1 1 1 [0 0 0] 0\n"
      "@n mesh 4 5 1 1 1 0 0\n@l spring [@s p] [@s p-0.1] 1\n@out1 posOutput [@s p]\n"
      "@out2 posOutput [@n q 0.5*p]\n");
  ASSERT_EQ(scene.connections.size(), 3U);
  EXPECT_EQ(scene.connections[0].along.at.audio, 0);
  EXPECT_EQ(scene.audio_parameters.at(2).at(0.4), 0.4 - 0.1);
  EXPECT_EQ(scene.connections[1].along.at.audio, 2);
  EXPECT_EQ(scene.connections[2].across.at.audio, 1) << "the first counts across the rows";
  EXPECT_EQ(scene.connections[2].along.at.factor, 0.5);
  EXPECT_EQ(scene.mats.at(at(scene.connections[1].mat)).name, "s@p-0.1");
  EXPECT_EQ(scene.outputs.at(0).point.mat, scene.connections[0].mat) << "one place, one point";
}

TEST(MdlPointsTest, FollowAudioParamsInTheOlderLanguage) {
  const Scene scene = sceneOf(
      "@p audioParam @in1\n@g ground 0.\n@s string 5 1 1 1 0.\n@c contact @g @s 1 0 0. p-0.2\n");
  ASSERT_EQ(scene.connections.size(), 1U);
  EXPECT_EQ(scene.audio_parameters.at(1).offset, -0.2);
}

TEST(MdlMacrosTest, ParamsAndAudioParamsStandInThem) {
  const std::string text =
      "@N param 6\n@K param 0.1\n@a audioParam @in2\n"
      "@s stiffString N 1 2*K 0.5*a a a [0 0 0] [1 0 0]\n";
  const Scene scene = sceneOf(text);
  EXPECT_EQ(scene.grids.at(0).columns, 6);
  EXPECT_EQ(scene.lias.at(0).stiffness.factor, 0.2);
  EXPECT_EQ(scene.lias.at(0).damping.audio, 0);
  EXPECT_EQ(scene.lias.at(5).stiffness.audio, 0);
  EXPECT_EQ(scene.lias.at(5).stiffness.factor, 0.5);
  EXPECT_EQ(scene.mats.at(1).damping.audio, 0);
  EXPECT_EQ(readMdl(text, "m.mdl", {{"N", 9.0}}).grids.at(0).columns, 9);
}

TEST(MdlMacrosTest, BombsAreRefusedBeforeTheyTakeRoom) {
  for (const char* text : {"@m mesh 2000000 2000000 1 1 1 0 0\n", "@m mesh 1500 1500 1 1 1 0 0\n",
                           "@s chain 1999999 1 1 1 0 0\n@t chain 2 1 1 1 0 0\n"}) {
    EXPECT_THROW(sceneOf(std::string("@big closedMesh 1999999 3 1 1 1 0 0\n") + text), TextError);
    EXPECT_THROW(sceneOf(text), TextError);
  }
}

TEST(MdlGroupsTest, ThatDoNotBeginOrEndAreWarnedOf) {
  EXPECT_TRUE(sceneOf("~begin a\n~begin b\n@m mass 1 0 0\n~end a\n~end b\n~~~\n").warnings.empty());
  const Scene scene = sceneOf("~begin a\n~begin a\n@m mass 1 0 0\n~end b\n~begin c\n~end a\n");
  ASSERT_EQ(scene.warnings.size(), 3U);
  EXPECT_THAT(scene.warnings[0], HasSubstr("m.mdl:2:1: warning: group 'a' begins twice"));
  EXPECT_THAT(scene.warnings[1], HasSubstr("m.mdl:4:1: warning: group 'b' ends, and did not"));
  EXPECT_THAT(scene.warnings[2], HasSubstr("m.mdl:5:1: warning: group 'c' does not end"));
}

}  // namespace
}  // namespace ergotic::scene
