// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace ergotic::scene {

/// Vector base amplitude panning (Pulkki, J. Audio Eng. Soc. 45(6), 1997): a direction is heard
/// from the two speakers beside it, where all are in one plane with the listener, or from the three
/// around it.
class Panner {
 public:
  /// \param speakers  unit vectors from the listener, two at least, no two the same
  explicit Panner(std::vector<Eigen::Vector3d> speakers);

  /// A gain >= 0 for each speaker; their squares add up to 1, and the sum of gain times speaker
  /// points to `direction`. Nothing: it is not between speakers.
  /// \param direction  not 0
  std::optional<std::vector<double>> gains(const Eigen::Vector3d& direction) const;

 private:
  bool isFace(std::size_t a, std::size_t b, std::size_t c) const;

  std::vector<Eigen::Vector3d> speakers_;
  std::vector<std::vector<std::size_t>> bases_;       ///< pairs or triplets of speakers
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  ///< of the plane they are all in; 0: of none
};

/// \param azimuth    rad, to the left from the front
/// \param elevation  rad, up
Eigen::Vector3d directionOf(double azimuth, double elevation);

}  // namespace ergotic::scene
