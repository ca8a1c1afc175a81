// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "physics/engine/energy_stable.hpp"

namespace ergotic::physics {

/// The energy-stable links that a step has to work out. A contact whose gap cannot have closed yet
/// is skipped: a step changes the gap of a link by at most the sum of |w d| over its modules. Where
/// there are many contacts, as of one body with all of another, they come in tiles, which are
/// skipped by their narrowest gap and by W max |d|, W the sum of the weights of a link. The result
/// is the same, bit for bit. Source:
/// docs/physics/schemes.md, "Energy-stable links".
template <class Real>
class NearLinks {
 public:
  explicit NearLinks(const std::vector<EnergyStableLink>& links);

  /// Tiles that may be passed over.
  std::size_t waiting() const noexcept { return waiting_; }

  /// Finds the links of this step, in their order.
  /// \param clearances  [waiting()] by how much gaps may close unseen; 0 at the start
  /// Realtime: yes. Cost: O(modules + links found)
  void find(const Real* x, const Real* d, Real* clearances) noexcept;
  const std::size_t* begin() const noexcept { return found_.data(); }
  const std::size_t* end() const noexcept { return found_.data() + count_; }

  /// Remembers how far apart the ends of what was found are.
  /// \param gapOf  of a link of index l, m; 0 if it does anything or still has to
  template <class GapOf>
  void remember(const GapOf& gapOf, Real* clearances) noexcept;

 private:
  static constexpr std::size_t kLargestTile = 32;
  static constexpr std::size_t kMostTiles = 32;  // of smaller ones

  struct Tile {
    std::size_t first;  // index of a link
    std::size_t count;
    int clearance;           // index, -1: it is always looked at
    Real weight;             // W
    Real offset;             // m, the largest: gaps are rounded by so much
    std::size_t first_term;  // of a link that is a tile by itself
    std::size_t terms;       // 0: W counts
    bool found = false;      // in this step
    Real reach = Real(0);    // the largest sum of |w x| of a link, m
  };
  struct Term {
    int slot;
    Real weight;
  };

  void completeTile(const std::vector<EnergyStableLink>& links);
  void findSpans(const std::vector<EnergyStableLink>& links);
  /// How much the gaps of a tile can have changed in the last step.
  Real changeOf(Tile& tile, const Real* x, const Real* d) noexcept;

  std::vector<Tile> tiles_;
  std::vector<Term> terms_;
  std::size_t waiting_ = 0;
  std::vector<std::pair<int, int>> spans_;  // of slots, first and count
  std::vector<std::size_t> found_;          // [links]
  std::size_t count_ = 0;
  Real farthest_ = Real(0);  // |x| of all tiles that W counts for, m
  Real step_ = Real(0);      // |d| of these, m
};

extern template class NearLinks<float>;
extern template class NearLinks<double>;

template <class Real>
template <class GapOf>
void NearLinks<Real>::remember(const GapOf& gapOf, Real* clearances) noexcept {
  constexpr Real kRounding = Real(64) * std::numeric_limits<Real>::epsilon();
  for (const Tile& tile : tiles_) {
    if (!tile.found || tile.clearance < 0) {
      continue;
    }
    Real gap = std::numeric_limits<Real>::max();
    for (std::size_t l = tile.first; l < tile.first + tile.count; ++l) {
      gap = std::min(gap, gapOf(l));
    }
    clearances[tile.clearance] = gap / Real(2) - kRounding * (tile.offset + tile.reach);
  }
}

}  // namespace ergotic::physics
