// SPDX-License-Identifier: BSD-3-Clause
// What links owe whose masses went otherwise than they expected.
#include <algorithm>

#include "at.hpp"
#include "physics/engine/energy_stable.hpp"
#include "physics/engine/near_links.hpp"

namespace ergotic::physics {
namespace {

/// Gives up the rest of what a link has: a part of it goes to others.
template <class Real>
void keep(Real part, EnergyStableMotion<Real>& m, EnergyStableState<Real>& state) noexcept {
  const Real both = std::max(Real(0), state.tank + m.heat);
  const Real tank = std::clamp(state.tank, Real(0), both);
  state.tank = part * tank;
  m.heat = part * (both - tank);
}

}  // namespace

template <class Real>
std::size_t EnergyStableLinks<Real>::rootOf(std::size_t link) noexcept {
  while (clusters_[link].parent != link) {
    clusters_[link].parent = clusters_[clusters_[link].parent].parent;
    link = clusters_[link].parent;
  }
  return link;
}

template <class Real>
void EnergyStableLinks<Real>::joinThoseThatShare(const NearLinks<Real>& near,
                                                 const EnergyStableView<Real>& view) noexcept {
  for (const std::size_t l : near) {
    clusters_[l] = Cluster{};
    clusters_[l].parent = l;
  }
  for (const std::size_t l : near) {
    const Link& link = links_[l];
    for (std::size_t t = link.first; t < link.first + link.count; ++t) {
      if (!motions_[l].is_shared || !isFree(view, terms_[t])) {
        continue;
      }
      std::size_t& first = modules_[at(terms_[t].module)].first_link;
      if (first == 0) {
        first = l + 1;
      }
      clusters_[rootOf(l)].parent = rootOf(first - 1);
    }
  }
}

/// Leaves a link that part of its force, and an empty tank.
template <class Real>
void EnergyStableLinks<Real>::weaken(const Link& link,
                                     Real part,
                                     Motion& m,
                                     EnergyStableState<Real>& state) noexcept {
  Motion less = m;
  less.force *= part - Real(1);
  less.damper *= part - Real(1);
  load(link, less);
  m.force *= part;
  m.damper *= part;
  m.heat = Real(0);
  m.is_cut = m.is_pushing || m.is_friction;
  state.force = m.force;
  state.damper = m.damper;
  state.tank = Real(0);
  state.stored = static_cast<double>(m.budget - m.force * m.coasting / Real(4));
}

/// Among links that share masses, those with energy left pay for those that owe. If all together
/// cannot pay, all forces are scaled down: a part y of them does the work y a + y^2 b, with b the
/// work of the forces on one another, which is never negative.
template <class Real>
void EnergyStableLinks<Real>::settleDebts(const NearLinks<Real>& near,
                                          const EnergyStableView<Real>& view,
                                          EnergyStableState<Real>* states) noexcept {
  joinThoseThatShare(near, view);
  for (const std::size_t l : near) {
    if (motions_[l].is_shared) {
      const Motion& m = motions_[l];
      Cluster& cluster = clusters_[rootOf(l)];
      const Real left = states[l].tank + m.heat;
      cluster.before += m.budget;
      cluster.left += left;
      cluster.credit += std::max(Real(0), left);
      cluster.alone += m.total() * (m.opening - m.expected) / Real(2);
    }
  }
  for (const std::size_t l : near) {
    Cluster& cluster = clusters_[l];  // of which those count where roots stand
    const Real together = cluster.before - cluster.left - cluster.alone;
    cluster.part = std::min(Real(1), largestForce(cluster.before, Real(2) * cluster.alone,
                                                  Real(2) * std::max(Real(0), together)));
  }
  for (const std::size_t l : near) {
    if (motions_[l].is_shared) {
      const Cluster& cluster = clusters_[rootOf(l)];
      if (cluster.left < Real(0)) {
        weaken(links_[l], cluster.part, motions_[l], states[l]);
      } else if (cluster.left < cluster.credit) {
        keep(cluster.left / cluster.credit, motions_[l], states[l]);
      }
    }
  }
}

template std::size_t EnergyStableLinks<float>::rootOf(std::size_t) noexcept;
template std::size_t EnergyStableLinks<double>::rootOf(std::size_t) noexcept;
template void EnergyStableLinks<float>::joinThoseThatShare(const NearLinks<float>&,
                                                           const EnergyStableView<float>&) noexcept;
template void EnergyStableLinks<double>::joinThoseThatShare(
    const NearLinks<double>&, const EnergyStableView<double>&) noexcept;
template void EnergyStableLinks<float>::weaken(const Link&,
                                               float,
                                               Motion&,
                                               EnergyStableState<float>&) noexcept;
template void EnergyStableLinks<double>::weaken(const Link&,
                                                double,
                                                Motion&,
                                                EnergyStableState<double>&) noexcept;
template void EnergyStableLinks<float>::settleDebts(const NearLinks<float>&,
                                                    const EnergyStableView<float>&,
                                                    EnergyStableState<float>*) noexcept;
template void EnergyStableLinks<double>::settleDebts(const NearLinks<double>&,
                                                     const EnergyStableView<double>&,
                                                     EnergyStableState<double>*) noexcept;

}  // namespace ergotic::physics
