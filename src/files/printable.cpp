// SPDX-License-Identifier: BSD-3-Clause
#include "files/printable.hpp"

#include <cstdio>

namespace ergotic::files {
namespace {

/// Position at which to cut a text: not in the middle of a UTF-8 character.
std::size_t endOf(const std::string& text, std::size_t most) {
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;
  }
  return end;
}

void add(char c, std::string& shown) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte < 0x20U || byte == 0x7FU) {
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02X", byte);
    shown += code;
  } else {
    shown += c;
  }
}

}  // namespace

std::string printable(const std::string& text, std::size_t most) {
  const bool is_long = text.size() > most;
  std::string shown;
  for (const char c : text.substr(0, is_long ? endOf(text, most) : text.size())) {
    add(c, shown);
  }
  return is_long ? shown + "..." : shown;
}

std::string printableLines(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    if (c == '\n') {
      shown += c;
    } else {
      add(c, shown);
    }
  }
  return shown;
}

}  // namespace ergotic::files
