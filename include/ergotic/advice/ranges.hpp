// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"

namespace ergotic::physics {

/// Effect of a parameter's range on the verdict, the other ranges as they are.
struct JudgedRange {
  /// The end of its range that decides, alone nearer to the limit than the other; kNone: both
  /// alike.
  enum class End { kNone, kMinimum, kMaximum };
  std::string name;
  End decides = End::kNone;
  /// True if some range around its present value is certified.
  bool holds = false;
  /// Largest such range, each end by itself and to a thousandth; infinite if there is no limit. The
  /// permitted values (a mass above 0) limit it, too.
  double lowest = 0.0;
  double highest = 0.0;
};

/// Judges the range of every parameter of a scene. A range is certified if it is no worse than the
/// scene as it is, or, if that is unproven, than *bounded*.
/// \param scene  not settled: its schemes and rates follow its ranges
/// Realtime: no. Cost: some hundred times `settle` and `certify` for each parameter.
std::vector<JudgedRange> judgeRanges(const scene::Scene& scene,
                                     const Rates& rates,
                                     const DeviceTraits& device = {});

}  // namespace ergotic::physics
