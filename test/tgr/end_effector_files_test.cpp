// SPDX-License-Identifier: BSD-3-Clause
#include <urdf_parser/urdf_parser.h>

#include <iterator>

#include "ergotic/tgr/urdf.hpp"
#include "support/places.hpp"
#include "support/test.hpp"
#include "tgr/kinematics_cases.hpp"

namespace ergotic::tgr {
namespace {

const char* const kAll = R"(
devices: [{driver: virtual}]
end_effectors:
  violin:
    type: bow
    slices: [4, 3]
    ports: [across, pressure]
    position_scale: 0.5
    force_scale: 0.25
    lever: 2
    angle: 0.1
    pose: {position: [0.1, 0.2, 0.3], rotation: [0, 0, 1.5707963267948966]}
  c4: {type: key, slices: 0, ports: c4}
  lever: {type: stick, slices: [1, 2], ports: ["", y], arm: 0.05, length: 0.4}
  puck: {type: ball, slices: [5, 6, 7], ports: [a, b, c], rod: 0.2, base_radius: 0.12}
  grip:
    type: handle
    slices: [8, 9, 10, 11, 12, 13]
    ports: [p0, p1, p2, p3, p4, p5, p6, p7, p8]
    points: [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]
    platform_radius: 0.06
)";

std::string messageOf(const std::string& text) {
  return complaintOf<TextError>([&] { readEndEffectors(text, "hands.yaml"); });
}

/// Of one end-effector in line 2, `a`.
std::string refused(const std::string& rest) {
  return messageOf("end_effectors:\n  a: {" + rest + "}");
}

TEST(EndEffectorYamlTest, ReadsEveryType) {
  const EndEffectors read = readEndEffectors(kAll, "hands.yaml");
  EXPECT_EQ(read.file, "hands.yaml");
  ASSERT_EQ(read.list.size(), 5U);
  const EndEffectorConfig& bow = read.list[0];
  EXPECT_EQ(bow.name, "violin");
  EXPECT_EQ(bow.type, EndEffectorType::kBow);
  EXPECT_THAT(bow.slices, ElementsAre(4, 3));
  EXPECT_THAT(bow.ports, ElementsAre("across", "pressure"));
  EXPECT_EQ(bow.position_scale, 0.5);
  EXPECT_EQ(bow.force_scale, 0.25);
  EXPECT_EQ(bow.lever, 2.0);
  EXPECT_EQ(bow.angle, 0.1);
  EXPECT_EQ(bow.pose.translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_NEAR(bow.pose.linear()(1, 0), 1.0, 1e-15);
  EXPECT_EQ(bow.place.line, 4);
  EXPECT_EQ(bow.place.column, 3);
  EXPECT_THAT(read.list[1].slices, ElementsAre(0));
  EXPECT_THAT(read.list[1].ports, ElementsAre("c4"));
  EXPECT_EQ(read.list[1].lever, 1.0);
  EXPECT_THAT(read.list[2].ports, ElementsAre("", "y"));
  EXPECT_EQ(read.list[3].base_radius, 0.12);
  EXPECT_EQ(read.list[4].points.at(2), Eigen::Vector3d(0, 0, 0.1));
}

TEST(EndEffectorYamlTest, TakesATextWithoutAnyForNone) {
  for (const char* text : {"", "devices: []\n", "end_effectors:\n", "end_effectors: {}\n"}) {
    EXPECT_TRUE(readEndEffectors(text, "hands.yaml").list.empty()) << text;
  }
}

TEST(EndEffectorYamlTest, ReadsBackWhatItWrites) {
  EndEffectors written = readEndEffectors(kAll, "hands.yaml");
  for (const test::KinematicsCase& c : test::kinematicsCases()) {
    EndEffectorConfig config = c.config;
    config.name = c.name;
    config.lever = 0.1 + 0.2;  // not a number of few digits
    config.ports.assign(config.points.empty() ? config.slices.size() : 12, "a \"b\\");
    config.pose.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
    written.list.push_back(config);
  }
  const EndEffectors read = readEndEffectors(toYaml(written), "again.yaml");
  ASSERT_EQ(read.list.size(), written.list.size());
  for (std::size_t i = 0; i < read.list.size(); ++i) {
    const EndEffectorConfig& a = written.list[i];
    const EndEffectorConfig& b = read.list[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.slices, b.slices);
    EXPECT_EQ(a.ports, b.ports);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.position_scale, b.position_scale);
    EXPECT_EQ(a.force_scale, b.force_scale);
    EXPECT_EQ(a.pose.translation(), b.pose.translation());
    EXPECT_LT((a.pose.linear() - b.pose.linear()).norm(), 1e-15) << a.name;
  }
  EXPECT_EQ(read.list[5].lever, 0.1 + 0.2);
  EXPECT_TRUE(readEndEffectors(toYaml(EndEffectors{}), "").list.empty());
}

TEST(EndEffectorYamlTest, SaysWhereAndWhatIsWrong) {
  EXPECT_EQ(messageOf("end_effector: {}"),
            "hands.yaml:1:1: error: unknown key 'end_effector' of the file of devices and "
            "end-effectors; did you mean 'end_effectors'?");
  EXPECT_THAT(messageOf("end_effectors: [1]"), StartsWith("hands.yaml:1:16: error: "));
  EXPECT_THAT(messageOf("end_effectors: {a b: {}}"), HasSubstr("1:17: error: name 'a b'"));
  EXPECT_THAT(messageOf("end_effectors: {a: {}, a: {}}"), HasSubstr("missing key 'type'"));
  EXPECT_THAT(refused("type: keys"), HasSubstr("2:13: error: unknown type 'keys'"));
  EXPECT_THAT(refused("type: key, slices: 0, ports: x, angle: 1"),
              HasSubstr("hands.yaml:2:39: error: unknown key 'angle' of end-effector 'a'"));
  EXPECT_THAT(refused("type: key, slices: 64, ports: x"),
              HasSubstr("2:26: error: 'slices' of end-effector 'a' = 64 is out of range, allowed: "
                        "0...63"));
  EXPECT_THAT(refused("type: key, slices: 0.5, ports: x"),
              HasSubstr("2:26: error: 'slices' of end-effector 'a' = 0.5 is not a whole number, "
                        "allowed: 0...63"));
  EXPECT_THAT(refused("type: bow, slices: [0, 1.5], ports: [x, y]"),
              HasSubstr("2:30: error: 'slices' of end-effector 'a' = 1.5 is not a whole number"));
  EXPECT_THAT(refused("type: bow, slices: [0], ports: [x, y]"),
              HasSubstr("a list of 1, allowed: a list of 2 numbers"));
  EXPECT_THAT(refused("type: bow, slices: [0, 1], ports: [x]"),
              HasSubstr("2:41: error: 'ports' of end-effector 'a' is a list of 1, allowed: a list "
                        "of 2, one for each coordinate"));
  EXPECT_THAT(refused("type: key, slices: 0, ports: x, lever: 0"),
              HasSubstr("2:46: error: 'lever' of end-effector 'a' = 0 m/m is out of range, "
                        "allowed: 0.01...100 m/m"));
  EXPECT_THAT(refused("type: key, slices: 0, ports: x, force_scale: .nan"),
              HasSubstr("'force_scale' of end-effector 'a' = '.nan' is not a finite number"));
}

TEST(EndEffectorYamlTest, RefusesPointsThatAreNone) {
  const std::string handle = "type: handle, slices: [0, 1, 2, 3, 4, 5], ports: [], points: ";
  EXPECT_THAT(refused(handle + "[[0, 0, 0]]"),
              HasSubstr("2:68: error: 'points' of end-effector 'a' is a list of 1, "
                        "allowed: a list of 3 to 8 points"));
  EXPECT_THAT(refused(handle + "[[0, 0, 0], [1, 0, 0], [0, 1]]"),
              HasSubstr("2:91: error: a point of end-effector 'a' is a list of 2, allowed: "
                        "[x, y, z]"));
  EXPECT_THAT(refused(handle + "[[0, 0, 0], [1, 0, 0], [0, 1, 1.5]]"),
              HasSubstr("a point of end-effector 'a' = 1.5 m is out of range, allowed: -1...1 m"));
}

Eigen::Vector3d vectorOf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Eigen::Isometry3d poseOf(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return Eigen::Translation3d(vectorOf(pose.position)) * Eigen::Quaterniond(r.w, r.x, r.y, r.z);
}

void expectSamePose(const urdf::Pose& a, const urdf::Pose& b, const std::string& of) {
  EXPECT_TRUE(poseOf(a).isApprox(poseOf(b), 1e-9)) << of;
}

void expectSamePicture(const urdf::Link& a, const urdf::Link& b) {
  ASSERT_EQ(a.visual_array.size(), b.visual_array.size()) << a.name;
  for (std::size_t i = 0; i < a.visual_array.size(); ++i) {
    const urdf::Visual& one = *a.visual_array[i];
    const urdf::Visual& other = *b.visual_array[i];
    EXPECT_EQ(one.material_name, other.material_name) << a.name;
    // The file gives tenths of a millimetre.
    EXPECT_LT((vectorOf(one.origin.position) - vectorOf(other.origin.position)).norm(), 1e-5);
    const auto box = std::dynamic_pointer_cast<urdf::Box>(one.geometry);
    const auto other_box = std::dynamic_pointer_cast<urdf::Box>(other.geometry);
    ASSERT_TRUE(box != nullptr && other_box != nullptr) << a.name;
    EXPECT_LT((vectorOf(box->dim) - vectorOf(other_box->dim)).norm(), 1e-4) << a.name;
  }
}

TEST(UrdfTest, DrawsADeviceOfTwelveSlicesAsTheFileOfTheStationDoes) {
  const auto file = urdf::parseURDF(textOf(repository("urdf/tgr.urdf")));
  const auto made = urdf::parseURDF(urdfOf({}, 12));
  ASSERT_TRUE(file != nullptr && made != nullptr);
  ASSERT_EQ(file->links_.size(), made->links_.size());
  for (const auto& [name, link] : file->links_) {
    ASSERT_NE(made->getLink(name), nullptr) << name;
    expectSamePicture(*link, *made->getLink(name));
  }
  ASSERT_EQ(file->joints_.size(), made->joints_.size());
  for (const auto& [name, joint] : file->joints_) {
    const auto other = made->getJoint(name);
    ASSERT_NE(other, nullptr) << name;
    EXPECT_EQ(joint->type, other->type) << name;
    expectSamePose(joint->parent_to_joint_origin_transform, other->parent_to_joint_origin_transform,
                   name);
  }
}

TEST(UrdfTest, HasAFloatingLinkForEachEndEffectorWhereItRests) {
  EndEffectors hands;
  int slice = 0;
  for (const test::KinematicsCase& c : test::kinematicsCases()) {
    EndEffectorConfig config = c.config;
    config.name = c.name;
    for (int& s : config.slices) {
      s = slice++;
    }
    config.pose = Eigen::Translation3d(0.1, 0.02 * slice, 0.3) *
                  Eigen::AngleAxisd(0.1 * slice, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
    hands.list.push_back(config);
  }
  const auto model = urdf::parseURDF(urdfOf(hands, slice + 1));
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->getRoot()->name, "tgr_base");
  for (const EndEffectorConfig& config : hands.list) {
    const auto link = model->getLink(config.name);
    ASSERT_NE(link, nullptr) << config.name;
    EXPECT_FALSE(link->visual_array.empty()) << config.name;
    const auto joint = model->getJoint(config.name + "_mount");
    ASSERT_NE(joint, nullptr) << config.name;
    EXPECT_EQ(joint->type, urdf::Joint::FLOATING);
    EXPECT_EQ(joint->parent_link_name, "tgr_base");
    EXPECT_TRUE(poseOf(joint->parent_to_joint_origin_transform).isApprox(config.pose, 1e-12))
        << config.name;
  }
}

TEST(UrdfTest, TakesThePianoKeysOffTheSlicesOfEndEffectors) {
  EndEffectors hands;
  hands.list.push_back(test::endEffector(EndEffectorType::kBow, {1, 2}, {"", ""}));
  const auto model = urdf::parseURDF(urdfOf(hands, 4));
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->getLink("tgr_slice_0")->visual_array.size(), 2U);
  EXPECT_EQ(model->getLink("tgr_slice_1")->visual_array.size(), 1U);
  EXPECT_EQ(model->getLink("tgr_slice_2")->visual_array.size(), 1U);
  EXPECT_EQ(model->getLink("tgr_slice_3")->visual_array.size(), 2U);
}

