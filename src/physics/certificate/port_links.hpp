// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/rates.hpp"
#include "physics/network/network.hpp"

namespace ergotic::physics {

/// The links of every module, to see from a port what its hand meets. All in the model's units.
class PortLinks {
 public:
  /// \param network  must outlive it
  PortLinks(const Network& network, const Rates& rates);

  /// [nodes] of the network.
  const std::vector<std::vector<int>>& ofNodes() const { return links_of_; }

  /// Largest stiffness against slow motion of a port, with other hands at their worst.
  double stiffness(const scene::Port& port) const;
  /// Part of it by links that see the slice interpolated.
  double interpolatedStiffness(const scene::Port& port) const;
  /// The link that gives most of it, -1: none.
  int stiffest(const scene::Port& port) const;
  /// Largest damping of one step of a port by the links of its slice, other hands at their worst.
  double damping(const scene::Port& port) const;
  double interpolatedDamping(const scene::Port& port) const;
  /// The link of the slice with most damping, -1: none.
  int mostDamped(const scene::Port& port) const;
  /// A link of the slice that is below 0 somewhere and drives a hand, -1: none. Not one that a
  /// tank holds back.
  int driving(const scene::Port& port) const;

  /// Resistance of the links of a module to one step of it, with everything else held.
  struct Resistance {
    double stiffness = 0.0;
    double damping = 0.0;
  };
  /// Resistance at the slice itself, and by those of its links that see it held, or interpolated.
  Resistance atSlice(const scene::Port& port) const;
  Resistance heldAtSlice(const scene::Port& port) const;
  Resistance interpolatedAtSlice(const scene::Port& port) const;
  /// Resistance at the mass of the port's filter, without its link to the slice.
  /// \pre port.filter >= 0
  Resistance behindFilter(const scene::Port& port) const;

 private:
  const Network::Link& link(int l) const { return network_.links[static_cast<std::size_t>(l)]; }
  int otherEnd(int l, int mat) const { return link(l).a == mat ? link(l).b : link(l).a; }
  bool isAttached(const scene::Port& port, int l) const;
  bool isInterpolated(int l) const;
  std::vector<int> ownLinks(const scene::Port& port, bool interpolated) const;
  /// Links behind the filter, or of the slice if it has none.
  std::vector<int> linksOf(const scene::Port& port) const;
  bool isHeldBack(int l) const;
  double share(const scene::Port& port, int mat, int l) const;
  double share(const scene::Port& port, const scene::Port& moved, int mat, int l) const;
  double shareTogether(const scene::Port& port, int mat, int l) const;
  double hands(int mat) const;
  double along(const scene::Port& port, int l) const;
  double dampingAt(const scene::Port& port, int l) const;
  double slope(int l) const;
  double damping(int l) const;
  /// Links in a row, and what the last of them ends on.
  struct Series {
    double stiffness = 0.0;
    int end = -1;
  };
  Series series(int from, int l) const;
  Resistance sum(const scene::Port& port, int mat, const std::vector<int>& links) const;

  const Network& network_;
  const scene::Scene& scene_;
  const Rates rates_;
  std::vector<std::vector<int>> links_of_;   // [mats]
  std::vector<unsigned char> is_in_hand_;    // [mats]
  std::vector<unsigned char> is_under_tap_;  // [mats] what is on a tap pulls at it, too
};

}  // namespace ergotic::physics
