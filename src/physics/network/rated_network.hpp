// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "physics/network/network.hpp"
#include "physics/network/network_bound.hpp"

namespace ergotic::physics {

/// A network at the rates of its sections: its explicit links, at the worst ends of all ranges,
/// between the modules that forces move. Euclidean sections enter as the scalar network with the
/// same links, which bounds them whatever the directions, as a projected link has direction cosines
/// of at most 1.
class RatedNetwork {
 public:
  static constexpr int kAll = -1;

  /// \param network  of a settled scene, must outlive this
  RatedNetwork(const Network& network, const Rates& rates);

  const Network& network() const { return network_; }
  const scene::Scene& scene() const { return scene_; }
  const Rates& rates() const { return rates_; }
  const Slopes& slopes(int lia) const { return linkOf(lia).slopes; }
  int divisorOfMat(int mat) const;

  /// Largest 1/M of a module, or sum of w^2/M of a point, wherever it can lie; 0: held.
  double inverseMass(int mat) const;
  /// h^2 (1/Ma + 1/Mb) and h (1/Ma + 1/Mb) of a link at the rate it is computed at.
  double inverseMassStep2(const scene::Lia& lia) const;
  double inverseMassStep(const scene::Lia& lia) const;
  /// Step of the rate that a link is computed at, time units.
  double stepOf(const scene::Lia& lia) const;
  bool crossesRates(const scene::Lia& lia) const;
  /// The end of a link across rates that is stepped less often, and the other.
  int slowEnd(const scene::Lia& lia) const;
  int fastEnd(const scene::Lia& lia) const;
  bool isExplicit(const scene::Lia& lia) const;
  /// True if an explicit link acts on the module.
  bool isLinked(int mat) const { return is_linked_[static_cast<std::size_t>(mat)] != 0; }
  /// True if an end is a point that can move.
  bool isMoving(const scene::Lia& lia) const;
  bool isMovingPoint(int mat) const;
  /// True if a link acts along a line that turns: a spring is linear in the coordinates only where
  /// it has no rest length, and a damper only where they are one; one that remembers remembers a
  /// distance, which turns round where its ends pass one another.
  bool turns(const scene::Lia& lia) const;
  /// True if a link acts along the line between its ends and not along fixed axes.
  bool hasLineThatTurns(const scene::Lia& lia) const;
  /// True if its friction takes energy in every step: odd, nowhere falling, and not along a line
  /// that turns.
  bool onlyBrakes(const scene::Lia& lia) const;

  /// Modules that explicit links join, at whatever rates, are one island, named by one of them.
  int islandOf(int mat) const { return island_[static_cast<std::size_t>(mat)]; }
  /// Islands of the modules at both ends of a link that forces move: one island if it is explicit.
  std::set<int> islandsAt(const scene::Lia& lia) const;
  /// Island of the modules of an explicit link; -1 if no force moves any of them.
  int islandOf(const scene::Lia& lia) const;

  /// The network of everything that is computed at one rate, slower ends held.
  /// \param plain  matched modules as if they were not: a bound of them, at any step
  NetworkBound atOwnRate(int divisor, int island = kAll, bool plain = false) const {
    return ofOwnRate(divisor, island, plain, Part::kSteepest);
  }
  /// The same network with only the linear part of nonlinear links; and without links whose force
  /// is bounded however far or fast their ends move.
  NetworkBound atRest(int divisor) const { return ofOwnRate(divisor, kAll, false, Part::kAtRest); }
  NetworkBound withoutBounded(int divisor) const {
    return ofOwnRate(divisor, kAll, false, Part::kUnbounded);
  }
  /// Modules of one rate, all their links, and the faster modules that these touch, at that rate.
  NetworkBound atSlowRate(int divisor, int island = kAll) const;
  /// True if a module of this rate with matched coefficients has links.
  bool hasLinkedMatched(int divisor) const;

 private:
  struct Builder;
  enum class Part { kSteepest, kAtRest, kUnbounded };

  void joinGroups();
  /// True if it is explicit, and by itself: a bend is one load, whatever it is stepped as.
  bool isLoad(const scene::Lia& lia) const { return isExplicit(lia) && lia.bend < 0; }
  const Network::Link& linkOf(int lia) const {
    return network_.links[static_cast<std::size_t>(lia)];
  }
  const Network::Node& nodeOf(int mat) const {
    return network_.nodes[static_cast<std::size_t>(mat)];
  }
  std::vector<Shares> placesOf(int mat) const { return physics::placesOf(network_, mat); }
  NetworkBound ofOwnRate(int divisor, int island, bool plain, Part part) const;
  Slopes slopesOf(const scene::Lia& lia, Part part) const;
  void addModules(Builder& to, bool plain) const;
  void addLink(Builder& to, int lia, bool hold_a, bool hold_b) const;
  void addBends(Builder& to) const;
  void addCells(Builder& to) const;

  const Network& network_;
  const scene::Scene& scene_;
  Rates rates_;
  std::vector<int> island_;               // [mats]
  std::vector<unsigned char> is_linked_;  // [mats] by an explicit link
};

}  // namespace ergotic::physics
