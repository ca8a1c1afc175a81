// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/urdf.hpp"

#include <algorithm>
#include <array>

#include "constants.hpp"
#include "scene/text/number.hpp"
#include "tgr/end_effectors/fields.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using Eigen::Vector3d;
constexpr double kPitch = 0.01375;  // m between slices: twelve of them make an octave of 165 mm
constexpr int kOctave = 12;
constexpr double kWhitePitch = kOctave * kPitch / 7.0;
constexpr std::array<int, kOctave> kWhiteKey{0, -1, 1, -1, 2, 3, -1, 4, -1, 5, -1, 6};  // -1: black

const char* const kHead = R"(<?xml version="1.0"?>
<robot name="tgr">
  <material name="case"><color rgba="0.16 0.17 0.20 1"/></material>
  <material name="steel"><color rgba="0.62 0.64 0.68 1"/></material>
  <material name="brass"><color rgba="0.80 0.62 0.25 1"/></material>
  <material name="ivory"><color rgba="0.95 0.94 0.88 1"/></material>
  <material name="ebony"><color rgba="0.05 0.05 0.06 1"/></material>
  <material name="wood"><color rgba="0.45 0.27 0.13 1"/></material>
)";

/// Link `model`; its pose is that of `modelPose`.
const char* const kModel = R"(  <link name="model"/>
  <joint name="model_mount" type="fixed">
    <parent link="tgr_base"/>
    <child link="model"/>
    <origin xyz="0.16 0.325 0.17" rpy="3.14159265358979 -1.5707963267949 0"/>
  </joint>
)";

