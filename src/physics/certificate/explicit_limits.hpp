// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Where an explicit link is inaccurate, h the step of the link, slopes and masses at the worst
/// ends of their ranges: what the certificate warns of, and the rules of `scheme: auto`.
constexpr double kExplicitFriction = 1.0;  ///< h max F' (1/Ma + 1/Mb), from here on guarded
constexpr double kExplicitFalling = 0.2;   ///< h max(-F') (1/Ma + 1/Mb), from here on guarded

}  // namespace ergotic::physics
