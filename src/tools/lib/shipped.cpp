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
#include "files/shipped_models.hpp"

namespace ergotic::tools {
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
  const std::filesystem::path scene =
      std::filesystem::path(files::shippedModels()) / (asked + ".yaml");
  return std::filesystem::is_regular_file(scene, failure) ? scene.string() : asked;
}

CLI::Option* addScene(CLI::App& app, std::string& scene) {
  return app
      .add_option_function<std::string>(
          "scene", [&scene](const std::string& asked) { scene = sceneFile(asked); },
          "scene file, .yaml or .mdl, or the name of a shipped instrument")
      ->type_name("SCENE");
}

}  // namespace ergotic::tools
