// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lab/lib/bench_measure.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// Says on stdout what is measured on which machine, and begins a Markdown table.
void printHead(const BenchSettings& settings, const MachineLimits& limits);
void printRow(const BenchResult& result, const MachineLimits& limits);

/// Everything, for programs.
Json reportOf(const BenchSettings& settings,
              const MachineLimits& limits,
              const std::vector<BenchResult>& results);

}  // namespace ergotic::tools
