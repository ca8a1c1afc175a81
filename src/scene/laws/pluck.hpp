// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What a pluck is, of its stiffness K and width: its force rises up to a tenth of the width, where
/// it is largest, 0.9 K times that, and falls beyond it.
namespace ergotic::scene {

constexpr double kPluckSlope = 0.9;  ///< of K, while it holds
constexpr double kPluckTip = 0.1;    ///< of the width, up to where it does

}  // namespace ergotic::scene