TEST(UrdfTest, DrawsAnyNumberOfSlicesSideBySide) {
  for (const int slices : {1, 24, 64}) {
    const auto model = urdf::parseURDF(urdfOf({}, slices));
    ASSERT_NE(model, nullptr) << slices;
    double sum = 0.0;
    for (int i = 0; i < slices; ++i) {
      const auto joint = model->getJoint("slice_" + std::to_string(i));
      ASSERT_NE(joint, nullptr);
      const urdf::Pose& pose = joint->parent_to_joint_origin_transform;
      EXPECT_TRUE(poseOf(pose).translation().isApprox(slicePlace(i, slices), 1e-12)) << i;
      sum += pose.position.y;
    }
    const auto mount = model->getJoint("model_mount");
    EXPECT_TRUE(poseOf(mount->parent_to_joint_origin_transform).isApprox(modelPose(), 1e-9));
    EXPECT_NEAR(sum, 0.0, 1e-12) << slices;
  }
}

TEST(UrdfTest, EscapesNames) {
  EndEffectors hands;
  hands.list.push_back(test::endEffector(EndEffectorType::kKey, {0}, {""}));
  hands.list.back().name = "a<b&\"c\"";
  const auto model = urdf::parseURDF(urdfOf(hands, 1));
  ASSERT_NE(model, nullptr);
  EXPECT_NE(model->getLink(hands.list.back().name), nullptr);
}

}  // namespace
}  // namespace ergotic::tgr
