// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "physics/network/network.hpp"

namespace ergotic::physics {

/// The springs that always hold in one section, at the present values of the parameters, as a
/// scalar network: linear springs, two-sided nonlinear ones with their slope at rest, cells. Links
/// to other sections count where they end on the ground; the hand, contacts, plucks and bows may
/// let go and do not count, nor do links that wait for a filter. Everything is in SI units.
///
/// In Euclidean sections the scalar network is at least as stiff as the real one.
/// Realtime: no.
class LinearNetwork {
 public:
  /// \param network  must outlive it
  /// \param absent   a module to be left out, with its links; -1: none
  LinearNetwork(const Network& network, int section, int absent = -1);

  /// True if a force at this module or point of the section can move it.
  bool moves(int mat) const { return !sharesOf(mat).empty(); }

  /// Mass that a force at a module or point accelerates, kg.
  /// \pre moves(mat)
  double massAt(int mat) const;

  /// Static stiffness 1/(K^-1)_ii, N/m; 0 if its part of the network is tied to no ground.
  /// \pre moves(mat). Cost: one sparse LDL^T of that part
  double stiffnessAt(int mat) const;

  /// Resistance that a wave leaving from there meets, kg/s: the sum over its links of
  /// sqrt(K min(M_i, M_j)) and what damps it to the ground; 0 if it has none of these. At a tap
  /// 1/(sum of w^2/Z) over its modules.
  /// \pre moves(mat)
  double impedanceAt(int mat) const;

  /// Upper bound of w^2, (rad/s)^2, over the modes of its part of the network; 0 without springs.
  /// Exact in the limit for chains and square grids.
  /// \pre moves(mat)
  double highestModeAt(int mat) const;

  /// w^2 of every mode, (rad/s)^2, ascending; empty if there are more than `most`.
  /// Cost: O(modes^3)
  std::vector<double> modes(int most) const;

 private:
  struct Spring {
    double stiffness;
    Shares ends;
    bool anchored;  // a part of it is held by the ground
  };
  struct Part {
    std::vector<int> row_of_node;  // -1: not in this part
    Eigen::SparseMatrix<double> stiffness;
    Eigen::VectorXd mass;
    bool anchored = false;
  };

  void addModules(int section, int absent);
  void addSprings(int section, int absent);
  bool counts(const scene::Lia& lia, int section, int absent) const;
  Shares sharesOf(int mat) const { return sharesAmong(network_, node_of_mat_, mat); }
  double impedanceOf(const Shares& shares) const;
  double effectiveMass(const Shares& shares, double sign) const;
  Part partAround(int mat) const;

  const Network& network_;
  std::vector<int> node_of_mat_;  // -1: does not move, or is elsewhere
  std::vector<double> mass_;
  std::vector<double> damping_;  // to the ground
  std::vector<Spring> springs_;
};

}  // namespace ergotic::physics
