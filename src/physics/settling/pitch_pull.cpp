// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/pitch_pull.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "physics/note.hpp"

namespace ergotic::physics {
namespace {

constexpr double kAudibleCents = 3.0;

/// How far from its line a string is held at the start, over its length.
double pluckOf(const scene::Scene& scene, const scene::StringInfo& string, double length) {
  double height = 0.0;
  for (int m = string.first; m < string.first + string.count; ++m) {
    const scene::Mat& mat = scene.mats[at(m)];
    height = std::max(height, (mat.position - mat.rest).norm());
  }
  return height / length;
}

std::string noteOnPitch(const scene::Scene& scene, const scene::StringInfo& string) {
  const scene::Mat& first = scene.mats[at(string.first)];
  const scene::Mat& last = scene.mats[at(string.first + string.count - 1)];
  const double length = (last.rest - first.rest).norm();
  const double slack = string.rest_length_ratio;
  std::string text = noteAt(scene, first.place) + "string '" + string.name + "' ";
  if (!(slack < 1.0)) {
    return text + "is not stretched: its links are at rest";
  }
  text += "sounds " + shortly(pitchPullCents(slack, 0.001)) +
          " cents higher at an amplitude of 0.1 % of its length, " +
          shortly(pitchPullCents(slack, 0.01)) + " at 1 %";
  double judged = pitchPullCents(slack, 0.01);
  const double pluck = pluckOf(scene, string, length);
  if (pluck > 0.0) {
    judged = pitchPullCents(slack, pluck);
    text += ", " + shortly(judged) + " as it is plucked at the start";
  }
  return judged < kAudibleCents ? text + ": geometry: scalar would hardly sound different" : text;
}

}  // namespace

double pitchPullCents(double slack, double amplitude) {
  return 1602.0 * slack / (1.0 - slack) * amplitude * amplitude;
}

std::string flatness(const scene::Scene& scene, const scene::StringInfo& string, double rate_hz) {
  const double kappa = scene::stringKappa(scene, string, rate_hz) * string.rest_length_ratio;
  return "it moves lengthwise, where its energy-stable links keep their stiffness up to r h^2 K/M "
         "= " +
         shortly(scene::kStiffestInTune) + ", and it is " + shortly(kappa) +
         ". Take scheme: explicit where that is stable, a higher rate, fewer masses or a smaller "
         "rest_length_ratio";
}

void notePitchPull(const scene::Scene& scene, std::vector<std::string>& notes) {
  for (const scene::StringInfo& string : scene.strings) {
    const scene::Geometry geometry = scene.sectionOf(scene.mats[at(string.first)]).geometry;
    if (geometry == scene::Geometry::kPlane || geometry == scene::Geometry::kSpace) {
      notes.push_back(noteOnPitch(scene, string));
    }
  }
}

}  // namespace ergotic::physics
