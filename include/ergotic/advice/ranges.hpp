// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"

namespace ergotic::physics {

/// What a parameter's range means for the verdict, the other ranges as they are.
struct JudgedRange {
  /// The end of its range that decides, alone nearer to the limit than the other; kNone: both
  /// alike.
  enum class End { kNone, kMinimum, kMaximum };
  std::string name;
  End decides = End::kNone;
  /// True if some range around its present value is certified.
  bool holds = false;
  /// The largest such range, each end by itself and to a thousandth; infinite where nothing ends
  /// it. What may stand there at all (a mass above 0) ends it, too.
  double lowest = 0.0;
  double highest = 0.0;
};

/// For every parameter of a scene. Certified is what is no worse than the scene as it is, or, if
/// that is unproven, than *bounded*.
/// \param scene  not settled: its schemes and rates follow its ranges
/// Realtime: no. Cost: some hundred times `settle` and `certify` for each parameter.
std::vector<JudgedRange> judgeRanges(const scene::Scene& scene,
                                     const Rates& rates,
                                     const DeviceTraits& device = {});

}  // namespace ergotic::physics
