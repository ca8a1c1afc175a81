// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/urdf.hpp"

#include <urdf_parser/urdf_parser.h>

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "tgr/kinematics_cases.hpp"

namespace ergotic::tgr {
namespace {

std::string fileText(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
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
  const auto file = urdf::parseURDF(fileText(ERGOTIC_SOURCE_DIR "/urdf/tgr.urdf"));
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
      sum += joint->parent_to_joint_origin_transform.position.y;
    }
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
