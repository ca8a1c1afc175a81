// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/body.hpp"

namespace ergotic::scene {

/// Positions of the modules of a flat body, row by row.
struct Sheet {
  std::string name;
  int section = 0;
  int rows = 0;
  int columns = 0;
  double spacing = 0.01;                         ///< m; columns along y, rows along z
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of the first module, m
  Place place;
};

/// Appends `name.<row>.<column>` and the grid.
/// \param mass_at  kg; 0: a ground
void addSheet(SceneBuilder& builder,
              const Sheet& sheet,
              const BodyWish& wish,
              const std::function<double(int row, int column)>& mass_at);

}  // namespace ergotic::scene
