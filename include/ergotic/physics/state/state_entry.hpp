// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace ergotic::physics {

/// One entry of the state arena.
struct StateEntry {
  std::string name;
  std::size_t offset = 0;  ///< bytes
  std::size_t size = 0;    ///< bytes
};

}  // namespace ergotic::physics
