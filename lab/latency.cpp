// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/latency.hpp"

int main(int argc, char** argv) {
  return ergotic::tools::runTool(
      "latency", "Plays a scene in real time with a virtual device, and says what each tick cost.",
      argc, argv, ergotic::tools::latency);
}
