// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check.hpp"

int main(int argc, char** argv) {
  return ergotic::tools::runTool(
      "check", "Says what a scene is made of, whether it is stable, and what it costs.", argc, argv,
      ergotic::tools::check);
}
