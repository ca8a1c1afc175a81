// SPDX-License-Identifier: BSD-3-Clause
#include "support/places.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

// Only this file knows where it was built: others are compiled alike in every clone.

namespace ergotic::test {

std::string repository(const std::string& path) {
  return ERGOTIC_SOURCE_DIR "/" + path;
}

std::string toolPath(const std::string& name) {
  return ERGOTIC_TOOLS_DIR "/" + name;
}

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void findBuiltPackages() {
  setenv("ROS_PACKAGE_PATH", ERGOTIC_SOURCE_DIR ":" ERGOTIC_SOURCE_DIR "/test", 1);
  setenv("CMAKE_PREFIX_PATH", ERGOTIC_DEVEL_DIR ":" ERGOTIC_BINARY_DIR "/third_party", 1);
}

}  // namespace ergotic::test
