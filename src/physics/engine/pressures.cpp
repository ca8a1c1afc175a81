// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/pressures.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"

namespace ergotic::physics {
namespace {

int pressingOf(const Layout& layout, const EnergyStableRef& ref) {
  const auto& all = layout.pressings;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Pressing& pressing) {
    return pressing.run == ref.run && pressing.link == ref.link;
  });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

}  // namespace

template <class Real>
Pressures<Real>::Pressures(const Layout& layout, const std::vector<EnergyStableGroup>& groups)
    : layout_(layout) {
  for (const EnergyStableGroup& group : groups) {
    std::vector<Friction>& frictions = frictions_.emplace_back();
    for (std::size_t l = 0; l < group.links.size(); ++l) {
      if (scene::sticks(layout.runs[group.links[l].run].law)) {
        frictions.push_back({l, pressingOf(layout, group.links[l])});
      }
    }
    pressed_.emplace_back(frictions.empty() ? 0 : group.links.size());
  }
}

template <class Real>
const Pressure<Real>* Pressures<Real>::read(std::size_t group,
                                            const EnergyStableLaw<Real>* laws,
                                            State<Real>& state) noexcept {
  for (const Friction& friction : frictions_[group]) {
    Pressure<Real>& to = pressed_[group][friction.link];
    if (friction.pressing >= 0) {
      readContact(layout_.pressings[at(friction.pressing)], state, to);
    } else {
      to.force = laws[friction.link].normal;
    }
  }
  return pressed_[group].data();
}

/// A contact pushes its ends apart. Along one axis its force has a sign; between places it is a
/// vector, which pushes where it is against the way from a to b as links count it.
template <class Real>
void Pressures<Real>::readContact(const Pressing& by,
                                  State<Real>& state,
                                  Pressure<Real>& to) const noexcept {
  const LinkRun& run = layout_.runs[by.by_run];
  const LinkMemory<Real> memory = state.memory(by.by_run);
  const LinkEnds& ends = run.ends[by.by_link];
  const auto forceAlong = [&](int k) {
    const std::size_t index = at(k) * run.ends.size() + by.by_link;
    return memory.elastic[index] + memory.viscous[index];
  };
  if (run.dimensions == 0) {
    to.force = std::max(Real(0), forceAlong(0));
    return;
  }
  Real line[3] = {Real(0), Real(0), Real(0)};
  Real push = Real(0);
  Real square = Real(0);
  for (int k = 0; k < run.dimensions; ++k) {
    line[k] = state.x()[ends.a + k * run.stride_a] - state.x()[ends.b + k * run.stride_b] +
              static_cast<Real>(run.rests[by.by_link][k]);
    push -= line[k] * forceAlong(k);
    square += line[k] * line[k];
  }
  const Real length = std::sqrt(square);
  to.force = length > Real(0) ? std::max(Real(0), push / length) : Real(0);
  for (int k = 0; k < 3; ++k) {
    to.line[k] = by.is_tangent && length > Real(0) ? line[k] / length : Real(0);
  }
}

template class Pressures<float>;
template class Pressures<double>;

}  // namespace ergotic::physics
