// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/expand.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

namespace ergotic::tools {

void addOptions(CLI::App& app, ExpandOptions& options) {
  app.add_option("scene", options.scene, "scene file, .yaml or .mdl")
      ->type_name("SCENE")
      ->required();
}

int expand(const ExpandOptions& options) {
  SceneOptions asked;
  asked.scene = options.scene;
  std::cout << readScene(asked).text;
  return kSuccess;
}

}  // namespace ergotic::tools
