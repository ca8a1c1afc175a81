// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "ergotic/scene/scene.hpp"
#include "physics/layout/layout.hpp"
#include "physics/modes/modal_scene.hpp"

namespace ergotic::physics {

/// What the scene as it was written shows of the motion of the one that is played: the same, or one
/// in which modes stand in for modules.
class Picture {
 public:
  /// \param as_written  nothing if `played` is `written`
  /// \pre layout was made from `played` and outlives this
  Picture(std::shared_ptr<const scene::Scene> written,
          std::shared_ptr<const scene::Scene> played,
          const Layout& layout,
          std::optional<AsWritten> as_written);

  /// Displacements from rest, m, [Scene::coordinates of what was written].
  /// \param x  [slots] those that are played. Realtime: yes. Cost: O(modules)
  template <class Real>
  void read(const Real* x, float* to) const noexcept;

  /// Index of a link that is played in the scene as it was written.
  int liaAsWritten(int lia) const;

 private:
  template <class Real>
  float sumOf(const ModalPicture& picture, const Real* x) const noexcept;

  std::shared_ptr<const scene::Scene> written_;
  std::shared_ptr<const scene::Scene> played_;
  const Layout& layout_;
  std::optional<AsWritten> as_written_;
};

}  // namespace ergotic::physics
