// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/value.hpp"

namespace ergotic::scene {

/// A generated body that asks for a pitch: `settle` scales its links and losses to what it asks for
/// at the rate at which it is stepped, and leaves none of these.
struct Tuning {
  /// A mode of unit modal mass: its stiffness and damping by the links as they are written.
  struct Mode {
    double springs = 0.0;  ///< 1/time_unit^2, of the stiffness of two-ended links
    double bends = 0.0;    ///< 1/time_unit^2, of bends
    double dampers = 0.0;  ///< 1/time_unit, of the damping of links
  };
  struct Decay {
    int mode = 0;      ///< index in `modes`
    double t60_s = 0;  ///< time in which it falls by 60 dB
  };
  std::string name;
  int first_mat = 0;
  int mats = 0;
  int first_lia = 0;
  int lias = 0;  ///< the springs of its bends among them
  int first_bend = 0;
  int bends = 0;
  std::vector<Mode> modes;   ///< the lowest that are no motion as a whole, by frequency
  Mode top;                  ///< the highest: whether it can be stepped
  int rigid = 0;             ///< how many of its motions bend nothing; not among `modes`
  double pitch_hz = 0.0;     ///< wanted
  int pitch_mode = 0;        ///< index in `modes` of what sounds at it
  bool keeps_pitch = false;  ///< on what it ends on, too: `settle` tunes both together
  /// B of strings, f_j = j f_1 sqrt((1 + B j^2)/(1 + B)): springs and bends are scaled apart;
  /// negative: alike.
  double inharmonicity = -1.0;
  /// Ratios of partials 2 and 3 of a free bar to the first, set by its thickness along it; or none.
  std::vector<double> ratios;
  /// Decays that are asked for. None: no loss; one: of all modes alike; two: by dampers of links,
  /// too.
  std::vector<Decay> decays;
  Place place;
};

}  // namespace ergotic::scene
