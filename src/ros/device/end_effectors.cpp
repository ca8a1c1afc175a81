// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/end_effectors.hpp"

#include <string>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/rig.hpp"

namespace ergotic::node {
namespace {

using tgr::EndEffectorConfig;
using tgr::EndEffectorType;

template <class T>
constexpr std::uint8_t number(T value) {
  return static_cast<std::uint8_t>(value);
}
static_assert(EndEffector::KEY == number(EndEffectorType::kKey));
static_assert(EndEffector::BOW == number(EndEffectorType::kBow));
static_assert(EndEffector::STICK == number(EndEffectorType::kStick));
static_assert(EndEffector::BALL == number(EndEffectorType::kBall));
static_assert(EndEffector::HANDLE == number(EndEffectorType::kHandle));

const char kFile[] = "end_effectors";

double orUsual(double value, double usual) {
  return value == 0.0 ? usual : value;
}

[[noreturn]] void refuse(std::size_t index, const EndEffector& message, const std::string& what) {
  throw TextError(kFile, static_cast<int>(index) + 1, 1,
                  "end-effector '" + message.name + "': " + what);
}

Eigen::Isometry3d poseOf(std::size_t index, const EndEffector& message) {
  const geometry_msgs::Quaternion& orientation = message.pose.orientation;
  Eigen::Quaterniond turn(orientation.w, orientation.x, orientation.y, orientation.z);
  if (turn.coeffs().isZero(0.0)) {
    turn.setIdentity();
  }
  constexpr double kFarthest = 1e6;  // from 1: beyond, a norm cannot be worked out
  const double norm = turn.norm();
  if (!(norm >= 1.0 / kFarthest && norm <= kFarthest)) {
    refuse(index, message,
           "the norm of its orientation is " + std::to_string(norm) +
               ", allowed: 0 (no rotation), 1 or about that");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  const geometry_msgs::Point& position = message.pose.position;
  pose.translation() = Eigen::Vector3d(position.x, position.y, position.z);
  return pose;
}

EndEffectorConfig fromMessage(std::size_t index, const EndEffector& message) {
  if (message.type > EndEffector::HANDLE) {
    refuse(index, message,
           "type is " + std::to_string(message.type) + ", allowed: 0..." +
               std::to_string(EndEffector::HANDLE));
  }
  EndEffectorConfig config;
  config.name = message.name;
  config.type = static_cast<EndEffectorType>(message.type);
  for (const std::uint32_t slice : message.slices) {
    if (slice >= std::uint32_t{tgr::kMaxSlices}) {
      refuse(index, message,
             "slice is " + std::to_string(slice) + ", allowed: 0..." +
                 std::to_string(tgr::kMaxSlices - 1));
    }
    config.slices.push_back(static_cast<int>(slice));
  }
  config.ports = message.ports;
  config.position_scale = orUsual(message.position_scale, config.position_scale);
  config.force_scale = orUsual(message.force_scale, config.force_scale);
  config.lever = orUsual(message.lever, config.lever);
  config.angle = message.angle;
  config.arm = orUsual(message.arm, config.arm);
  config.length = orUsual(message.length, config.length);
  config.rod = orUsual(message.rod, config.rod);
  config.base_radius = orUsual(message.base_radius, config.base_radius);
  config.platform_radius = orUsual(message.platform_radius, config.platform_radius);
  for (const geometry_msgs::Point& point : message.points) {
    config.points.emplace_back(point.x, point.y, point.z);
  }
  config.pose = poseOf(index, message);
  return config;
}

/// Checks the sizes before anything is read: no device has so many slices.
void checkSizes(const std::vector<EndEffector>& messages) {
  const auto check = [](const std::string& what, std::size_t count, std::size_t most) {
    if (count > most) {
      throw TextError(
          kFile, 1, 1,
          std::to_string(count) + " " + what + ", allowed: 0..." + std::to_string(most));
    }
  };
  constexpr std::size_t kLongestName = 256;
  check("end-effectors", messages.size(), std::size_t{tgr::kMaxSlices});
  for (const EndEffector& message : messages) {
    check("slices", message.slices.size(), std::size_t{tgr::kMaxSlices});
    check("ports", message.ports.size(), std::size_t{tgr::kMaxPorts});
    check("points", message.points.size(), std::size_t{tgr::kMaxPorts});
    check("letters of a name", message.name.size(), kLongestName);
    for (const std::string& port : message.ports) {
      check("letters of a port", port.size(), kLongestName);
    }
  }
}

}  // namespace

geometry_msgs::Pose toPose(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d position = pose.translation();
  const Eigen::Quaterniond orientation(pose.linear());
  geometry_msgs::Pose message;
  message.position.x = position.x();
  message.position.y = position.y();
  message.position.z = position.z();
  message.orientation.x = orientation.x();
  message.orientation.y = orientation.y();
  message.orientation.z = orientation.z();
  message.orientation.w = orientation.w();
  return message;
}

EndEffector toMessage(const EndEffectorConfig& config) {
  EndEffector message;
  message.name = config.name;
  message.type = number(config.type);
  for (const int slice : config.slices) {
    message.slices.push_back(static_cast<std::uint32_t>(slice));
  }
  message.ports = config.ports;
  message.position_scale = config.position_scale;
  message.force_scale = config.force_scale;
  message.lever = config.lever;
  message.angle = config.angle;
  message.arm = config.arm;
  message.length = config.length;
  message.rod = config.rod;
  message.base_radius = config.base_radius;
  message.platform_radius = config.platform_radius;
  for (const Eigen::Vector3d& point : config.points) {
    message.points.emplace_back();
    message.points.back().x = point.x();
    message.points.back().y = point.y();
    message.points.back().z = point.z();
  }
  message.pose = toPose(config.pose);
  return message;
}

std::vector<EndEffector> toMessages(const tgr::EndEffectors& end_effectors) {
  std::vector<EndEffector> messages;
  for (const EndEffectorConfig& config : end_effectors.list) {
    messages.push_back(toMessage(config));
  }
  return messages;
}

tgr::EndEffectors fromMessages(const std::vector<EndEffector>& messages) {
  checkSizes(messages);
  tgr::EndEffectors end_effectors;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    end_effectors.list.push_back(fromMessage(i, messages[i]));
  }
  // What YAML may not say, a message may not either: one reader checks both.
  return tgr::readEndEffectors(tgr::toYaml(end_effectors), kFile);
}

}  // namespace ergotic::node
