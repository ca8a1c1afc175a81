// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/outlines.hpp"

#include <string>
#include <utility>

namespace ergotic::node {
namespace {

std::size_t coordinateOf(const scene::Scene& scene, int mat) {
  std::size_t before = 0;
  for (int i = 0; i < mat; ++i) {
    before += static_cast<std::size_t>(
        scene::dimensionsOf(scene.sectionOf(scene.mats[static_cast<std::size_t>(i)]).geometry));
  }
  return before;
}

void addOutline(scene::Scene& scene, const scene::Outline& outline) {
  const auto first = static_cast<int>(scene.mats.size());
  const int section = scene.mats[static_cast<std::size_t>(outline.first_mat)].section;
  for (std::size_t p = 0; p < outline.rest.size(); ++p) {
    scene::Mat place;
    place.name = Outlines::nameOf(outline, p);
    place.type = scene::MatType::kPoint;
    place.section = section;
    place.rest = outline.rest[p];
    scene.mats.push_back(std::move(place));
  }
  for (const auto& [a, b] : outline.lines) {
    scene::Lia line;
    line.name = outline.name + ".outline." + std::to_string(a) + '.' + std::to_string(b);
    line.a = first + a;
    line.b = first + b;
    scene.lias.push_back(std::move(line));
  }
}

}  // namespace

Outlines::Outlines(const scene::Scene& scene) {
  for (const scene::Outline& outline : scene.outlines) {
    shapes_.push_back({coordinateOf(scene, outline.first_mat),
                       static_cast<std::size_t>(outline.modes),
                       {outline.weights.begin(), outline.weights.end()}});
  }
}

void Outlines::move(std::vector<float>& displacements) const {
  for (const Shape& shape : shapes_) {
    for (std::size_t w = 0; w < shape.weights.size(); w += shape.modes) {
      float moved = 0.0F;
      for (std::size_t j = 0; j < shape.modes; ++j) {
        moved += shape.weights[w + j] * displacements[shape.first + j];
      }
      displacements.push_back(moved);
    }
  }
}

std::string Outlines::nameOf(const scene::Outline& outline, std::size_t place) {
  return outline.name + ".outline." + std::to_string(place);
}

scene::Scene Outlines::addTo(scene::Scene scene) {
  for (const scene::Outline& outline : scene.outlines) {
    addOutline(scene, outline);
  }
  return scene;
}

}  // namespace ergotic::node