std::string numbers(const Vector3d& v) {
  return scene::shortest(v.x()) + " " + scene::shortest(v.y()) + " " + scene::shortest(v.z());
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string visual(const std::string& geometry,
                   const Vector3d& at,
                   const char* material,
                   const Vector3d& angles = Vector3d::Zero()) {
  const std::string turned = angles.isZero() ? "" : "\" rpy=\"" + numbers(angles);
  return "    <visual>\n      <origin xyz=\"" + numbers(at) + turned + "\"/>\n      <geometry>" +
         geometry + "</geometry>\n      <material name=\"" + material + "\"/>\n    </visual>\n";
}

std::string box(const Vector3d& size) {
  return "<box size=\"" + numbers(size) + "\"/>";
}
/// Along z, about its middle.
std::string cylinder(double radius, double length) {
  return "<cylinder radius=\"" + scene::shortest(radius) + "\" length=\"" +
         scene::shortest(length) + "\"/>";
}
std::string sphere(double radius) {
  return "<sphere radius=\"" + scene::shortest(radius) + "\"/>";
}

std::string base(int slices) {
  const double width = kPitch * slices + 0.04;
  const double side = 0.5 * kPitch * slices + 0.0125;
  return "  <link name=\"tgr_base\">\n" +
         visual(box({0.24, width, 0.115}), {0.03, 0.0, -0.0575}, "case") +
         visual(box({0.30, 0.015, 0.025}), {0.0, side, 0.005}, "brass") +
         visual(box({0.30, 0.015, 0.025}), {0.0, -side, 0.005}, "brass") + "  </link>\n";
}

/// Offset of a slice from the middle of an octave to the left, in its plane, m.
double sliceOffset(int of_octave) {
  return kPitch * (0.5 * (kOctave - 1) - of_octave);
}

std::string pianoKey(int slice) {
  const int of_octave = slice % kOctave;
  const int white = kWhiteKey[static_cast<std::size_t>(of_octave)];
  if (white < 0) {
    return visual(box({0.095, 0.0115, 0.014}), {-0.045, 0.0, 0.05}, "ebony");
  }
  const double aside = kWhitePitch * (3 - white) - sliceOffset(of_octave);
  return visual(box({0.15, kWhitePitch - 0.001, 0.02}), {-0.075, aside, 0.034}, "ivory");
}

std::string slice(int index, int slices, bool is_free) {
  const std::string number = std::to_string(index);
  return "  <link name=\"tgr_slice_" + number + "\">\n" + (is_free ? pianoKey(index) : "") +
         visual(box({0.14, 0.009, 0.03}), {0.07, 0.0, 0.02}, "steel") +
         "    <inertial>\n      <mass value=\"0.3\"/>\n      <inertia ixx=\"1e-4\" ixy=\"0\" "
         "ixz=\"0\" iyy=\"1e-4\" iyz=\"0\" izz=\"1e-4\"/>\n    </inertial>\n  </link>\n"
         "  <joint name=\"slice_" +
         number + "\" type=\"prismatic\">\n    <parent link=\"tgr_base\"/>\n    <child link=\"" +
         "tgr_slice_" + number + "\"/>\n    <origin xyz=\"" + numbers(slicePlace(index, slices)) +
         "\"/>\n    <axis xyz=\"0 0 1\"/>\n    <limit lower=\"-0.03\" upper=\"0.03\" "
         "effort=\"200\" velocity=\"2\"/>\n  </joint>\n";
}

std::string handle(const EndEffectorConfig& config) {
  constexpr double kGrip = 0.1;
  std::string shape = visual(cylinder(config.platform_radius, 0.006), Vector3d::Zero(), "steel") +
                      visual(cylinder(0.014, kGrip), {0.0, 0.0, 0.5 * kGrip}, "wood");
  for (const Vector3d& point : config.points) {
    shape += visual(sphere(0.006), point, "brass");
  }
  return shape;
}

/// Shape of an end-effector, in its own frame at rest.
std::string shapeOf(const EndEffectorConfig& config) {
  switch (config.type) {
    case EndEffectorType::kKey:
      return visual(box({0.15, kWhitePitch - 0.001, 0.02}), {-0.075, 0.0, 0.0}, "ivory");
    case EndEffectorType::kBow:
      return visual(box({0.65, 0.01, 0.001}), Vector3d::Zero(), "ivory") +
             visual(cylinder(0.004, 0.7), {0.0, 0.0, 0.018}, "wood", {0.0, 0.5 * kPi, 0.0}) +
             visual(box({0.05, 0.012, 0.02}), {-0.325, 0.0, 0.009}, "ebony");
    case EndEffectorType::kStick:
      return visual(cylinder(0.007, config.length), {0.0, 0.0, 0.5 * config.length}, "steel") +
             visual(sphere(0.018), {0.0, 0.0, config.length}, "ebony");
    case EndEffectorType::kBall:
      return visual(cylinder(config.platform_radius, 0.006), Vector3d::Zero(), "steel") +
             visual(sphere(0.025), {0.0, 0.0, 0.028}, "brass");
    case EndEffectorType::kHandle:
      return handle(config);
  }
  return "";
}

std::string endEffector(const EndEffectorConfig& config) {
  const std::string name = escaped(config.name);
  return "  <link name=\"" + name + "\">\n" + shapeOf(config) + "  </link>\n  <joint name=\"" +
         name + "_mount\" type=\"floating\">\n    <parent link=\"tgr_base\"/>\n    <child link=\"" +
         name + "\"/>\n    <origin xyz=\"" + numbers(config.pose.translation()) + "\" rpy=\"" +
         numbers(fixedAxisAngles(config.pose.linear())) + "\"/>\n  </joint>\n";
}

}  // namespace

std::string urdfOf(const EndEffectors& end_effectors, int slices) {
  std::string text = kHead + base(slices) + kModel;
  for (int i = 0; i < slices; ++i) {
    const bool is_free = std::none_of(
        end_effectors.list.begin(), end_effectors.list.end(), [i](const EndEffectorConfig& config) {
          return std::find(config.slices.begin(), config.slices.end(), i) != config.slices.end();
        });
    text += slice(i, slices, is_free);
  }
  for (const EndEffectorConfig& config : end_effectors.list) {
    text += endEffector(config);
  }
  return text + "</robot>\n";
}

Vector3d slicePlace(int index, int slices) {
  return {0.0, kPitch * (0.5 * (slices - 1) - index), 0.01};
}

/// Pose of the instrument behind the keyboard; its x (along which strings vibrate) is up, its y
/// runs along the keyboard.
Eigen::Isometry3d modelPose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0.0, 0.0, 1.0,  //
      0.0, -1.0, 0.0,              //
      1.0, 0.0, 0.0;
  pose.translation() = Vector3d(0.16, 0.325, 0.17);
  return pose;
}

}  // namespace ergotic::tgr
