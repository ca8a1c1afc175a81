// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "physics/modes/modal_parts.hpp"

namespace ergotic::physics {

/// Eigenvectors of a symmetric matrix, by ascending eigenvalue.
struct Modes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};

/// Realtime: no. Cost: O(size^3)
/// \throws Exception if the eigenvalues do not converge
std::shared_ptr<const Modes> modesOf(const ModalMatrix& matrix);

/// Cost of one step, by the network or by all of its modes.
struct ModalCost {
  int modules = 0;   ///< masses and links that modes stand in for
  int modes = 0;     ///< modes that there are in all
  int products = 0;  ///< modes, each by itself and once more for every touched place of its part
};
/// \param points  [parts] places of the part that are touched
ModalCost costOf(const std::vector<LinearPart>& parts, const std::vector<int>& points);

/// A part with its modes as the places that are touched see them. Modal coordinates are in
/// m kg^1/2, so that every mode has the mass 1 kg.
struct ModalPart {
  std::shared_ptr<const Modes> modes;
  Eigen::VectorXd pull;         ///< [modes] as MassCoefficients; >= 0
  Eigen::VectorXd loss;         ///< [modes] as MassCoefficients::lose
  Eigen::MatrixXd weights;      ///< [points][modes] kg^-1/2
  Eigen::VectorXd x;            ///< [modes] at the start
  Eigen::VectorXd d;            ///< per step
  Eigen::VectorXd constant;     ///< force
  Eigen::VectorXd first_force;  ///< in the first step only: cancels what springs would do in it
  std::vector<int> kept;        ///< modes that are played, ascending
};

/// Error of leaving modes out, with forces and initial motion unchanged.
struct ModalError {
  /// Largest part of the static give of a touched place that is missing; between two places it is
  /// no more of the geometric mean of theirs. Exact.
  double static_share = 0.0;
  /// Bound of the missing displacement of any touched place at any time, m, after forces on touched
  /// places whose impulses add up to 1 N s.
  double per_impulse = 0.0;
  /// Bound of that which the motion and the constant forces at the start make, m.
  double at_start = 0.0;
};

/// Keeps the modes that matter most to these bounds, `most` in all parts together.
/// \param step  s
ModalError keepModes(std::vector<ModalPart>& parts, int most, double step);

/// Largest |x| that a mode reaches after d = 1 from rest, at most; infinite if it goes away.
double peakAfterKick(double pull, double loss);

}  // namespace ergotic::physics
