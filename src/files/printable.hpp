// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace ergotic::files {

/// A text of anybody's for a message, which a NUL would end, and whose escape sequences would
/// change the terminal that shows it: control characters are written as `\x00`, and what is beyond
/// `most` bytes as `...`.
std::string printable(const std::string& text, std::size_t most);

/// Of a message of several lines.
std::string printableLines(const std::string& text);

}  // namespace ergotic::files
