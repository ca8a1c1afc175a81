// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;  // its header takes seconds to compile
class Option;
}  // namespace CLI

/// Files that are shipped with the tools, in a devel as in an install space.
namespace ergotic::tools {

/// The folder of the program that runs. \throws Exception if the system does not say
std::string programFolder();

/// Finds a scene file: `asked` itself, or, if that is no file, the shipped instrument of that name,
/// as `guitar`.
std::string sceneFile(const std::string& asked);

/// Adds the scene, as a file or as the name of a shipped instrument.
CLI::Option* addScene(CLI::App& app, std::string& scene);

}  // namespace ergotic::tools
