// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/lib/options.hpp"

namespace ergotic::tools {

/// Options of `expand`.
struct ExpandOptions {
  std::string scene;
  std::string variant;
  bool schema = false;
};

void addOptions(CLI::App& app, ExpandOptions& options);

/// Writes the plain text of a scene to stdout, as recordings keep it, and as remarks how many
/// modules its selections mean; or the schema of scene files.
/// \return kSuccess
/// \throws TextError, Exception
int expand(const ExpandOptions& options);

}  // namespace ergotic::tools
