// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/ring.hpp"

#include <cmath>

#include "at.hpp"

namespace ergotic::scene {
namespace {

constexpr int kAround = 48;   // places of a rim: eight for a wave of six
constexpr int kLevels = 4;    // of a cone, the rim among them
constexpr double kTop = 0.5;  // of the radius, where a cone ends

double shapeAt(int waves, double angle) {
  return waves < 0 ? std::sin(-waves * angle) : std::cos(waves * angle);
}

Eigen::Vector3d placeOnRing(const Eigen::Vector3d& middle, double radius, double angle) {
  return middle + Eigen::Vector3d(0.0, radius * std::cos(angle), radius * std::sin(angle));
}

}  // namespace

void setRing(ModalSpec& spec, const RingShape& ring) {
  for (std::size_t p = 0; p < spec.places.size(); ++p) {
    const double angle =
        2.0 * M_PI * static_cast<double>(p) / static_cast<double>(spec.places.size());
    spec.seen_at.push_back(placeOnRing(spec.at, ring.radius, angle));
  }
  Outline& outline = spec.outline;
  outline.name = spec.name;
  outline.modes = static_cast<int>(spec.partials.size());
  const int levels = ring.height == 0.0 ? 1 : kLevels;
  for (int level = 0; level < levels; ++level) {
    const double up = levels > 1 ? static_cast<double>(level) / (levels - 1) : 0.0;
    const Eigen::Vector3d middle = spec.at + Eigen::Vector3d(up * ring.height, 0.0, 0.0);
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * M_PI * i / kAround;
      outline.rest.push_back(placeOnRing(middle, (1.0 - (1.0 - kTop) * up) * ring.radius, angle));
      for (const int waves : ring.waves) {
        outline.weights.push_back((1.0 - up) * shapeAt(waves, angle));
      }
      const int here = level * kAround + i;
      outline.lines.emplace_back(here, level * kAround + (i + 1) % kAround);
      if (level > 0) {
        outline.lines.emplace_back(here - kAround, here);
      }
    }
  }
}

}  // namespace ergotic::scene
