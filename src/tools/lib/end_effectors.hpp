// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/station/judge_hands.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// \param file  path; empty: none
/// \throws TextError from the file, Exception if it cannot be read
tgr::EndEffectors readEndEffectors(const std::string& file);

/// Reports the load of each slice by a scene through end-effectors.
Json slicesReport(const tgr::EndEffectors& end_effectors,
                  const std::vector<station::SliceLoad>& slices);

}  // namespace ergotic::tools
