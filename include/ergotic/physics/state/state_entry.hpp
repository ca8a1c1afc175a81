// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ergotic::physics {

/// The floating-point numbers of one element of an entry, without gaps; none: it holds integers.
struct StateNumbers {
  std::size_t doubles = 0;  ///< come first
  std::size_t floats = 0;
};

/// One entry of the state arena.
struct StateEntry {
  std::string name;
  std::size_t offset = 0;  ///< bytes
  std::size_t size = 0;    ///< bytes
  StateNumbers numbers{};  ///< numbers in each element
};

/// \param state  of the instrument that has these entries
/// \throws Exception naming entry, number and value if a number in it is not finite
/// Realtime: no.
void checkFinite(const std::vector<StateEntry>& entries, const std::vector<unsigned char>& state);

}  // namespace ergotic::physics
