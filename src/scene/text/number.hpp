// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ergotic::scene {

/// A decimal number, the whole text: `3`, `-0.5`, `.5`, `1e-3`. Nothing for text that is anything
/// else, and for what a double cannot hold (infinite, not a number, 1e999, 1e-999).
/// Does not depend on the locale.
std::optional<double> parseNumber(std::string_view text);

/// A decimal whole number, the whole text.
std::optional<int> parseInteger(std::string_view text);

/// A truth value of YAML 1.1: `true`, `yes`, `on`, `false`, `no`, `off`, in small or capital
/// letters. Nothing for any other text.
std::optional<bool> parseSwitch(std::string_view text);

/// The shortest text that reads back as the very same number.
std::string shortest(double value);
/// The text with small letters in place of the capital letters of ASCII.
std::string inSmallLetters(std::string_view text);
/// The text without blanks at either end.
std::string trimmed(std::string_view text);

}  // namespace ergotic::scene
