// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/lib/options.hpp"

namespace ergotic::tools {

/// What `expand` is asked for.
struct ExpandOptions {
  std::string scene;
};

void addOptions(CLI::App& app, ExpandOptions& options);

/// Writes the plain text of a scene to stdout, as recordings keep it.
/// \return kSuccess
/// \throws TextError, Exception
int expand(const ExpandOptions& options);

}  // namespace ergotic::tools
