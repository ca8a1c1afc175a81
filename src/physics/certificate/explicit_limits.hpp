// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Where an explicit link may make energy, h the step of the link, slopes and masses at the worst
/// ends of their ranges: what the certificate warns of, and the rules of `scheme: auto`.
constexpr double kExplicitSwitch = 0.05;  ///< h^2 K (1/Ma + 1/Mb) of contacts and clipped springs
/// h Z (1/Ma + 1/Mb) of the same, per kappa^1.5: from here on a hit loses more than the step gives,
/// twice over (a mass that hits a wall by itself needs 0.09).
constexpr double kLossOfHit = 0.2;
constexpr double kExplicitFriction = 1.0;  ///< h max F' (1/Ma + 1/Mb), from here on guarded
constexpr double kExplicitFalling = 0.2;   ///< h max(-F') (1/Ma + 1/Mb), from here on guarded

}  // namespace ergotic::physics
