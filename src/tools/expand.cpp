// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/expand.hpp"

int main(int argc, char** argv) {
  return ergotic::tools::runTool("expand", "Writes a brief scene out as what is played.", argc,
                                 argv, ergotic::tools::expand);
}
