// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <vector>

#include "physics/disjoint_sets.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Finds where energy is lost in every motion: where the damping matrix of the explicit links, at
/// their softest, is positive definite. A bounded force keeps its modules bounded only if all of
/// them lose energy, and all to which energy-stable links pass energy on; a part without loss
/// accumulates the least energy that a step gives (docs/physics/stability.md, "How a scene is
/// certified").
class EnergyLoss {
 public:
  /// \param networks  must outlive this; links of which the scheme is open count as energy-stable
  explicit EnergyLoss(const RatedNetwork& networks);

  /// True if all that a link acts on, at one rate, loses energy. Cost: a factorisation for each
  /// island that is asked for.
  bool surrounds(const scene::Lia& lia);
  /// True if what a link gives stays bounded: its force is held, and it is surrounded. A damper
  /// that comes and goes with the link is not held, and two or more modes may meet it where it
  /// drives.
  bool bears(const scene::Lia& lia);

 private:
  struct Group {
    std::vector<int> islands;
    std::set<int> divisors;
    bool keeps = false;  // a module in it may move without any loss
  };

  bool mayKeep(int mat) const;
  bool loses(int island);
  bool judge(const Group& group);
  bool crossesToAMass(const scene::Lia& lia) const;

  const RatedNetwork& networks_;
  DisjointSets joined_;           // islands, by energy-stable links
  std::map<int, Group> groups_;   // by the island that names them
  std::map<int, bool> of_group_;  // known
};

}  // namespace ergotic::physics
