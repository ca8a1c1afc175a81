// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// What a musician wants to know of a scene, in about ten lines: whether it is stable, its pitches,
/// hands, outputs and parameters, what it costs here, and every warning.
/// \param report  the whole report of `check`
void printBrief(const Json& report, std::ostream& out);

}  // namespace ergotic::tools
