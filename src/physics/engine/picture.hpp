// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "ergotic/scene/scene.hpp"
#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// Reads the positions of the modules of the scene as written, which come first in the scene that
/// is played.
class Picture {
 public:
  /// \param shown  modules as written
  /// \pre layout was made from `played` and outlives this
  Picture(std::shared_ptr<const scene::Scene> played, std::size_t shown, const Layout& layout);

  /// Displacements from rest, m, [Scene::coordinates of what was written].
  /// \param x  [slots] those that are played. Realtime: yes. Cost: O(modules)
  template <class Real>
  void read(const Real* x, float* to) const noexcept;

 private:
  std::shared_ptr<const scene::Scene> played_;
  std::size_t shown_;
  const Layout& layout_;
};

}  // namespace ergotic::physics
