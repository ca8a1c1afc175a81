// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scene/generate/body.hpp"

namespace ergotic::scene {

enum class BarEnd { kFree, kHinged, kClamped };

/// How thick a bar is from place to place, which tunes its partials to one another:
/// t(u) = 1 - a (1 + cos pi u)/2 - b (1 - cos 2 pi u)/2, u = -1...1 from end to end.
struct BarProfile {
  double a = 0.0;
  double b = 0.0;
  /// Thickness at the position of one of the masses, relative to the ends.
  double at(int index, int masses) const;
};

/// The profile with which a free bar has partials 2 and 3 in these ratios to the first, as the
/// modes of that many masses: Newton's method. \param ratios  one (b is 0) or two \return NaN in it
/// if there is none that is nowhere thinner than a tenth
BarProfile tunedProfile(int masses, const std::vector<double>& ratios);

/// A bar: masses `name.0` ..., beyond hinged ends one ground, beyond clamped ones two, in a row
/// with a bend around each mass that has two neighbours, `name.bend.0` ...; where two decays are
/// asked for also dampers `name.link.0` ... from each module to the next. A grid of one row.
struct BarSpec {
  std::string name;
  int section = 0;
  int masses = 3;
  double mass = 1.0;  ///< of the whole, kg
  std::array<BarEnd, 2> ends{BarEnd::kFree, BarEnd::kFree};
  std::vector<double> ratios;  ///< of partials 2 and 3 of a free one to the first; or none
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< rest of the first module, m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< of the last
  BodyWish wish;
  Place place;
};

/// Makes a bar of free ends as thick as its `ratios` want: its masses, bends and dampers.
/// \param step  h: so that these are the ratios of what sounds, not of w; 0: of w. In seconds
/// \param pitch_hz  of the first partial
/// \return false if there is none, see `tunedProfile`; nothing is changed then
bool shapeBar(Scene& scene, const Tuning& body, double pitch_hz, double step);

/// Appends the bar. \throws TextError if a name is taken, or as `finishBody`
void addBar(SceneBuilder& builder, const BarSpec& spec);

}  // namespace ergotic::scene
