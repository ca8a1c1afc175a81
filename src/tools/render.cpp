// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/render.hpp"

int main(int argc, char** argv) {
  return ergotic::tools::runTool("render", "Plays a scene offline and writes what sounds.", argc,
                                 argv, ergotic::tools::render);
}
