// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iterator>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kHead =
    "ergotic: 1\n"
    "parameters:\n"
    "  loss: {value: 0.001, range: [0, 0.01]}\n"
    "  size: {value: 2, range: [1, 4]}\n"
    "sections:\n"
    "  fast: {gravity: -9.81}\n"
    "  third: {rate: {divisor: 3}}\n"
    "  hand: {rate: gestural, pose: {position: [1, 2, 3], rotation: [0.1, 0.2, 0.3]}}\n";

const std::string kMats =
    "mats:\n"
    "  m: {type: mass, section: fast, mass: 0.5, at: [0.1, -0.2], x: 0.3, v: -4, rest: 0.25}\n"
    "  n: {type: mass, section: fast, mass: 2e-3*$size, rest: 0.125}\n"
    "  g: {type: ground, section: fast, at: [1, 2], x: 0.75}\n"
    "  c: {type: cell, section: third, mass: $size, stiffness: 3*$size, damping: $loss, x: 1, v: "
    "2}\n"
    "  d: {type: driven, section: fast, x: 0.5, rest: 0.25}\n"
    "  k: {type: slice, section: hand, rest: -0.01}\n";

std::string docsExample() {
  const std::string text = textOf(repository("docs/scene.md"));
  const std::size_t begin = text.find("```yaml\n") + 8;
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(ReadYamlTest, HeadHasItsDefaults) {
  const Scene s = readYaml("ergotic: 1\nsections: {a: {}}\n", "dir/harp.yaml");
  EXPECT_EQ(s.name, "harp");
  EXPECT_EQ(s.file, "dir/harp.yaml");
  EXPECT_EQ(s.text, "ergotic: 1\nsections: {a: {}}\n");
  EXPECT_EQ(s.time_unit_s, 1.0);
  EXPECT_EQ(s.gestural_rate_hz, 3000.0);
  EXPECT_FALSE(s.sections[0].gestural);
  EXPECT_EQ(s.sections[0].divisor, 1);
  EXPECT_TRUE(s.sections[0].pose.matrix().isIdentity(0.0));
  EXPECT_EQ(s.inputChannels(), 0);
  EXPECT_EQ(s.outputChannels(), 0);
}

TEST(ReadYamlTest, ParametersAndSectionsAreReadFieldByField) {
  const Scene s = readYaml(kHead + "name: two words\ngestural_rate: 3150\n", "a.yaml");
  EXPECT_EQ(s.name, "two words");
  EXPECT_EQ(s.gestural_rate_hz, 3150.0);
  ASSERT_EQ(s.parameters.size(), 2U);
  EXPECT_EQ(s.parameters[0].name, "loss");
  EXPECT_EQ(s.parameters[0].value, 0.001);
  EXPECT_EQ(s.parameters[0].minimum, 0.0);
  EXPECT_EQ(s.parameters[0].maximum, 0.01);
  EXPECT_EQ(s.parameters[1].place.line, 4);
  EXPECT_EQ(s.parameters[1].place.column, 3);
  ASSERT_EQ(s.sections.size(), 3U);
  EXPECT_EQ(s.sections[0].gravity.x(), -9.81);
  EXPECT_EQ(s.sections[1].divisor, 3);
  EXPECT_TRUE(s.sections[2].gestural);
  EXPECT_EQ(s.sections[2].name, "hand");
}

TEST(ReadYamlTest, PoseTurnsAboutFixedAxesXThenYThenZ) {
  const Scene s = readYaml(kHead, "a.yaml");
  const auto turn = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  const Eigen::Vector3d point(0.5, -1.0, 2.0);
  const Eigen::Vector3d expected =
      turn(0.3, Eigen::Vector3d::UnitZ()) *
          (turn(0.2, Eigen::Vector3d::UnitY()) * (turn(0.1, Eigen::Vector3d::UnitX()) * point)) +
      Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_TRUE((s.sections[2].pose * point).isApprox(expected, 1e-14));
}

TEST(ReadYamlTest, ModulesAreReadFieldByField) {
  const Scene s = readYaml(kHead + kMats, "a.yaml");
  ASSERT_EQ(s.mats.size(), 6U);
  const Mat& m = s.mats[0];
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.type, MatType::kMass);
  EXPECT_EQ(m.mass.factor, 0.5);
  EXPECT_EQ(m.mass.parameter, -1);
  EXPECT_EQ(m.rest.y(), 0.1);
  EXPECT_EQ(m.rest.z(), -0.2);
  EXPECT_EQ(m.position.x(), 0.3);
  EXPECT_EQ(m.push->velocity.x(), -4.0);
  EXPECT_EQ(m.rest.x(), 0.25);
  EXPECT_EQ(m.place.line, 10);
  EXPECT_EQ(m.place.column, 3);
  EXPECT_EQ(s.mats[1].mass.factor, 2e-3);
  EXPECT_EQ(s.mats[1].mass.parameter, 1);
  EXPECT_EQ(s.valueOf(s.mats[1].mass), 4e-3);
  EXPECT_EQ(s.mats[1].position.x(), 0.125);  // at rest
  EXPECT_EQ(s.mats[2].type, MatType::kGround);
  EXPECT_EQ(s.mats[2].position.x(), 0.75);
  EXPECT_EQ(s.mats[2].rest.x(), 0.75);
  const Mat& c = s.mats[3];
  EXPECT_EQ(c.type, MatType::kCell);
  EXPECT_EQ(c.section, 1);
  EXPECT_EQ(c.stiffness.factor, 3.0);
  EXPECT_EQ(c.stiffness.parameter, 1);
  EXPECT_EQ(c.damping.parameter, 0);
  EXPECT_EQ(c.position.x(), 1.0);
  EXPECT_EQ(c.push->velocity.x(), 2.0);
  EXPECT_EQ(c.rest.x(), 0.0);
  EXPECT_EQ(s.mats[4].type, MatType::kDriven);
  EXPECT_EQ(s.mats[4].position.x(), 0.5);
  EXPECT_EQ(s.mats[5].type, MatType::kSlice);
  EXPECT_EQ(s.mats[5].section, 2);
  EXPECT_EQ(s.mats[5].position.x(), -0.01);
}

