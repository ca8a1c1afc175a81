// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/expand.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

#include "ergotic/scene/text/schema.hpp"
#include "tools/lib/shipped.hpp"

namespace ergotic::tools {

void addOptions(CLI::App& app, ExpandOptions& options) {
  addScene(app, options.scene);
  app.add_option("--variant", options.variant, "of the scene, one of its 'variants'")
      ->type_name("NAME");
  app.add_flag("--schema", options.schema,
               "write the JSON schema of scene files, for editors, and nothing else");
}

int expand(const ExpandOptions& options) {
  if (options.schema) {
    std::cout << scene::schemaOfScenes();
    return kSuccess;
  }
  if (options.scene.empty()) {
    throw CLI::ValidationError("SCENE", "needed without --schema");
  }
  SceneOptions asked;
  asked.scene = options.scene;
  asked.variant = options.variant;
  const scene::Scene scene = readScene(asked);
  std::cout << scene.text << (scene.text.empty() || scene.text.back() == '\n' ? "" : "\n");
  for (const scene::Selected& selected : scene.selections) {
    std::cout << "# " << selected.text << ": " << selected.count
              << (selected.count == 1 ? " module\n" : " modules\n");
  }
  return kSuccess;
}

}  // namespace ergotic::tools
