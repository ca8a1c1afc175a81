// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/coarse_string.hpp"

#include <cstddef>

namespace ergotic::scene {

CoarseLink coarseLink(int masses, int index) {
  for (int reach = 1; reach <= 3; ++reach) {
    const int links = masses + 2 - reach;
    if (index < links) {
      CoarseLink link{index, index + reach, {}};
      link.weights[static_cast<std::size_t>(reach - 1)] = 1.0;
      return link;
    }
    index -= links;
  }
  const bool last = index >= 3;
  const auto place = [&](int from_end) { return last ? masses + 1 - from_end : from_end; };
  switch (index % 3) {
    case 0:
      return {place(0), place(1), {0.0, 2.0, 2.0}};
    case 1:
      return {place(0), place(2), {0.0, 0.0, 2.0}};
    default:
      return {place(1), place(2), {0.0, 0.0, -1.0}};
  }
}

}  // namespace ergotic::scene
