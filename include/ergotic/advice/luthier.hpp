// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ergotic/advice/modes.hpp"
#include "ergotic/physics/certificate/certify.hpp"

namespace ergotic::physics {

/// Influence of a link that is no part of a body on the body's mode.
struct Influence {
  std::string link;
  double cents = 0.0;    ///< change of the pitch, to first order; below 0: down
  double of_loss = 0.0;  ///< share of the mode's losses, 0...1
};

/// Pitch and decay of a body in the whole scene, compared with those that the scene asks for.
struct HeardBody {
  std::string name;
  double asked_hz = 0.0;
  double hz = 0.0;
  double cents = 0.0;  ///< deviation from the pitch that is asked for
  double t60_s = 0.0;  ///< infinite without losses
  /// Audible influences: half a cent, or a tenth of the loss; the largest first.
  std::vector<Influence> influences;
};

struct HeardBodies {
  std::vector<HeardBody> bodies;
  std::vector<AskedPitch> missing;  ///< bodies without a mode within a semitone
};

/// \return the bodies that ask for a pitch, by the partial that they ask it of
/// \param scene  not settled
/// \throws Exception as `settle` and `modesOf`
/// Realtime: no. Cost: as `modesOf`
/// Source: first-order perturbation of w^2 = x'Kx/x'Mx, Rayleigh 1877, section 90
HeardBodies listenTo(const scene::Scene& scene, const Rates& rates);

/// A figure that a maker wants of a scene.
struct Wish {
  enum class Kind { kPitch, kDecay, kMargin };
  Kind kind = Kind::kPitch;
  std::string body;    ///< body, of pitch and decay
  double value = 0.0;  ///< Hz, s of T60, or the margin of the certificate
};

/// Effect of one parameter on a wish, the others as they are.
struct Move {
  std::string parameter;
  std::optional<double> to;  ///< value for which the wish comes true; none within its range
  double lowest = 0.0;       ///< lowest figure over the range
  double highest = 0.0;
};

/// \return of the parameters that change the figure; a value is exact to 1e-6 of the figure
/// \param scene  not settled
/// \throws Exception if no body has the name, or the scene cannot be settled as it is
/// Realtime: no. Cost: some ten times `modesOf` or `certify` for each parameter
std::vector<Move> movesFor(const Wish& wish,
                           const scene::Scene& scene,
                           const Rates& rates,
                           const DeviceTraits& device = {});

}  // namespace ergotic::physics
