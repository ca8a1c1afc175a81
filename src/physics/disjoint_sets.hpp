// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace ergotic::physics {

/// Disjoint sets of the numbers from 0 on, at first each by itself. Every set is named by one of
/// its members, and which one does not depend on who asked before.
///
/// Realtime: no. Cost: O(log n) each, amortised.
/// Source: Tarjan and van Leeuwen 1984, Journal of the ACM 31(2) (path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : above_(count) {
    std::iota(above_.begin(), above_.end(), 0);
  }

  /// The member that names the set of this one.
  int setOf(int member) {
    while (above(member) != member) {
      above(member) = above(above(member));
      member = above(member);
    }
    return member;
  }

  /// Makes one set of those of two members; it keeps the name of the second's.
  void join(int member, int to) { above(setOf(member)) = setOf(to); }

 private:
  int& above(int member) { return above_[static_cast<std::size_t>(member)]; }

  std::vector<int> above_;  // nearer to the one that names the set, which is above itself
};

}  // namespace ergotic::physics
