// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/vbap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace ergotic::scene {
namespace {

constexpr double kRounding = 1e-9;  // of unit vectors

/// Normal of the plane that holds the listener and all speakers; 0 if there is none.
Eigen::Vector3d commonNormal(const std::vector<Eigen::Vector3d>& speakers) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& speaker : speakers) {
    const Eigen::Vector3d other = speakers.front().cross(speaker);
    normal = other.norm() > normal.norm() ? other : normal;
  }
  if (normal.norm() < kRounding) {
    return Eigen::Vector3d::Zero();
  }
  normal.normalize();
  const bool are_in_it = std::all_of(
      speakers.begin(), speakers.end(),
      [&](const Eigen::Vector3d& speaker) { return std::abs(speaker.dot(normal)) < kRounding; });
  return are_in_it ? normal : Eigen::Vector3d::Zero();
}

/// Pairs of speakers next to one another around the listener, less than half a turn apart.
std::vector<std::vector<std::size_t>> pairsOf(const std::vector<Eigen::Vector3d>& speakers,
                                              const Eigen::Vector3d& normal) {
  const Eigen::Vector3d& ahead = speakers.front();
  const Eigen::Vector3d aside = normal.cross(ahead);
  std::vector<std::pair<double, std::size_t>> around;
  for (std::size_t i = 0; i < speakers.size(); ++i) {
    around.emplace_back(std::atan2(speakers[i].dot(aside), speakers[i].dot(ahead)), i);
  }
  std::sort(around.begin(), around.end());
  std::vector<std::vector<std::size_t>> pairs;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::size_t one = around[i].second;
    const std::size_t next = around[(i + 1) % around.size()].second;
    if (speakers[one].cross(speakers[next]).dot(normal) > kRounding) {
      pairs.push_back({one, next});
    }
  }
  return pairs;
}

}  // namespace

Panner::Panner(std::vector<Eigen::Vector3d> speakers)
    : speakers_(std::move(speakers)), normal_(commonNormal(speakers_)) {
  if (normal_ != Eigen::Vector3d::Zero()) {
    bases_ = pairsOf(speakers_, normal_);
    return;
  }
  for (std::size_t a = 0; a < speakers_.size(); ++a) {
    for (std::size_t b = a + 1; b < speakers_.size(); ++b) {
      for (std::size_t c = b + 1; c < speakers_.size(); ++c) {
        if (isFace(a, b, c)) {
          bases_.push_back({a, b, c});
        }
      }
    }
  }
}

/// True for a face of the convex hull: no speaker lies beyond the plane of these three, nor the
/// listener in it.
bool Panner::isFace(std::size_t a, std::size_t b, std::size_t c) const {
  Eigen::Matrix3d base;
  base << speakers_[a], speakers_[b], speakers_[c];
  if (std::abs(base.determinant()) < kRounding) {
    return false;
  }
  Eigen::Vector3d normal =
      (speakers_[b] - speakers_[a]).cross(speakers_[c] - speakers_[a]).normalized();
  normal *= normal.dot(speakers_[a]) < 0.0 ? -1.0 : 1.0;
  const double height = normal.dot(speakers_[a]);
  return std::none_of(speakers_.begin(), speakers_.end(), [&](const Eigen::Vector3d& other) {
    return normal.dot(other) > height + kRounding;
  });
}

std::optional<std::vector<double>> Panner::gains(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d wanted = direction.normalized();
  if (normal_ != Eigen::Vector3d::Zero() && std::abs(wanted.dot(normal_)) > kRounding) {
    return std::nullopt;
  }
  for (const std::vector<std::size_t>& base : bases_) {
    Eigen::Matrix3d vectors;
    for (std::size_t i = 0; i < 3; ++i) {
      vectors.col(static_cast<Eigen::Index>(i)) = i < base.size() ? speakers_[base[i]] : normal_;
    }
    Eigen::Vector3d parts = vectors.partialPivLu().solve(wanted);
    if (parts.minCoeff() < -kRounding) {
      continue;
    }
    std::vector<double> gains(speakers_.size(), 0.0);
    double power = 0.0;
    for (std::size_t i = 0; i < base.size(); ++i) {
      const double gain = parts[static_cast<Eigen::Index>(i)];
      gains[base[i]] = gain < kRounding ? 0.0 : gain;  // a speaker in that direction is alone
      power += gains[base[i]] * gains[base[i]];
    }
    for (double& gain : gains) {
      gain /= std::sqrt(power);
    }
    return gains;
  }
  return std::nullopt;
}

Eigen::Vector3d directionOf(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace ergotic::scene
