// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/render.hpp"

int main(int argc, char** argv) {
  CLI::App app("Plays a scene offline and writes what sounds.", "render");
  ergotic::tools::RenderOptions options;
  ergotic::tools::addOptions(app, options);
  return ergotic::tools::runTool(app, argc, argv, [&] { return ergotic::tools::render(options); });
}
