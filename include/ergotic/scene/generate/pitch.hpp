// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// A mode that is stepped explicitly moves as lambda^n with
/// lambda^2 - (2 - kappa - zeta) lambda + (1 - zeta) = 0: by how much it turns in a step.
/// \return arg(lambda), rad; NaN if it does not oscillate (overdamped, unstable, no stiffness)
double modeAngle(double kappa, double zeta);

/// The kappa with which a mode turns by `angle`: (1 - rho)^2 + 4 rho sin^2(angle/2) with
/// rho^2 = 1 - zeta. \return NaN if no kappa does
/// \param angle  rad, above 0 and below pi
double modeKappa(double angle, double zeta);

/// 4 sin^2(j pi/(2(N+1))): the stiffness of mode j = 1...N of N masses in a row, in units of that
/// of a link.
double stringEigenvalue(int masses, int mode);

/// Part of its velocity that a generated string loses in a step.
struct StringLoss {
  double ground = 0.0;  ///< loss of each mass, by its own and by the medium
  double link = 0.0;    ///< h Z/M of each link; 0 for the motion across a stretched string

  /// zeta of mode j = 1...N of N masses.
  double ofMode(int masses, int mode) const {
    return ground + stringEigenvalue(masses, mode) * link;
  }
};

/// \param rate_hz  rate at which the string's section is stepped, > 0; as in what follows
StringLoss stringLoss(const Scene& scene, const StringInfo& string, double rate_hz);

/// h^2 K/M of the links of a generated string.
double stringKappa(const Scene& scene, const StringInfo& string, double rate_hz);

/// h Z/M of the links of a generated string.
double stringZeta(const Scene& scene, const StringInfo& string, double rate_hz);

constexpr double kStiffestInTune = 0.25;  ///< r h^2 K/M of energy-stable links

/// False if the string moves lengthwise and is flat, by up to some hundred cents: above
/// r h^2 K/M = 1/4 energy-stable links look ahead to stay stable, which takes from what they hold
/// (docs/physics/schemes.md, "Energy-stable links").
bool holdsPitch(const Scene& scene, const StringInfo& string, double rate_hz);

/// Fundamental of a generated string as it sounds, closed form, with the parameters at their
/// present values.
///
/// With N moving masses M, links (K, Z), loss and medium Y to the ground and step h, the lowest
/// mode has s = 4 sin^2(pi/(2(N+1))), kappa = s K h^2/M, zeta = s Z h/M + l with
/// l = 1 - e^(-Y h/M), or l = Y h/M where the masses are cells that are not matched.
/// In a plane and in space this is the motion across the string at small amplitudes: kappa is then
/// (1 - r) s K h^2/M with r the rest length of a link over its length, and zeta is l alone, because
/// dampers act along the string.
/// \return arg(lambda)/(2 pi h), Hz; NaN if the mode does not oscillate, if the string is coarse
///         and not yet fitted, or does not hold its pitch
/// Realtime: no. Thread: any.
double stringPitchHz(const Scene& scene, const StringInfo& string, double rate_hz);

/// Stiffness of the links with which an ordinary string sounds at its `frequency_hz`: the above,
/// solved for K. It follows the mass, so that the pitch stays; damping counts as it is now.
/// \return NaN if it has none: it loses all of its velocity in a step
Value tunedStiffness(const Scene& scene, const StringInfo& string, double rate_hz);

}  // namespace ergotic::scene
