// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Shapes of bodies that are played by their modes. In pictures each of their places is a module
/// behind those of the scene, linked to its neighbours.
class Outlines {
 public:
  explicit Outlines(const scene::Scene& scene);

  /// Appends where the places are.
  /// \param displacements  [Scene::coordinates] m from rest, to which one for each place is added
  void move(std::vector<float>& displacements) const;

  static std::string nameOf(const scene::Outline& outline, std::size_t place);
  /// The scene as pictures show it.
  static scene::Scene addTo(scene::Scene scene);

 private:
  struct Shape {
    std::size_t first = 0;       // of the displacements of its modes
    std::size_t modes = 0;       // that many
    std::vector<float> weights;  // [places][modes]
  };
  std::vector<Shape> shapes_;
};

}  // namespace ergotic::node
