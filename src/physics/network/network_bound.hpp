// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "physics/network/network.hpp"

namespace ergotic::physics {

/// A network of springs and dampers, each a rank-one load k u u^T, z u u^T with u the weights of
/// the nodes it joins (+1 and -1 for a plain link, 1 for one to a fixed point), and upper bounds of
/// the largest eigenvalue of M^-1 (h^2 K + 2 h Z). With K and Z positive semidefinite the explicit
/// scheme is stable if and only if that is below 4.
///
/// A negative k or z only ever lowers the eigenvalue, so the bounds leave it out; whether K and Z
/// are semidefinite all the same is a question for NetworkSpectrum.
/// Source: docs/physics/stability.md, "How a scene is certified".
class NetworkBound {
 public:
  static constexpr double kLimit = 4.0;

  struct Link {
    Shares ends;  ///< every node once
    Range stiffness;
    Range damping;
    int label = -1;
  };
  /// A link with an end that may be at any of some places, here one after the other.
  struct MovingLink {
    std::vector<Shares> places;
    double stiffness = 0.0;
    double damping = 0.0;
    int label = -1;
  };

  /// \param step  h, time units
  explicit NetworkBound(double step) : step_(step) {}

  /// \param owner  whatever the caller wants back from ownerOf(). \return the node
  int addNode(double mass, int owner);
  /// \param ends   shares of one node add up; none: held at both ends, without effect
  /// \param label  whatever the caller wants back from worstLink()
  void addLink(const Shares& ends, Range stiffness, Range damping, int label);
  /// Four corners of a mesh between which links may lie, for cellBound(); -1: none there.
  void addCell(const std::array<int, 4>& nodes) { cells_.push_back(nodes); }
  /// \param places  more than one
  void addMovingLink(const std::vector<Shares>& places,
                     double stiffness,
                     double damping,
                     int label);

  /// A network in which every moving link loads all its positions at once. It bounds this one from
  /// above, since (u - v)(u - v)^T <= (1 + t) u u^T + (1 + 1/t) v v^T for any t > 0.
  NetworkBound withMovingEverywhere() const;

  /// max over links of sum_i |u_i| S_i / M_i, S_i the sum of (h^2 k + 2 h z) |u_i| at node i, which
  /// is S_i/M_i + S_j/M_j for plain links. O(links)
  double linkBound() const;

  /// max_i (|M^-1 A| x)_i / x_i after some iterations from x = 1: a bound at every one of them,
  /// exact in the limit for chains and square grids. O(links * iterations)
  double collatzWielandtBound(int iterations) const;

  /// The longest step at which linkBound() is at most 4, time units; infinity if any will do.
  double stableStep() const;

  int worstLink() const;         ///< label of the link with the largest bound; -1: none
  int worstOwner() const;        ///< owner of its most loaded node; -1: none
  int largestComponent() const;  ///< nodes
  bool hasNegativeStiffness() const;
  bool hasNegativeDamping() const;

  double step() const { return step_; }
  int nodes() const { return static_cast<int>(mass_.size()); }
  double mass(int node) const { return mass_[static_cast<std::size_t>(node)]; }
  int ownerOf(int node) const { return owner_[static_cast<std::size_t>(node)]; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<MovingLink>& movingLinks() const { return moving_; }
  const std::vector<std::array<int, 4>>& cells() const { return cells_; }
  double load(const Link& link) const;  ///< h^2 k + 2 h z, at its stiffest, not below 0

 private:
  std::vector<double> sums(double per_stiffness, double per_damping) const;  // S, per node
  double bound(const Link& link, const std::vector<double>& sum) const;
  const Link* worst() const;
  std::vector<int> components() const;  // a node that stands for each node's component

  double step_;
  std::vector<double> mass_;
  std::vector<int> owner_;
  std::vector<Link> links_;
  std::vector<MovingLink> moving_;
  std::vector<std::array<int, 4>> cells_;
};

}  // namespace ergotic::physics
