// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/measured.hpp"

namespace ergotic::scene {
namespace {

/// Beyond a word of letters, a power, a divisor, or a factor behind a blank as in `N s/m`.
std::size_t endOfUnit(std::string_view text, std::size_t from) {
  const char sign = from < text.size() ? text[from] : '\0';
  const std::size_t first = from + (sign == '^' || sign == '/' || sign == ' ' ? 1 : 0);
  std::size_t end = first;
  const auto belongs = [&](char c) {
    return sign == '^' ? isDigit(c)
                       : isLetter(c) || c == '%' || static_cast<unsigned char>(c) >= 0x80U;
  };
  while (end < text.size() && belongs(text[end])) {
    ++end;
  }
  return end > first ? end : from;
}

}  // namespace

std::optional<Measured> measuredAt(std::string_view text,
                                   std::size_t from,
                                   std::string_view number) {
  while (from < text.size() && text[from] == ' ') {
    ++from;
  }
  std::optional<Measured> found;
  std::size_t end = from;
  for (std::size_t next = endOfUnit(text, from); next > end; next = endOfUnit(text, end)) {
    end = next;
    const std::string unit(text.substr(from, end - from));
    const std::optional<Amount> more = parseAnyQuantity(std::string(number) + " " + unit);
    if (!more) {
      break;
    }
    found = Measured{*more, unit, end};
  }
  return found;
}

}  // namespace ergotic::scene
