// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/bench.hpp"

int main(int argc, char** argv) {
  CLI::App app("Measures what scenes cost on this machine, beside a plain implementation.",
               "bench");
  ergotic::tools::BenchOptions options;
  ergotic::tools::addOptions(app, options);
  return ergotic::tools::runTool(app, argc, argv, [&] { return ergotic::tools::bench(options); });
}
