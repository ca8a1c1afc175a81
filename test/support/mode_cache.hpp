// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ergotic::test {

/// A place of its own for the modes that a test works out, for as long as this lives.
class ModeCache {
 public:
  ModeCache()
      : folder_(std::filesystem::temp_directory_path() /
                ("ergotic_modes_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder_);
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    unsetenv("ERGOTIC_MODE_CACHE");
  }
  ~ModeCache() {
    unsetenv("XDG_CACHE_HOME");
    std::filesystem::remove_all(folder_);
  }
  ModeCache(const ModeCache&) = delete;
  ModeCache& operator=(const ModeCache&) = delete;

  std::filesystem::path folder() const { return folder_ / "ergotic" / "modes"; }

 private:
  std::filesystem::path folder_;
};

}  // namespace ergotic::test
