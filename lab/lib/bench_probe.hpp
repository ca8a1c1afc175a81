// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ergotic/physics/options.hpp"

namespace ergotic::tools {

/// A place where data lies, and how fast it can be changed there.
struct MemoryLevel {
  std::string name;        ///< L1, L2, L3, memory
  std::size_t bytes = 0;   ///< that it holds; of memory 0, as much as there is
  double gb_per_s = 0.0;   ///< read and written, added
  std::size_t probed = 0;  ///< bytes it was measured with
};

/// What one core can do at most, measured now.
struct MachineLimits {
  std::vector<MemoryLevel> levels;  ///< from the fastest on
  double gflops = 0.0;              ///< additions and multiplications, half of each, unfused
  const MemoryLevel& levelFor(std::size_t bytes) const;  ///< the first that holds them
};

/// Measures with vectors of the width of `isa`, for a few tenths of a second. Realtime: no
MachineLimits probeMachine(rt::Isa isa, physics::Precision precision);

/// CPU time of the calling thread, ns.
double threadCpuNs() noexcept;

}  // namespace ergotic::tools
