// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/shipped.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"

namespace ergotic::tools {
namespace {

/// Folders between the programs and what has the models: an install space with lib/ergotic, the
/// sources with devel/lib/ergotic, or with a build in a folder such as build/asan before that.
constexpr int kMostFoldersUp = 5;

}  // namespace

std::string programFolder() {
  std::array<char, PATH_MAX> self{};
  if (readlink("/proc/self/exe", self.data(), self.size() - 1) <= 0) {
    throw Exception(std::string("/proc/self/exe: ") + std::strerror(errno));
  }
  const std::string program = self.data();
  return program.substr(0, program.rfind('/'));
}

std::string sceneFile(const std::string& asked) {
  std::error_code failure;
  const bool is_name = !asked.empty() && asked.find_first_of("/.") == std::string::npos;
  if (!is_name || std::filesystem::exists(asked, failure)) {
    return asked;
  }
  std::filesystem::path folder = programFolder();
  for (int up = 0; up <= kMostFoldersUp; ++up, folder = folder.parent_path()) {
    for (const char* const models : {"share/ergotic/models", "models"}) {
      const std::filesystem::path scene = folder / models / (asked + ".yaml");
      if (std::filesystem::is_regular_file(scene, failure)) {
        return scene.string();
      }
    }
  }
  return asked;
}

CLI::Option* addScene(CLI::App& app, std::string& scene) {
  return app
      .add_option_function<std::string>(
          "scene", [&scene](const std::string& asked) { scene = sceneFile(asked); },
          "scene file, .yaml or .mdl, or the name of a shipped instrument")
      ->type_name("SCENE");
}

}  // namespace ergotic::tools
