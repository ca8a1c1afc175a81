// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace ergotic::physics {

/// A module whose motion is a weighted sum of modes, which receive its force with the same weights.
struct ModalPoint {
  int mat = 0;                  ///< a kPoint of the played scene
  int first = 0;                ///< its first mode, a kCell of the played scene; the others follow
  double offset = 0.0;          ///< displacement where all modes are at 0, m
  std::vector<double> weights;  ///< kg^-1/2; modes have the mass 1 kg and move in m kg^1/2
};

}  // namespace ergotic::physics
