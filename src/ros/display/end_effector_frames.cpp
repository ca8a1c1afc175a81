// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/end_effector_frames.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "ros/display/markers.hpp"

namespace ergotic::node {
namespace {

using visualization_msgs::Marker;

struct Size {
  double x, y, z;
};
constexpr Size kKeySize{0.10, 0.012, 0.012};
constexpr Size kBowSize{0.60, 0.010, 0.010};
constexpr double kStickWidthM = 0.012;
constexpr double kBallWidthM = 0.04;
constexpr double kContactWidthM = 0.012;

Marker shapeMarker(const std::string& frame, int id, int type, const Size& size) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.frame_locked = 1U;  // between two messages it moves with its frame
  marker.ns = "end_effectors/" + frame;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.lifetime = ::ros::Duration(Markers::kLifetimeS);
  marker.scale.x = size.x;
  marker.scale.y = size.y;
  marker.scale.z = size.z;
  marker.color.r = 0.80F;
  marker.color.g = 0.62F;
  marker.color.b = 0.25F;
  marker.color.a = 1.0F;
  return marker;
}

Marker sphereAt(const std::string& frame, int id, const Eigen::Vector3d& centre, double width) {
  Marker sphere = shapeMarker(frame, id, Marker::SPHERE, {width, width, width});
  sphere.pose.position.x = centre.x();
  sphere.pose.position.y = centre.y();
  sphere.pose.position.z = centre.z();
  return sphere;
}

void addShape(const tgr::EndEffectorConfig& config,
              const std::string& frame,
              std::vector<Marker>& markers) {
  switch (config.type) {
    case tgr::EndEffectorType::kKey:
      markers.push_back(shapeMarker(frame, 0, Marker::CUBE, kKeySize));
      break;
    case tgr::EndEffectorType::kBow:
      markers.push_back(shapeMarker(frame, 0, Marker::CUBE, kBowSize));
      break;
    case tgr::EndEffectorType::kStick:  // from its pivot to its tip
      markers.push_back(
          shapeMarker(frame, 0, Marker::CYLINDER, {kStickWidthM, kStickWidthM, config.length}));
      markers.back().pose.position.z = 0.5 * config.length;
      break;
    case tgr::EndEffectorType::kBall:
      markers.push_back(sphereAt(frame, 0, Eigen::Vector3d::Zero(), kBallWidthM));
      break;
    case tgr::EndEffectorType::kHandle: {
      const double width = 2.0 * config.platform_radius;
      markers.push_back(shapeMarker(frame, 0, Marker::CYLINDER, {width, width, kContactWidthM}));
      for (const Eigen::Vector3d& point : config.points) {
        const int id = static_cast<int>(markers.size());
        markers.push_back(sphereAt(frame, id, point, kContactWidthM));
      }
      break;
    }
  }
}

}  // namespace

EndEffectorFrames::EndEffectorFrames(const tgr::EndEffectors& end_effectors,
                                     const FrameNames& names) {
  for (const tgr::EndEffectorConfig& config : end_effectors.list) {
    Part part{config, tgr::makeKinematics(config, end_effectors.file)};
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = names("tgr_base");
    transform.child_frame_id = names(config.name);
    transform.transform = toTransform(config.pose);
    transforms_.push_back(transform);
    addShape(config, transform.child_frame_id, shapes_.markers);
    parts_.push_back(std::move(part));
  }
}

const std::vector<geometry_msgs::TransformStamped>& EndEffectorFrames::at(
    const station::Snapshot& snapshot, const ::ros::Time& stamp) {
  std::array<double, tgr::Kinematics::kMaxSlicesOfOne> q{};
  constexpr std::size_t kCoordinates = tgr::Kinematics::kMaxCoordinates;
  std::array<double, kCoordinates> x{};
  std::array<double, kCoordinates * tgr::Kinematics::kMaxSlicesOfOne> jacobian{};
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    for (std::size_t k = 0; k < part.config.slices.size(); ++k) {
      q[k] = snapshot.slice_position[static_cast<std::size_t>(part.config.slices[k])];
    }
    if (part.kinematics->forward(q.data(), x.data(), jacobian.data())) {
      transforms_[i].transform = toTransform(part.config.pose * part.kinematics->pose(q.data()));
    }
    transforms_[i].header.stamp = stamp;
  }
  return transforms_;
}

const visualization_msgs::MarkerArray& EndEffectorFrames::shapes(const ::ros::Time& stamp) {
  for (Marker& marker : shapes_.markers) {
    marker.header.stamp = stamp;
  }
  return shapes_;
}

}  // namespace ergotic::node
