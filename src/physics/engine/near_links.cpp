// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/near_links.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace ergotic::physics {
namespace {

constexpr int kHole = 16;  // slots between two spans that are as quickly looked at

/// How much the gap of a link changes if every coordinate moves by one.
double weightOf(const EnergyStableLink& link) {
  double sum = 0.0;
  for (const EnergyStableTerm& term : link.terms) {
    sum += std::abs(term.weight[0]) + std::abs(term.weight[1]) + std::abs(term.weight[2]);
  }
  return sum;
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
  const bool are_many =
      std::count_if(links.begin(), links.end(), mayWait) >= static_cast<std::ptrdiff_t>(kFewest);
  for (std::size_t first = 0; first < links.size();) {
    const bool waits = are_many && links[first].may_wait;
    std::size_t last = first + 1;
    while (last < links.size() && (are_many && links[last].may_wait) == waits &&
           !(waits && last - first == kTile)) {
      ++last;
    }
    tiles_.push_back({first, last - first, waits ? static_cast<int>(waiting_++) : -1, 0, 0});
    for (std::size_t l = first; waits && l < last; ++l) {
      Tile& tile = tiles_.back();
      tile.weight = std::max(tile.weight, static_cast<Real>(weightOf(links[l])));
      const double* const offset = links[l].offset;
      tile.offset = std::max(
          tile.offset,
          static_cast<Real>(std::abs(offset[0]) + std::abs(offset[1]) + std::abs(offset[2])));
    }
    first = last;
  }
  findSpans(links);
}

/// Finds the ranges of all slots whose motion can close a gap.
template <class Real>
void NearLinks<Real>::findSpans(const std::vector<EnergyStableLink>& links) {
  std::vector<int> slots;
  for (const Tile& tile : tiles_) {
    for (std::size_t l = tile.first; tile.clearance >= 0 && l < tile.first + tile.count; ++l) {
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
ERGOTIC_REALTIME void NearLinks<Real>::find(const Real* x,
                                            const Real* d,
                                            Real* clearances) noexcept {
  farthest_ = Real(0);
  Real step(0);
  for (const std::pair<int, int>& span : spans_) {
    farthest_ = largerOf(farthest_, largestOf(x, span));
    step = largerOf(step, largestOf(d, span));
  }
  step += std::numeric_limits<Real>::epsilon() * farthest_;  // by which x is rounded
  count_ = 0;
  for (Tile& tile : tiles_) {
    if (tile.clearance >= 0) {
      Real& clearance = clearances[tile.clearance];
      const Real most = tile.weight * step;
      clearance -= most;
      // A contact that closes in the step to come begins to push in this one.
      tile.found = !(clearance > most);
    } else {
      tile.found = true;
    }
    for (std::size_t l = tile.first; tile.found && l < tile.first + tile.count; ++l) {
      found_[count_++] = l;
    }
  }
}

template class NearLinks<float>;
template class NearLinks<double>;

}  // namespace ergotic::physics
