// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/latency.hpp"

int main(int argc, char** argv) {
  CLI::App app("Plays a scene in real time with a virtual device, and says what each tick cost.",
               "latency");
  ergotic::tools::LatencyOptions options;
  ergotic::tools::addOptions(app, options);
  return ergotic::tools::runTool(app, argc, argv, [&] { return ergotic::tools::latency(options); });
}
