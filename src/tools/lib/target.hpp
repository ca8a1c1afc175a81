// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/advice/target.hpp"
#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// Freedom of a proposal: rates and precision that the command line names are kept.
physics::Freedom freedomOf(const SceneOptions& options, const CompileChoice& compile);

/// Reports the proposal and its reasons, with the cost of both versions on this machine.
Json targetReport(const scene::Scene& scene,
                  const physics::Rates& rates,
                  const physics::CompileOptions& options,
                  const std::string& target,
                  const physics::Freedom& freedom);

/// Describes a proposal in a few lines, without costs that have to be measured.
std::vector<std::string> targetLines(const physics::Target& target,
                                     const physics::Proposal& proposal);

}  // namespace ergotic::tools
