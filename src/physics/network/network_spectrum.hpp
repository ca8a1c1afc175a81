// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Sparse>

#include "physics/network/network_bound.hpp"

namespace ergotic::physics {

/// The exact answers about a network, by sparse LDL^T: a symmetric matrix is positive definite if
/// and only if all its pivots are positive. Coefficients are those of the stiffest case.
/// Realtime: no. Cost: some tens of factorisations; moving links: as many solutions as places for
/// each of them.
class NetworkSpectrum {
 public:
  /// \param network  must outlive this
  explicit NetworkSpectrum(const NetworkBound& network);

  /// False if coefficients overflow: then nothing here means anything.
  bool isFinite() const { return finite_; }

  /// The largest eigenvalue of M^-1 (h^2 K + 2 h Z), rounded up by at most 1e-6 of it. It is below
  /// 4 if and only if 4 (1 - 1e-9) M - h^2 K - 2 h Z is positive definite. With moving links: of
  /// the worst places; an upper bound if there are several such links.
  double lambda();

  /// The longest step that keeps lambda() below 4, time units, rounded down by at most 1e-6 of it;
  /// infinity if any will do. \pre lambda() was called
  double longestStep();

  /// Label of the link that takes the largest part of the energy of the mode that lambda() belongs
  /// to, and owner of its end that moves most; -1: none. \pre lambda() was called
  int worstLink() const { return worst_link_; }
  int worstOwner() const { return worst_owner_; }

  /// Modules that are joined with something negative, if the softest case of K (of Z) is
  /// positive semidefinite there all the same, by 1e-6 of its norm; none if not. \pre something is
  /// negative
  static std::optional<std::vector<int>> semidefiniteStiffness(const NetworkBound& network);
  static std::optional<std::vector<int>> semidefiniteDamping(const NetworkBound& network);
  /// True if Z is positive definite in its softest case, by 1e-9 of its norm; false of nothing.
  static bool hasDefiniteDamping(const NetworkBound& network);

  /// u' K^-1 u for the weights u at some nodes, K in its softest case, rounded up: K less a load of
  /// k u u^T is definite for every k below its inverse. Infinite if all that is joined with
  /// them is not held, by 4e-9 of the norm.
  static double softness(const NetworkBound& network, const Shares& u);
  /// The same for the damping: u' Z^-1 u.
  static double mobility(const NetworkBound& network, const Shares& u);

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  /// limit I - t^2 K - 2 t Z for unit masses, definite below some t: lower triangles, all of one
  /// pattern. Moving links load it by (t^2 k + 2 t z) u u^T.
  struct Pencil {
    Matrix stiffness;
    Matrix damping;
    std::vector<double> moving_stiffness;
    std::vector<double> moving_damping;
    double limit = 0.0;
  };

  bool isDefinite(const Pencil& pencil, double t);  // without moving links; factorises
  bool holds(const Pencil& pencil, double t);       // with them
  double reach(const Pencil& pencil) const;         // what the present mode refutes
  double longest(const Pencil& pencil, double proven);
  double longestAtRest(const Pencil& pencil, double proven);
  double placeCompliance(const NetworkBound::MovingLink& link) const;
  void findWorst();

  const NetworkBound& network_;
  Eigen::VectorXd scale_;  // M^-1/2
  Eigen::VectorXd mode_;   // of unit masses
  Pencil pencil_;          // of the longest step
  Eigen::SimplicialLDLT<Matrix> solver_;
  double bound_ = 0.0;  // of lambda
  double lambda_ = 0.0;
  int worst_link_ = -1;
  int worst_owner_ = -1;
  bool finite_ = true;
};

}  // namespace ergotic::physics
