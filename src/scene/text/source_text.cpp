// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/source_text.hpp"

#include <algorithm>
#include <cstdio>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

unsigned byteAt(const std::string& text, std::size_t offset) {
  return static_cast<unsigned char>(text[offset]);
}

/// Bytes of the UTF-8 character that starts here, 0 if it is malformed (Unicode 15, table 3-7).
std::size_t utf8Length(const std::string& text, std::size_t offset) {
  const unsigned lead = byteAt(text, offset);
  if (lead < 0x80U) {
    return 1;
  }
  if (lead < 0xC2U || lead > 0xF4U) {
    return 0;
  }
  const std::size_t length = lead < 0xE0U ? 2 : lead < 0xF0U ? 3 : 4;
  if (offset + length > text.size()) {
    return 0;
  }
  // Second byte: no overlong forms, no surrogates, nothing past U+10FFFF.
  const unsigned low = lead == 0xE0U ? 0xA0U : lead == 0xF0U ? 0x90U : 0x80U;
  const unsigned high = lead == 0xEDU ? 0x9FU : lead == 0xF4U ? 0x8FU : 0xBFU;
  const unsigned second = byteAt(text, offset + 1);
  if (second < low || second > high) {
    return 0;
  }
  for (std::size_t i = 2; i < length; ++i) {
    if ((byteAt(text, offset + i) & 0xC0U) != 0x80U) {
      return 0;
    }
  }
  return length;
}

bool isForbiddenControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20U && c != '\t' && c != '\n' && c != '\r') || byte == 0x7FU;
}

std::string hex(unsigned byte) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02X", byte);
  return text;
}

}  // namespace

void checkBytes(const std::string& text, const std::string& file, Bytes allowed, int first_line) {
  if (text.size() > kMaxTextBytes) {
    throw TextError(file, 1, 1,
                    "the text has " + std::to_string(text.size()) + " bytes, allowed: at most " +
                        std::to_string(kMaxTextBytes));
  }
  if (first_line == 1) {
    refuseUtf16(text, file);
  }
  const auto control = std::find_if(text.begin(), text.end(), isForbiddenControl);
  if (control != text.end()) {
    const auto offset = static_cast<std::size_t>(control - text.begin());
    const Place place = placeAt(text, offset);
    throw TextError(file, place.line + first_line - 1, place.column,
                    "control character " + hex(byteAt(text, offset)) +
                        " in a text, allowed: tab and line ends only");
  }
  const std::size_t bad = allowed == Bytes::kUtf8 ? findNonUtf8(text) : std::string::npos;
  if (bad != std::string::npos) {
    const Place place = placeAt(text, bad);
    throw TextError(file, place.line + first_line - 1, place.column,
                    "byte " + hex(byteAt(text, bad)) + " is not UTF-8, allowed: UTF-8 only");
  }
}

void refuseUtf16(const std::string& text, const std::string& file) {
  const auto isNul = [&text](std::size_t offset) { return text[offset] == '\0'; };
  const std::string mark = text.substr(0, 2);
  const bool has_mark = mark == "\xFF\xFE" || mark == "\xFE\xFF";
  const bool has_half_letters =
      text.size() >= 4 && isNul(0) == isNul(2) && isNul(1) == isNul(3) && isNul(0) != isNul(1);
  if (has_mark || has_half_letters) {
    throw TextError(file, 1, 1,
                    "the text is UTF-16, which has two bytes for each letter, allowed: UTF-8 (an "
                    "editor or a spreadsheet offers it where a file is saved: `CSV UTF-8`)");
  }
}

std::size_t findNonUtf8(const std::string& text) {
  std::size_t offset = 0;
  while (offset < text.size()) {
    const std::size_t length = utf8Length(text, offset);
    if (length == 0) {
      return offset;
    }
    offset += length;
  }
  return std::string::npos;
}

Place placeAt(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(offset);
  const auto line = 1 + std::count(text.begin(), end, '\n');
  const std::size_t before = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  const std::size_t start = before == std::string::npos ? 0 : before + 1;
  return {static_cast<int>(line), static_cast<int>(offset - start) + 1};
}

std::size_t byteOrderMark(const std::string& text) {
  return text.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0;
}

std::string besideFile(const std::string& path, const std::string& file) {
  const std::size_t slash = file.rfind('/');
  const bool is_absolute = !path.empty() && path.front() == '/';
  return is_absolute || slash == std::string::npos ? path : file.substr(0, slash + 1) + path;
}

std::string stemOf(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  const std::string base = slash == std::string::npos ? file : file.substr(slash + 1);
  const std::size_t dot = base.rfind('.');
  return dot == std::string::npos || dot == 0 ? base : base.substr(0, dot);
}

}  // namespace ergotic::scene
