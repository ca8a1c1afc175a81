// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/end_effectors/fields.hpp"

#include <cmath>

#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

using Config = EndEffectorConfig;

constexpr scene::Limits kLeverLimits{"m/m", 0.01, 100.0};
constexpr scene::Limits kAngleLimits{"rad", -6.283185307179586, 6.283185307179586};
constexpr scene::Limits kLengthLimits{"m", 0.01, 2.0};
constexpr scene::Limits kRadiusLimits{"m", 0.005, 1.0};

const std::vector<TypeTraits>& allTraits() {
  static const std::vector<Dimension> linkage{
      {"rod", &Config::rod, kLengthLimits},
      {"base_radius", &Config::base_radius, kRadiusLimits},
      {"platform_radius", &Config::platform_radius, kRadiusLimits}};
  static const std::vector<TypeTraits> traits{
      {"key", 1, 1, {{"lever", &Config::lever, kLeverLimits}}, makeKey},
      {"bow",
       2,
       2,
       {{"lever", &Config::lever, kLeverLimits}, {"angle", &Config::angle, kAngleLimits}},
       makeBow},
      {"stick",
       2,
       3,
       {{"arm", &Config::arm, kLengthLimits}, {"length", &Config::length, kLengthLimits}},
       makeStick},
      {"ball", 3, 3, linkage, makeBall},
      {"handle", 6, 6, linkage, makeHandle}};
  return traits;
}

}  // namespace

const TypeTraits& traitsOf(EndEffectorType type) {
  return allTraits().at(static_cast<std::size_t>(type));
}

const std::vector<std::string>& typeNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const TypeTraits& traits : allTraits()) {
      all.emplace_back(traits.name);
    }
    return all;
  }();
  return names;
}

std::size_t coordinatesOf(const EndEffectorConfig& config) {
  return config.type == EndEffectorType::kHandle ? 3 * config.points.size() : config.slices.size();
}

Eigen::Vector3d fixedAxisAngles(const Eigen::Matrix3d& r) {
  const double yaw = std::atan2(r(1, 0), r(0, 0));
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {std::atan2(s * r(0, 2) - c * r(1, 2), c * r(1, 1) - s * r(0, 1)),
          std::atan2(-r(2, 0), c * r(0, 0) + s * r(1, 0)), yaw};
}

std::string sliceCountText(const TypeTraits& traits) {
  const std::string most = std::to_string(traits.most_slices);
  const std::string range = traits.fewest_slices == traits.most_slices
                                ? most
                                : std::to_string(traits.fewest_slices) + " to " + most;
  return range + (traits.most_slices == 1 ? " slice" : " slices");
}

}  // namespace ergotic::tgr
