// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::node {

/// Limit for names of files that this program keeps for its users.
constexpr std::size_t kLongestFileName = 64;

/// \param what  for the message, as in `take`
/// \throws Exception if no file of a folder may have this name
void requireFileName(const std::string& what, const std::string& name);

/// Replaces characters that such a name may not have by `_`, and cuts it to its length.
std::string toFileName(std::string text);

}  // namespace ergotic::node
