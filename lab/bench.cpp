// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench.hpp"

int main(int argc, char** argv) {
  return ergotic::tools::runTool(
      "bench", "Measures what scenes cost on this machine, beside a plain implementation.", argc,
      argv, ergotic::tools::bench);
}
