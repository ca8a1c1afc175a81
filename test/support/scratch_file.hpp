// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace ergotic::test {

/// A file of this process in the temporary directory, gone with the object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& text = "")
      : path_("/tmp/ergotic_scratch_" + std::to_string(::getpid()) + "_" +
              std::to_string(next_number_++)) {
    std::ofstream(path_) << text;
  }
  ~ScratchFile() { std::remove(path_.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& path() const noexcept { return path_; }
  /// What it holds by now.
  std::string text() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  static inline int next_number_ = 0;
  std::string path_;
};

}  // namespace ergotic::test
