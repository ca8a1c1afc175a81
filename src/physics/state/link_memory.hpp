// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace ergotic::physics {

/// Energy that the links of a run have taken and given since the start, in the scene's unit.
struct LinkWork {
  double initial = 0.0;     ///< stored at the start
  double stored = 0.0;      ///< since then, by elastic forces; of springs it follows from positions
  double dissipated = 0.0;  ///< energy lost by viscous forces
  double on_a = 0.0;        ///< done on the modules of side a; links between sections only
  double on_b = 0.0;
  double made = 0.0;  ///< by holding the slower end and averaging its force; across rates only

  static constexpr std::size_t kDoubles = 6;  ///< see numbersOf
};

/// Forces that a run with memory keeps for each link and coordinate: [coordinates][links].
/// Unmetered, runs inside one section have no memory.
template <class Real>
struct LinkMemory {
  Real* elastic = nullptr;  ///< force of the last step
  Real* viscous = nullptr;
  // Runs across rates only: means over the step of the slower end, so far and of the last.
  Real* mean = nullptr;
  Real* last_mean = nullptr;
  Real* mean_viscous = nullptr;
  Real* last_mean_viscous = nullptr;
};

}  // namespace ergotic::physics
