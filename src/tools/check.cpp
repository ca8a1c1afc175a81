// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check.hpp"

int main(int argc, char** argv) {
  CLI::App app("Says what a scene is made of, whether it is stable, and what it costs.", "check");
  ergotic::tools::CheckOptions options;
  ergotic::tools::addOptions(app, options);
  return ergotic::tools::runTool(app, argc, argv, [&] { return ergotic::tools::check(options); });
}
