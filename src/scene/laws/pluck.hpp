// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shape of a pluck of stiffness K and width: its force rises up to a tenth of the width, where it
/// is largest, 0.9 K times that, and falls beyond it.
namespace ergotic::scene {

constexpr double kPluckSlope = 0.9;  ///< slope while it holds, over K
constexpr double kPluckTip = 0.1;    ///< elongation up to which it holds, over the width

}  // namespace ergotic::scene