TEST(ReadYamlTest, EveryTypeOfLinkIsReadFieldByField) {
  const Scene s = readYaml(
      kHead + kMats +
          "lias:\n"
          "  spring: {type: spring, between: [m, n], stiffness: 1, rest_length: -0.5}\n"
          "  damper: {type: damper, between: [n, m], damping: 2}\n"
          "  both: {type: spring_damper, between: [m, g], stiffness: 3*$size, damping: $loss}\n"
          "  contact: {type: contact, between: [m, n], stiffness: 5, damping: 6, threshold: -7}\n"
          "  square: {type: quadratic, between: [m, n], stiffness: 8, nonlinearity: -9, damping: "
          "1}\n"
          "  cubic: {type: cubic, between: [m, n], stiffness: 8, nonlinearity: 9}\n"
          "  clipped: {type: clipped_cubic, between: [m, n], stiffness: 1, nonlinearity: 2,\n"
          "            stiffness_limit: 3, damping: 4}\n"
          "  bump: {type: cubic_contact, between: [m, n], stiffness: 1, nonlinearity: 2,\n"
          "         stiffness_limit: 3, threshold: 0.5}\n"
          "  pluck: {type: pluck, between: [m, n], stiffness: 3000, width: 0.01, damping: 0.1}\n"
          "  law: {type: pluck, between: [m, n], table: [[-1, 2], [0, 0], [1, -2]]}\n"
          "  bow: {type: bow, between: [m, n], damping: 1, width: $size}\n"
          "  friction: {type: bow, between: [m, n], table: [[-1, -2], [1, 2]]}\n"
          "  smooth: {type: smooth_bow, between: [m, n], damping: 1, width: 0.2}\n",
      "a.yaml");
  const LiaType types[] = {LiaType::kSpringDamper, LiaType::kSpringDamper, LiaType::kSpringDamper,
                           LiaType::kContact,      LiaType::kQuadratic,    LiaType::kCubic,
                           LiaType::kClippedCubic, LiaType::kCubicContact, LiaType::kPluck,
                           LiaType::kPluckTable,   LiaType::kBow,          LiaType::kBowTable,
                           LiaType::kSmoothBow};
  ASSERT_EQ(s.lias.size(), std::size(types));
  for (std::size_t i = 0; i < s.lias.size(); ++i) {
    EXPECT_EQ(s.lias[i].type, types[i]) << s.lias[i].name;
  }
  EXPECT_EQ(s.lias[0].stiffness.factor, 1.0);
  EXPECT_EQ(s.lias[0].rest_length, -0.5);
  EXPECT_EQ(s.lias[0].damping.factor, 0.0);
  EXPECT_EQ(s.lias[1].a, 1);
  EXPECT_EQ(s.lias[1].b, 0);
  EXPECT_EQ(s.lias[1].damping.factor, 2.0);
  EXPECT_EQ(s.lias[2].stiffness.parameter, 1);
  EXPECT_EQ(s.lias[2].damping.parameter, 0);
  EXPECT_EQ(s.lias[3].law->width.factor, -7.0);
  EXPECT_EQ(s.lias[3].damping.factor, 6.0);
  EXPECT_EQ(s.lias[4].law->nonlinearity.factor, -9.0);
  EXPECT_EQ(s.lias[6].law->stiffness_limit.factor, 3.0);
  EXPECT_EQ(s.lias[7].law->width.factor, 0.5);
  EXPECT_EQ(s.lias[8].law->width.factor, 0.01);
  ASSERT_EQ(s.lias[9].law->table.points.size(), 3U);
  EXPECT_EQ(s.lias[9].law->table.points[2], std::make_pair(1.0, -2.0));
  EXPECT_EQ(s.lias[10].law->width.parameter, 1);
  EXPECT_EQ(s.lias[11].law->table.points.size(), 2U);
  EXPECT_EQ(s.lias[12].damping.factor, 1.0);
}

