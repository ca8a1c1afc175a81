// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// h^2 K/M of the links of a generated string.
/// \param rate_hz  rate at which the string's section is stepped, > 0
double stringKappa(const Scene& scene, const StringInfo& string, double rate_hz);

/// False if the string is flat, by up to some hundred cents: above h^2 K/M = 1/4 guarded links look
/// ahead to stay stable, which takes from the tension that they hold (docs/physics.md, "Guarded
/// links"). Arguments as above.
bool holdsPitch(const Scene& scene, const StringInfo& string, double rate_hz);

/// Fundamental of a generated string as it sounds, closed form, with the parameters at their
/// present values.
///
/// With N moving masses M, links (K, Z), loss and medium Y to the ground and step h, the lowest
/// mode has s = 4 sin^2(pi/(2(N+1))), kappa = s K h^2/M, zeta = s Z h/M + l with
/// l = 1 - e^(-Y h/M), or l = Y h/M where the masses are cells that are not matched, and moves as
/// lambda^n with lambda^2 - (2 - kappa - zeta) lambda + (1 - zeta) = 0.
/// In a plane and in space this is the motion across the string at small amplitudes: kappa is then
/// (1 - r) s K h^2/M with r the rest length of a link over its length, and zeta is l alone, because
/// dampers act along the string.
/// \param rate_hz  rate at which the string's section is stepped, > 0
/// \return         arg(lambda)/(2 pi h), Hz; NaN if the mode does not oscillate (overdamped,
///                 unstable, no tension), if the string is coarse and not yet fitted, or does
///                 not hold its pitch
/// Realtime: no. Thread: any.
double stringPitchHz(const Scene& scene, const StringInfo& string, double rate_hz);

}  // namespace ergotic::scene
