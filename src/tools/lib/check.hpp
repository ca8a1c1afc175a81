// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/lib/check_advice.hpp"
#include "tools/lib/check_modes.hpp"
#include "tools/lib/check_reach.hpp"
#include "tools/lib/check_report.hpp"
#include "tools/lib/options.hpp"

namespace ergotic::tools {

/// Options of `check`.
struct CheckOptions {
  SceneOptions scene;
  CompileChoice compile;
  std::string end_effectors;  ///< file; empty: ports move with their own slices
  DeviceChoice device;
  bool ranges = false;  ///< judge the ranges of large scenes, too
  bool json = false;
  bool verbose = false;         ///< print the whole report, not only the brief one
  std::string target;           ///< empty: nothing is proposed
  std::string filter_response;  ///< empty: not written
  std::string explain;          ///< a name; empty: all of the scene is checked
  ModesChoice modes;
  AdviceChoice advice;
  ReachChoice reach;
  bool truths = false;  ///< measure what the scene claims, and nothing else
};

void addOptions(CLI::App& app, CheckOptions& options);

/// Says on stdout what a scene is made of, whether it is stable, and what it costs.
/// \return kSuccess, kRefused if it is unstable, or kFailure if a slice meets too much
/// \throws TextError, Exception
int check(const CheckOptions& options);

}  // namespace ergotic::tools
