// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/attached_cases.hpp"

#include <algorithm>
#include <cmath>

#include "physics/certificate/parameter_cases.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
namespace {

constexpr int kPlaces = 5;
constexpr double kMaxWork = 2e7;  // cubes of numbers of a state
constexpr double kMaxCases = 27.0;

/// The scene without dampers along lines that turn: these do not damp motion across the lines.
scene::Scene withoutTurning(scene::Scene scene, const RatedNetwork& networks) {
  for (scene::Lia& lia : scene.lias) {
    if (networks.hasLineThatTurns(lia)) {
      lia.damping = {};
    }
  }
  return scene;
}

bool areLed(const scene::Scene& scene, scene::Connection::Way scene::Connection::*way) {
  return std::any_of(scene.connections.begin(), scene.connections.end(),
                     [&](const scene::Connection& c) { return (c.*way).guide >= 0; });
}

/// Sets a way that is led to position i of its range. \param i  of kPlaces
void putAt(int i, scene::Connection::Way& way) {
  if (way.guide >= 0) {
    way.at = {way.minimum + (way.maximum - way.minimum) * i / (kPlaces - 1)};
  }
}

/// Adds cases with the led points at positions of their ranges.
void addPlaces(const scene::Scene& scene, std::vector<scene::Scene>& cases) {
  const int along = areLed(scene, &scene::Connection::along) ? kPlaces : 1;
  const int across = areLed(scene, &scene::Connection::across) ? kPlaces : 1;
  for (int i = 0; i < along * across && along * across > 1; ++i) {
    cases.push_back(scene);
    for (scene::Connection& connection : cases.back().connections) {
      putAt(i % along, connection.along);
      putAt(i / along, connection.across);
    }
  }
}

/// Number of cases for which the slowest part, the eigenvalues, takes less than about a second.
int mostCases(int masses) {
  const double numbers = 3.0 * std::clamp(masses, 1, 100);
  return static_cast<int>(std::clamp(kMaxWork / std::pow(numbers, 3), 3.0, kMaxCases));
}

}  // namespace

std::vector<scene::Scene> casesOf(const Attached& body, const RatedNetwork& networks) {
  const scene::Scene scene = onlyOf(body, networks.scene());
  std::vector<scene::Scene> cases = parameterCases(scene, body.nodes, mostCases(body.masses));
  addPlaces(scene, cases);
  const std::size_t count = cases.size();
  const bool turns = std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return networks.hasLineThatTurns(lia) && scene::largest(scene, lia.damping) > 0.0;
  });
  for (std::size_t i = 0; turns && i < count; ++i) {
    cases.push_back(withoutTurning(cases[i], networks));
  }
  return cases;
}

}  // namespace ergotic::physics
