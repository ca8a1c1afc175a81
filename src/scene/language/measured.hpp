// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "scene/text/quantity.hpp"

namespace ergotic::scene {

inline bool isLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
inline bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// A number with its unit, in an expression.
struct Measured {
  Amount value;
  std::string unit;
  std::size_t end = 0;  ///< beyond the unit
};

/// A number with the unit that follows it: `mm`, `%`, `mm^2`, `kN/m`, without blanks in it, as
/// beside a plain number. \param from  beyond the number
std::optional<Measured> measuredAt(std::string_view text,
                                   std::size_t from,
                                   std::string_view number);

}  // namespace ergotic::scene