TEST(ReadYamlTest, PortsAndChannelsAreReadFieldByField) {
  const Scene s = readYaml(
      kHead + kMats +
          "ports: {p: {mat: k, slice: 11, offset: -0.02, position_scale: 2, force_scale: 0.5}}\n"
          "inputs:\n"
          "  in: {mat: d, quantity: position, channel: 3, gain: 0.5*$size}\n"
          "  push: {mat: m, quantity: force, channel: 1}\n"
          "outputs:\n"
          "  left: {at: m, quantity: velocity, channel: 1, gain: -10}\n"
          "  right: {at: g, quantity: force, channel: 12}\n"
          "  down: {at: n, quantity: position, channel: 1}\n",
      "a.yaml");
  EXPECT_EQ(s.ports[0].mat, 5);
  EXPECT_EQ(s.ports[0].slice, 11);
  EXPECT_EQ(s.ports[0].offset, -0.02);
  EXPECT_EQ(s.ports[0].position_scale, 2.0);
  EXPECT_EQ(s.ports[0].force_scale, 0.5);
  EXPECT_EQ(s.inputs[0].quantity, Quantity::kPosition);
  EXPECT_EQ(s.inputs[0].channel, 2);
  EXPECT_EQ(s.inputs[0].gain.parameter, 1);
  EXPECT_EQ(s.inputs[1].quantity, Quantity::kForce);
  EXPECT_EQ(s.inputs[1].gain.factor, 1.0);
  EXPECT_EQ(s.outputs[0].quantity, Quantity::kVelocity);
  EXPECT_EQ(s.outputs[0].gain.factor, -10.0);
  EXPECT_EQ(s.outputs[0].point.mat, 0);
  EXPECT_EQ(s.outputs[0].point.next, -1);
  EXPECT_EQ(s.outputs[1].quantity, Quantity::kForce);
  EXPECT_EQ(s.outputs[2].quantity, Quantity::kPosition);
  EXPECT_EQ(s.inputChannels(), 3);
  EXPECT_EQ(s.outputChannels(), 12);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(ReadYamlTest, FractionalPointsLieBetweenFirstAndLastModuleOfTheString) {
  const auto pointAt = [](const std::string& at) {
    return readYaml(
               "ergotic: 1\nsections: {a: {}}\nmats: {g: {type: ground}}\n"
               "generators: [{type: string, name: s, masses: 3, mass: 1, stiffness: 1, to: [1, "
               "0]}]\n"
               "outputs: {o: {at: " +
                   at + ", quantity: position, channel: 1}}\n",
               "a.yaml")
        .outputs[0]
        .point;
  };
  const Point between = pointAt("s@0.3");
  EXPECT_EQ(between.mat, 1 + 1);
  EXPECT_EQ(between.next, 1 + 2);
  EXPECT_NEAR(between.fraction, 0.2, 1e-15);
  EXPECT_EQ(pointAt("s@0").mat, 1);
  EXPECT_EQ(pointAt("s@0").next, -1);
  EXPECT_EQ(pointAt("s@1").mat, 5);
  EXPECT_EQ(pointAt("s@1").next, -1);
  EXPECT_EQ(pointAt("s@0.5").mat, 3);
}

TEST(ReadYamlTest, ExampleOfTheDocumentationReadsWithoutWarning) {
  const Scene s = readYaml(docsExample(), "scene.md");
  EXPECT_EQ(s.name, "played string");
  EXPECT_EQ(s.mats.size(), 1U + 82U + 2U);
  EXPECT_EQ(s.lias.size(), 81U + 2U + 1U);
  EXPECT_EQ(s.ports.size(), 1U);
  EXPECT_EQ(s.outputs.size(), 2U);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(ReadYamlTest, WindowsLineEndsAndByteOrderMarkChangeNothing) {
  const std::string plain = kHead + kMats;
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : plain) {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  }
  const Scene s = readYaml(windows, "a.yaml");
  ASSERT_EQ(s.mats.size(), 6U);
  EXPECT_EQ(s.mats[5].rest.x(), -0.01);
  EXPECT_EQ(s.mats[5].place.line, 15);
  EXPECT_EQ(s.text, windows);
}

TEST(ReadYamlTest, SlicesAndDrivenModulesThatNothingMovesAreWarnedOf) {
  const Scene s = readYaml(kHead + kMats, "a.yaml");
  ASSERT_EQ(s.warnings.size(), 2U);
  EXPECT_THAT(s.warnings[0], HasSubstr("a.yaml:14:3: warning: no input moves module 'd'"));
  EXPECT_THAT(s.warnings[1], HasSubstr("a.yaml:15:3: warning: no port moves slice 'k'"));
}

TEST(ReadYamlTest, SevenThousandExplicitModulesAndLinksAreAllThere) {
  std::string text = "ergotic: 1\nsections: {a: {}}\nmats:\n";
  for (int i = 0; i < 7000; ++i) {
    text += "  m" + std::to_string(i) + ": {type: mass, mass: 0.001, at: [0, 1]}\n";
  }
  text += "lias:\n";
  for (int i = 1; i < 7000; ++i) {
    text += "  l" + std::to_string(i) + ": {type: spring, between: [m" + std::to_string(i - 1) +
            ", m" + std::to_string(i) + "], stiffness: 10}\n";
  }
  const Scene s = readYaml(text, "big.yaml");
  ASSERT_EQ(s.mats.size(), 7000U);
  ASSERT_EQ(s.lias.size(), 6999U);
  EXPECT_EQ(s.lias.back().a, 6998);
  EXPECT_EQ(s.lias.back().b, 6999);
}

TEST(ReadSceneFileTest, EndingOfTheNameSelectsTheReader) {
  EXPECT_EQ(readScene("@m mass 1 0 0\n", "x.mdl").mats.size(), 1U);
  EXPECT_THROW(readScene("@m mass 1 0 0\n", "x.yaml"), TextError);
}

TEST(ReadSceneFileTest, ReadsTheBytesOfTheFile) {
  const std::string path = testing::TempDir() + "ergotic_read_scene_file_test.yaml";
  std::ofstream(path, std::ios::binary) << kHead << kMats;
  const Scene s = readSceneFile(path);
  EXPECT_EQ(s.text, kHead + kMats);
  EXPECT_EQ(s.file, path);
  EXPECT_EQ(s.mats.size(), 6U);
  std::filesystem::remove(path);
}

TEST(ReadSceneFileTest, UnreadableFilesAreNamed) {
  for (const std::string path : {"/nonexistent/scene.yaml", "/"}) {
    EXPECT_THAT(complaintOf([&] { readSceneFile(path); }), HasSubstr(path + ": cannot be read: "));
  }
}

}  // namespace
}  // namespace ergotic::scene
