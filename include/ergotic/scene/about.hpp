// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace ergotic::scene {

/// Description of a scene for readers and players; the sound does not depend on it.
struct About {
  std::string title;
  std::string author;
  std::string licence;  ///< SPDX
  std::string description;
  std::vector<std::pair<std::string, std::string>> hands;  ///< `0..5`, and what these slices are
  std::string play;                                        ///< a gesture file beside the scene
  std::vector<std::string> sources;
  /// Position of the camera for the picture, and the point that it looks at, m, in the frame
  /// `model`.
  struct Camera {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
  };
  std::optional<Camera> picture;
};

}  // namespace ergotic::scene
