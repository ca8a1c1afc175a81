// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/scene/value.hpp"

namespace ergotic::scene {

/// A claim of a scene about itself: how it is played, what is measured, and what must result. Only
/// `check --truths` measures it; what plays does not depend on it. SI units.
struct Truth {
  enum class What {
    kPitch,          ///< frequency of the line next to `near`, Hz
    kPartials,       ///< frequencies of the lines next to those of a stiff string, of these
    kRatios,         ///< frequencies of lines, of the first of them
    kT60,            ///< decay by 60 dB of the sound, or of the line next to `near`, s
    kHarmonicsLeft,  ///< loudest partial that `divisor` divides, over the loudest of the others
    kContact,        ///< longest duration, s, or largest force, N, of a contact
    kBeats,          ///< distance of the two lines next to `near`, Hz
    kDoubleDecay,    ///< T60 of the two decays next to `near`, the faster first, s
    kForce,          ///< force on a hand at a port that moves there and back
    kCentroid,       ///< centroid of the spectrum at a time, Hz, or at a later time over that
    kGlide,          ///< frequency of the line next to `near`, at a later time over an earlier one
    kSilence,        ///< level from some time on, of the highest
    kEnergy          ///< residual of the balance, of what was stored most
  };
  /// Figures of kContact: kDuration, kPeak; of kForce: all but kDuration.
  enum class Figure { kDuration, kPeak, kRelease, kStiffness, kWork };
  enum class Play {
    kStart,   ///< as the scene begins by itself
    kTap,     ///< a raised cosine of force
    kPluck,   ///< a force that rises, and is taken away at once
    kGesture  ///< the hand of a file
  };
  /// kRelative: a share of what is expected.
  enum class Tolerance { kAbsolute, kRelative, kCents, kDecibels };

  What what = What::kPitch;
  Figure figure = Figure::kDuration;

  Play play = Play::kStart;
  /// Modules that are tapped or plucked together, and how much of the force each gets.
  std::vector<std::pair<int, double>> struck;
  int axis = 0;           ///< axis of the force
  double force = 0.0;     ///< N
  double time_s = 0.0;    ///< time in which the force rises and, of a tap, falls
  std::string gesture{};  ///< file beside the scene

  int output = -1;  ///< index in Scene::outputs
  int lia = -1;     ///< index in Scene::lias
  int port = -1;    ///< index in Scene::ports

  double near_hz = 0.0;  ///< frequency to look at; for ratios, of the first partial; 0: none
  double inharmonicity = 0.0;
  int partials = 0;             ///< how many
  int divisor = 0;              ///< divisor of kHarmonicsLeft
  double speed = 0.0;           ///< of kForce, m/s at the device
  double travel = 0.0;          ///< of kForce, m at the device
  double after_s = 0.0;         ///< when measuring begins, s after a tap or pluck is over
  double seconds = 0.0;         ///< duration of the measurement; 0: as long as it needs
  std::vector<double> times_s;  ///< kCentroid: one or two; kGlide: two; counted as `after_s`

  /// Expected values and how far off they may be; or bounds alone.
  std::vector<double> expected;
  double within = 0.0;
  Tolerance tolerance = Tolerance::kAbsolute;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  std::string source;  ///< source of the expected values
  Place place;
};

/// The word for it in scenes, as in `harmonics_left`.
const char* wordOf(Truth::What what);
/// Unit of the measured quantity, as in Limits: `Hz`, `s`, `N`, `N/m`, `J`; empty: a ratio.
const char* unitOf(const Truth& truth);

}  // namespace ergotic::scene
