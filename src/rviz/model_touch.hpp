// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

/// How a link touches, if it is none that holds two modules together for good.
enum class Touch : std::uint8_t {
  kNone,    ///< a spring, a damper, a table of any form
  kStrike,  ///< felt and its like
  kPress,   ///< a plain contact
  kPluck,
  kRub,  ///< a bow, friction
};

/// By the name of the law of each link. \return [links]; kNone where the structure tells no law
std::vector<Touch> touchesOf(const ModelStructure& structure);

}  // namespace ergotic::panel
