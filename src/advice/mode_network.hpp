// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "ergotic/physics/rates.hpp"
#include "physics/network/network.hpp"

namespace ergotic::physics {

/// A spring and damper in coordinates M^1/2 x, one row for each coordinate of each free module.
struct ModeLoad {
  Shares ends;        ///< node: a row; weight: over the root of its mass
  double pull = 0.0;  ///< h^2 K
  double loss = 0.0;  ///< h Z
  int lia = -1;       ///< link that it belongs to; or
  int bend = -1;      ///< bend; both -1: it is of the module itself
};

/// Force of a load on a module that is heard, along one of its axes, for an elongation of 1 m.
struct HeardForce {
  int mat = 0;
  int load = 0;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< times K
};

/// All sections of one rate as a network, linearised about the rest positions of its modules.
struct ModeNetwork {
  int divisor = 1;
  double step_s = 0.0;
  std::vector<int> row_of;        ///< [mats] the first of as many as coordinates move; -1: none
  std::vector<int> mat_of;        ///< [rows]
  std::vector<double> root_mass;  ///< [rows] kg^1/2
  std::vector<ModeLoad> loads;
  std::vector<HeardForce> forces;
  int held = 0;           ///< links whose other end moves at another rate, where it is held
  int energy_stable = 0;  ///< links that are energy-stable, taken as if they were explicit
  int relaxing = 0;       ///< links whose memory is left out

  int rows() const { return static_cast<int>(mat_of.size()); }
};

/// \param is_heard  [mats] not 0: what acts on it is told in `forces`
ModeNetwork modeNetworkOf(const Network& network,
                          const Rates& rates,
                          int divisor,
                          const std::vector<unsigned char>& is_heard);

/// Rows that loads join, and their matrices.
struct ModePart {
  std::vector<int> rows;        ///< ascending
  std::vector<ModeLoad> loads;  ///< ends by their place in `rows`
  Eigen::SparseMatrix<double> pull;
  Eigen::SparseMatrix<double> loss;
};

std::vector<ModePart> partsOf(const ModeNetwork& network);

}  // namespace ergotic::physics
