// SPDX-License-Identifier: BSD-3-Clause
#include "files/shipped_models.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace ergotic::files {
namespace {

/// Folders between the library and what has the models: an install space with lib, the sources with
/// devel/lib, or with a build in a folder such as build/asan before that.
constexpr int kMaxFoldersUp = 5;

std::string findShippedModels() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&shippedModels), &library) == 0) {
    return "";
  }
  std::error_code failure;
  std::filesystem::path folder = std::filesystem::canonical(library.dli_fname, failure);
  for (int up = 0; up < kMaxFoldersUp && !folder.empty(); ++up) {
    folder = folder.parent_path();
    for (const char* const models : {"share/ergotic/models", "models"}) {
      if (std::filesystem::is_directory(folder / models / "lib", failure)) {
        return (folder / models).string();
      }
    }
  }
  return "";
}

}  // namespace

std::string shippedModels() {
  static const std::string folder = findShippedModels();
  return folder;
}

}  // namespace ergotic::files
