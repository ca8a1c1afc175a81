// SPDX-License-Identifier: BSD-3-Clause
// Written by make_reference.py; see there for the model.
#pragma once

namespace ergotic::physics::reference {

struct BowPeriod {
  double steepness;  ///< a, s^2/m^2
  double period_s;
};
constexpr BowPeriod kBowPeriods[] = {
    {100.0, 6.9916005906e-03},
    {1000.0, 6.7115257564e-03},
    {10000.0, 6.5355950671e-03},
};

}  // namespace ergotic::physics::reference
