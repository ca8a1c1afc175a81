// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

/// Kind of contact of a link; none if the link holds two modules together permanently.
enum class Touch : std::uint8_t {
  kNone,    ///< a spring, a damper, a table of any form
  kStrike,  ///< felt and its like
  kPress,   ///< a plain contact
  kPluck,
  kRub,  ///< a bow, friction
};

/// Returns the kind of contact of each link, by the name of its law. \return [links]; kNone where
/// the structure has no law
std::vector<Touch> touchesOf(const ModelStructure& structure);

}  // namespace ergotic::panel
