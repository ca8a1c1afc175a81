// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/exception.hpp"

namespace ergotic {

TextError::TextError(const std::string& file, int line, int column, const std::string& what)
    : Exception(file + ":" + std::to_string(line) + ":" + std::to_string(column) +
                ": error: " + what),
      line_(line),
      column_(column) {}

}  // namespace ergotic
