// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace ergotic::physics {

/// Upper bounds of the largest eigenvalue of M^-1 (h^2 K + 2 h Z) of a network of springs and
/// dampers with K, Z >= 0. The explicit scheme is stable if and only if it is below 4.
/// Source: docs/physics.md, "Stability".
class NetworkBound {
 public:
  static constexpr int kFixed = -1;  ///< an end that does not move by forces
  static constexpr double kLimit = 4.0;

  /// \param step  h, time units
  explicit NetworkBound(double step) : step_(step) {}

  /// \param owner  whatever the caller wants back from worstOwner(). \return the node
  int addNode(double mass, int owner);
  /// \param label  whatever the caller wants back from worstLink()
  void addLink(int a, int b, double stiffness, double damping, int label);

  /// max over links of S_i/M_i + S_j/M_j, S_i the sum of h^2 K + 2 h Z at node i; fixed ends
  /// count 0. O(links)
  double linkBound() const;

  /// max_i (|M^-1 A| x)_i / x_i after some iterations from x = 1: a bound at every one of them,
  /// exact in the limit for chains and square grids. O(links * iterations)
  double collatzWielandtBound(int iterations) const;

  /// Label of the link with the largest bound, and owner of its more loaded node; -1: none.
  int worstLink() const;
  int worstOwner() const;

  /// The longest step at which linkBound() is at most 4, time units; infinity if any will do.
  double stableStep() const;

 private:
  struct Link {
    int a;
    int b;
    double stiffness;
    double damping;
    int label;
  };
  double load(const Link& link) const {
    return step_ * step_ * link.stiffness + 2.0 * step_ * link.damping;
  }
  double ratio(int node) const;  // S/M
  double bound(const Link& link) const { return ratio(link.a) + ratio(link.b); }
  const Link* worst() const;

  double step_;
  std::vector<double> mass_;
  std::vector<int> owner_;
  std::vector<double> stiffness_sum_;
  std::vector<double> damping_sum_;
  std::vector<Link> links_;
};

}  // namespace ergotic::physics
