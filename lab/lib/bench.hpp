// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lab/lib/bench_measure.hpp"
#include "tools/lib/options.hpp"

namespace ergotic::tools {

/// What `bench` is asked for.
struct BenchOptions {
  std::vector<std::string> scenes;  ///< names; empty: all
  std::vector<int> sizes;           ///< modules; empty: what each scene is made for, and 200,000
  CompileChoice compile;
  bool metered = true;
  int runs = 5;
  double seconds = 0.5;
  std::string json;  ///< path; empty: not written
  bool list = false;
};

void addOptions(CLI::App& app, BenchOptions& options);

/// Prints a table of what scenes cost beside the plain implementation.
/// \throws Exception if a scene or an instruction set does not exist, or the file cannot be written
int bench(const BenchOptions& options);

}  // namespace ergotic::tools
