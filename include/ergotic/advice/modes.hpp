// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Range of the wanted modes of a scene.
struct ModeWindow {
  double from_hz = 0.0;  ///< 0: from the lowest on, rigid-body motions included
  double to_hz = std::numeric_limits<double>::infinity();
  int most = 20;  ///< largest number, lowest modes first, >= 1
};

constexpr int kMaxModes = 2000;  ///< largest number that can be asked for

/// Share of a link in a mode, 0...1.
struct LinkShare {
  int lia = -1;          ///< index in Scene::lias, or
  int bend = -1;         ///< in Scene::bends; both -1: springs and losses of the modules themselves
  double of_pull = 0.0;  ///< potential energy: without it the pitch were lower by half of that
  double of_loss = 0.0;  ///< share of the mode's losses
};

/// A mode of the linear(ised) scene, as it is stepped.
struct SceneMode {
  enum class Kind {
    kRings,    ///< swings, and decays or not
    kCreeps,   ///< comes back without swinging
    kUnstable  ///< grows
  };
  Kind kind = Kind::kRings;
  double frequency_hz = 0.0;  ///< 0 where it does not swing
  double t60_s = 0.0;         ///< infinite without losses; negative where it grows
  /// Bound of the relative error of frequency and decay that is left, to first order; 0: rounding.
  double error = 0.0;
  int rate_divisor = 1;  ///< audio frames in a step of its sections
  std::string peak;      ///< the module that swings most, by its kinetic energy
  /// Displacement there in a mode of unit modal mass, 1/sqrt(kg); of force outputs the force for
  /// it, N/(m sqrt(kg)). [Scene::outputs], without their gains.
  std::vector<double> at_outputs;
  std::vector<double> at_points;  ///< the same at SceneModes::points
  std::vector<LinkShare> links;   ///< links with at least a thousandth of either
  std::vector<double> in_asked;   ///< [SceneModes::asked] its kinetic energy in that body, 0...1
  int asked = -1;                 ///< index in SceneModes::asked
  double cents = 0.0;             ///< deviation from that pitch
};

/// Pitch that the scene asks of a body.
struct AskedPitch {
  std::string body;
  int partial = 1;
  double hz = 0.0;
  bool is_found = false;  ///< some mode of the window sounds within a semitone of it
};

/// Free motions of a section that nothing holds: they have no frequency.
struct RigidMotions {
  std::string section;
  int count = 0;
};

struct SceneModes {
  std::vector<SceneMode> modes;  ///< by frequency
  /// Number of all modes in the window, without rigid-body motions: by Sylvester's law of inertia.
  int counted = 0;
  bool is_certain = true;  ///< the counts are beyond the rounding of their factors
  std::vector<RigidMotions> rigid;
  std::vector<std::string> points;  ///< points between modules that links or hands act on
  std::vector<AskedPitch> asked;
  std::vector<std::string> notes;  ///< parts of the scene that are not covered
};

/// The modes of a scene about the places where its modules rest: its linear links, and the linear
/// part of others, at the present values of its parameters. Contacts and what else may let go are
/// open, slices, driven modules and modules of sections of another rate are held. Exact for the
/// equations of a step: eigenvalues of M^-1/2 K M^-1/2 to rounding, poles with their losses by the
/// quadratic problem where these do not share the modes.
/// \param scene  settled
/// \param asked  the same before it was settled, which says what was asked for
/// \throws Exception if an eigenvalue problem is not solved
/// Realtime: no. Cost: parts of up to some hundred coordinates O(n^3), larger ones some
/// factorizations of their matrix and 2 `most` solutions
/// Source: docs/physics/elements.md, "One step"; Ericsson and Ruhe 1980 (shift and invert)
SceneModes modesOf(const scene::Scene& scene,
                   const Rates& rates,
                   const ModeWindow& window,
                   const scene::Scene& asked);

}  // namespace ergotic::physics
