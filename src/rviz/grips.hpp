// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <ergotic/HandTargets.h>

namespace ergotic::panel {

/// A grip that a player can choose, with the figures of docs/tgr.md, A player's hand.
struct Grip {
  const char* name;
  std::uint8_t number;  ///< constant of HandTargets
  double stiffness;     ///< N/m
  double most_n;        ///< the greatest force, N
};
constexpr std::array<Grip, 3> kGrips = {{{"soft", HandTargets::SOFT, 500.0, 5.0},
                                         {"firm", HandTargets::FIRM, 1500.0, 10.0},
                                         {"quick", HandTargets::QUICK, 3000.0, 20.0}}};

}  // namespace ergotic::panel
