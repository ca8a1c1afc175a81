// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>

namespace ergotic::test {

/// Lets pluginlib find what was just built, whatever the shell has sourced: this package, and the
/// device of somebody else.
inline void findBuiltPackages() {
  setenv("ROS_PACKAGE_PATH", ERGOTIC_SOURCE_DIR ":" ERGOTIC_SOURCE_DIR "/test", 1);
  setenv("CMAKE_PREFIX_PATH", ERGOTIC_DEVEL_DIR ":" ERGOTIC_BINARY_DIR "/third_party", 1);
}

}  // namespace ergotic::test
