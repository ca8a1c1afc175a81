// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "ergotic/exception.hpp"

/// What the programs of this folder share. Each gives bytes to what reads them; whatever is neither
/// read nor refused as it should be ends the program, and libFuzzer keeps the bytes.
namespace ergotic::fuzz {

/// A folder that does not exist: nothing that a text names is opened.
constexpr const char* kFile = "/nowhere/fuzz";

inline std::string textOf(const std::uint8_t* data, std::size_t size) {
  return {data, data + size};
}

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

/// Fails unless the error is at a place of the text, or right behind it.
inline void expectPlace(const TextError& error, const std::string& text) {
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n') +
                     std::count(text.begin(), text.end(), '\r');  // of old Macintosh files
  const std::string what = error.what();
  const std::string start = std::string(kFile) + ":" + std::to_string(error.line()) + ":" +
                            std::to_string(error.column()) + ": error: ";
  if (what.compare(0, start.size(), start) != 0 || error.line() < 1 || error.line() > lines + 1 ||
      error.column() < 1 || static_cast<std::size_t>(error.column()) > text.size() + 1) {
    fail("an error without a place of the text: " + what);
  }
}

/// What `read()` gives, or nothing if it refuses the text with a place of it.
template <class Read>
auto readOrRefuse(const std::string& text, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const TextError& error) {
    expectPlace(error, text);
    return std::nullopt;
  }
}

}  // namespace ergotic::fuzz
