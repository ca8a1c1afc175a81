// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/near_links.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Core>

namespace ergotic::physics {
namespace {

constexpr int kHole = 16;  // slots between two spans that are as quickly looked at

double weightOf(const EnergyStableTerm& term) {
  return std::abs(term.weight[0]) + std::abs(term.weight[1]) + std::abs(term.weight[2]);
}

/// How much the gap of a link changes if every coordinate moves by one.
double weightOf(const EnergyStableLink& link) {
  return std::accumulate(
      link.terms.begin(), link.terms.end(), 0.0,
      [](double sum, const EnergyStableTerm& term) { return sum + weightOf(term); });
}

/// The larger value; NaN if either is NaN: then all links are worked out.
template <class Real>
Real largerOf(Real a, Real b) noexcept {
  return a > b || std::isnan(a) ? a : b;
}

template <class Real>
Real largestOf(const Real* values, const std::pair<int, int>& span) noexcept {
  using Array = Eigen::Array<Real, Eigen::Dynamic, 1>;
  return Eigen::Map<const Array>(values + span.first, span.second)
      .abs()
      .template maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace

template <class Real>
NearLinks<Real>::NearLinks(const std::vector<EnergyStableLink>& links) : found_(links.size()) {
  const auto mayWait = [](const EnergyStableLink& link) { return link.may_wait; };
  const auto waiting = static_cast<std::size_t>(std::count_if(links.begin(), links.end(), mayWait));
  const std::size_t most = std::clamp<std::size_t>(waiting / kMostTiles, 1, kLargestTile);
  for (std::size_t first = 0; first < links.size();) {
    const bool waits = links[first].may_wait;
    std::size_t last = first + 1;
    while (last < links.size() && links[last].may_wait == waits &&
           !(waits && last - first == most)) {
      ++last;
    }
    tiles_.push_back({first, last - first, -1, 0, 0, 0, 0});
    if (waits) {
      completeTile(links);
    }
    first = last;
  }
  findSpans(links);
}

/// Completes the last tile, of links that may wait.
template <class Real>
void NearLinks<Real>::completeTile(const std::vector<EnergyStableLink>& links) {
  Tile& tile = tiles_.back();
  tile.clearance = static_cast<int>(waiting_++);
  for (std::size_t l = tile.first; l < tile.first + tile.count; ++l) {
    tile.weight = std::max(tile.weight, static_cast<Real>(weightOf(links[l])));
    const double* const offset = links[l].offset;
    tile.offset = std::max(
        tile.offset,
        static_cast<Real>(std::abs(offset[0]) + std::abs(offset[1]) + std::abs(offset[2])));
  }
  if (tile.count == 1) {
    tile.first_term = terms_.size();
    for (const EnergyStableTerm& term : links[tile.first].terms) {
      terms_.push_back({term.slot, static_cast<Real>(weightOf(term))});
    }
    tile.terms = terms_.size() - tile.first_term;
  }
}

/// Finds the ranges of all slots whose motion can close a gap of a tile that W counts for.
template <class Real>
void NearLinks<Real>::findSpans(const std::vector<EnergyStableLink>& links) {
  std::vector<int> slots;
  for (const Tile& tile : tiles_) {
    const bool counts = tile.clearance >= 0 && tile.terms == 0;
    for (std::size_t l = tile.first; counts && l < tile.first + tile.count; ++l) {
      for (const EnergyStableTerm& term : links[l].terms) {
        slots.push_back(term.slot);
      }
    }
  }
  std::sort(slots.begin(), slots.end());
  for (const int slot : slots) {
    if (spans_.empty() || slot > spans_.back().first + spans_.back().second + kHole) {
      spans_.emplace_back(slot, 0);
    }
    spans_.back().second = slot + 1 - spans_.back().first;
  }
}

template <class Real>
Real NearLinks<Real>::changeOf(Tile& tile, const Real* x, const Real* d) noexcept {
  Real change = tile.weight * step_;
  tile.reach = tile.weight * farthest_;
  if (tile.terms > 0) {
    change = Real(0);
    tile.reach = Real(0);
    for (const Term *t = terms_.data() + tile.first_term, *end = t + tile.terms; t != end; ++t) {
      change += t->weight * std::abs(d[t->slot]);
      tile.reach += t->weight * std::abs(x[t->slot]);
    }
  }
  return change + std::numeric_limits<Real>::epsilon() * tile.reach;  // by which x is rounded
}

template <class Real>
ERGOTIC_REALTIME void NearLinks<Real>::find(const Real* x,
                                            const Real* d,
                                            Real* clearances) noexcept {
  farthest_ = Real(0);
  step_ = Real(0);
  for (const std::pair<int, int>& span : spans_) {
    farthest_ = largerOf(farthest_, largestOf(x, span));
    step_ = largerOf(step_, largestOf(d, span));
  }
  count_ = 0;
  for (Tile& tile : tiles_) {
    tile.found = tile.clearance < 0;
    if (!tile.found) {
      Real& clearance = clearances[tile.clearance];
      const Real change = changeOf(tile, x, d);
      clearance -= change;
      // A contact that closes in the step to come begins to push in this one.
      tile.found = !(clearance > change);
    }
    for (std::size_t l = tile.first; tile.found && l < tile.first + tile.count; ++l) {
      found_[count_++] = l;
    }
  }
}

template class NearLinks<float>;
template class NearLinks<double>;

}  // namespace ergotic::physics
