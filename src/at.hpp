// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace ergotic {

/// An index as containers want it. \pre i >= 0. Realtime: yes
constexpr std::size_t at(int i) noexcept {
  return static_cast<std::size_t>(i);
}

}  // namespace ergotic
