// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Limits beyond which an explicit link is inaccurate, with h the step of the link, slopes and
/// masses at the worst ends of their ranges: the certificate warns of them, `scheme: auto` decides
/// by them.
constexpr double kExplicitFriction = 1.0;  ///< h max F' (1/Ma + 1/Mb), from here on energy-stable
constexpr double kExplicitFalling = 0.2;   ///< h max(-F') (1/Ma + 1/Mb), from here on energy-stable

}  // namespace ergotic::physics
