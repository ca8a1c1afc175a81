// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/framing.hpp"

#include <algorithm>
#include <cmath>

namespace ergotic::panel {
namespace {

constexpr double kMargin = 1.15;  // of the picture over what is in it
constexpr double kNearest = 0.1;  // m

}  // namespace

Look lookOf(const Shot& shot, Look look) {
  constexpr double kMaxPitch = 1.55;  // rad: one that looks straight down would have no yaw
  const Eigen::Vector3d out = shot.from - shot.at;
  const double level = std::hypot(out.x(), out.y());
  look.yaw = level > 0.0 ? std::atan2(out.y(), out.x()) : look.yaw;
  look.pitch = std::clamp(std::atan2(out.z(), level), -kMaxPitch, kMaxPitch);
  return look;
}

Framing frame(const std::vector<Eigen::Vector3d>& points, const Look& look) {
  const Eigen::Vector3d out(std::cos(look.yaw) * std::cos(look.pitch),
                            std::sin(look.yaw) * std::cos(look.pitch), std::sin(look.pitch));
  const Eigen::Vector3d right(-std::sin(look.yaw), std::cos(look.yaw), 0.0);
  const Eigen::Vector3d up = out.cross(right);
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double height = std::tan(0.5 * look.field_of_view) / kMargin;
  const double width = look.aspect * height;
  Framing framing;
  framing.focus = 0.5 * (low + high);
  framing.distance = kNearest;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d at = point - framing.focus;
    const double needed = std::max(std::abs(at.dot(right)) / width, std::abs(at.dot(up)) / height);
    framing.distance = std::max(framing.distance, at.dot(out) + needed);
  }
  return framing;
}

}  // namespace ergotic::panel
