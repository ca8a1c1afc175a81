// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "ergotic/scene/origin.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"

namespace ergotic::physics {
namespace {

/// Position of a link's end at the start, in a scalar section, m.
double beginningOf(const scene::Scene& scene, int mat) {
  const auto point =
      std::find_if(scene.connections.begin(), scene.connections.end(),
                   [mat](const scene::Connection& connection) { return connection.mat == mat; });
  if (point == scene.connections.end()) {
    return scene.mats[at(mat)].position.x();
  }
  const scene::GridPlace around = placeOf(scene, *point);
  double x = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(around.count); ++i) {
    x += around.weights[i] * scene.mats[at(around.mats[i])].position.x();
  }
  return x;
}

bool isScalar(const scene::Scene& scene, int mat) {
  return scene.sectionOf(scene.mats[at(mat)]).geometry == scene::Geometry::kScalar;
}

void warnOfTouchAtStart(const scene::Scene& scene, std::vector<std::string>& warnings) {
  for (const scene::Lia& lia : scene.lias) {
    if (lia.type != scene::LiaType::kPluck || !isScalar(scene, lia.a) || !isScalar(scene, lia.b)) {
      continue;
    }
    const double width = scene.valueOf(lia.law->width);
    const double apart = beginningOf(scene, lia.a) - beginningOf(scene, lia.b) - lia.rest_length;
    if (std::abs(apart) >= width) {
      continue;
    }
    warnings.push_back(
        scene::textOf(scene, lia.place) + ": warning: link '" + std::string(lia.name) +
        "' plucks as soon as the scene starts, before anybody plays: its ends are " +
        shortly(1e3 * std::abs(apart)) + " mm apart, and it holds within its width of " +
        shortly(1e3 * width) + " mm. Let the plectrum rest at least that far away");
  }
}

bool startsAtRest(const scene::Mat& mat) {
  return mat.position.x() == mat.rest.x() && mat.push->velocity.isZero() &&
         mat.push->force.isZero() && mat.push->first_force.isZero();
}

/// Whether anything may move, now or later. In a plane or in space forces may hold each other up in
/// more ways than are looked at here.
bool canBeExcited(const scene::Scene& scene) {
  return !scene.ports.empty() || !scene.inputs.empty() ||
         std::any_of(scene.sections.begin(), scene.sections.end(),
                     [](const scene::Section& section) {
                       return section.geometry != scene::Geometry::kScalar ||
                              !section.gravity.isZero();
                     }) ||
         std::any_of(scene.lias.begin(), scene.lias.end(),
                     [](const scene::Lia& lia) { return lia.rest_length != 0.0; }) ||
         !std::all_of(scene.mats.begin(), scene.mats.end(), startsAtRest);
}

}  // namespace

void warnAboutPlaying(const scene::Scene& scene, std::vector<std::string>& warnings) {
  warnOfTouchAtStart(scene, warnings);
  if (!canBeExcited(scene)) {
    warnings.push_back(scene.file +
                       ": warning: nothing can set this scene into motion: it has no ports, agents "
                       "or inputs, and starts at rest. Give a module 'v', or a slice a port");
  }
}

}  // namespace ergotic::physics
