// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

/// Name of the body of a module: "string_4.body" of `string_4.body.25`, of the point
/// `string_4.body@0.83` on it, and of `string_4.body.outline.3` and `string_4.body.end`.
std::string bodyOf(const std::string& module);

/// Strings, bars and surfaces that hands play: those that each touches or holds, itself or through
/// a module that it moves, such as the hammer behind a key.
/// \param hands  indices of their modules
/// \return [hands] names as of bodyOf, sorted. \pre isConsistent(structure)
std::vector<std::vector<std::string>> playedBy(const ModelStructure& structure,
                                               const std::vector<std::uint32_t>& hands);

}  // namespace ergotic::panel
