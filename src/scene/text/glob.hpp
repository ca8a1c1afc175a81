// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string_view>

namespace ergotic::scene {

/// Whether a name is meant by one in which `*` stands for any letters but a dot.
inline bool isMeantBy(std::string_view name, std::string_view pattern) {
  std::size_t at = 0;               // in the pattern
  std::size_t star = pattern.npos;  // the last one passed
  std::size_t taken = 0;            // of the name, by all before that star, and it
  std::size_t i = 0;
  while (i < name.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      taken = i;
    } else if (at < pattern.size() && pattern[at] == name[i]) {
      ++at;
      ++i;
    } else if (star != pattern.npos && name[taken] != '.') {
      i = ++taken;
      at = star + 1;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == pattern.npos;
}

inline bool isPattern(std::string_view name) {
  return name.find('*') != name.npos;
}

/// Numbers in names by what they count: `note_2` before `note_10`.
inline bool isBefore(std::string_view a, std::string_view b) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  const auto digits = [&](std::string_view text, std::size_t from) {
    std::size_t end = from;
    while (end < text.size() && isDigit(text[end])) {
      ++end;
    }
    return text.substr(from, end - from);
  };
  std::size_t i = 0;
  std::size_t k = 0;
  while (i < a.size() && k < b.size()) {
    if (isDigit(a[i]) && isDigit(b[k])) {
      const std::string_view one = digits(a, i);
      const std::string_view two = digits(b, k);
      const auto significant = [](std::string_view number) {
        return number.substr(std::min(number.find_first_not_of('0'), number.size()));
      };
      const std::string_view first = significant(one);
      const std::string_view second = significant(two);
      if (first != second) {
        return first.size() != second.size() ? first.size() < second.size() : first < second;
      }
      i += one.size();
      k += two.size();
    } else if (a[i] != b[k]) {
      return a[i] < b[k];
    } else {
      ++i;
      ++k;
    }
  }
  return a.size() - i < b.size() - k || (i == a.size() && k == b.size() && a < b);
}

}  // namespace ergotic::scene
