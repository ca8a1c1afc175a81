// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace ergotic::scene {

/// What readers and players are told of a scene; nothing that sounds depends on it.
struct About {
  std::string title;
  std::string author;
  std::string licence;  ///< SPDX
  std::string description;
  std::vector<std::pair<std::string, std::string>> hands;  ///< `0..5`, and what these slices are
  std::string play;                                        ///< a gesture file beside the scene
  std::vector<std::string> sources;
  /// From where and whereto the picture is taken, m, in the frame `model`.
  struct Camera {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
  };
  std::optional<Camera> picture;
};

}  // namespace ergotic::scene
