// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/text/read_truths.hpp"

namespace ergotic::tools {

/// Result of a truth.
struct JudgedTruth {
  bool holds = false;
  std::vector<double> measured;  ///< as many as expected, or one; none: see `trouble`
  double off = 0.0;              ///< largest deviation, in the measure of its tolerance
  std::string trouble;           ///< reason why it could not be measured
};

/// Plays a scene as its truths say and measures what they claim; truths that are played alike share
/// one run.
/// Realtime: no. Cost: some seconds of sound for each way of playing
std::vector<JudgedTruth> judgeTruths(const scene::ClaimingScene& claims,
                                     const physics::Rates& rates,
                                     const physics::CompileOptions& options);

/// Expected values of the measured numbers; bounds have none.
std::vector<double> expectedOf(const scene::Truth& truth);

/// Prints a line for each truth, or JSON. \return true if all hold
bool tellTruths(const scene::ClaimingScene& claims,
                const std::vector<JudgedTruth>& judged,
                bool json);

}  // namespace ergotic::tools
