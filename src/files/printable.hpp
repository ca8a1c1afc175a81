// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace ergotic::files {

/// Makes a text of unknown origin safe for a message, which a NUL would end, and whose escape
/// sequences would change the terminal that shows it: control characters are written as `\x00`, and
/// text beyond `most` bytes as `...`.
std::string printable(const std::string& text, std::size_t most);

/// Makes a message of several lines printable, and keeps its lines.
std::string printableLines(const std::string& text);

}  // namespace ergotic::files
