// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include <sys/stat.h>
#include <sys/wait.h>

/// Runs the built command-line tools as a person does.

#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {

inline bool exists(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0;
}

struct Outcome {
  int code = -1;
  std::string text;  ///< stdout and, unless it went elsewhere, stderr
};

/// \param errors  where stderr goes, as a shell says it
inline Outcome run(const std::string& tool,
                   const std::string& arguments,
                   const std::string& errors = "&1") {
  Outcome outcome;
  FILE* pipe = popen((toolPath(tool) + " " + arguments + " 2>" + errors).c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t got = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.text.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace ergotic::test
