// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace ergotic::scene {

/// What is wrong in an expression and where in it.
class MdlExpressionError : public std::runtime_error {
 public:
  MdlExpressionError(std::size_t offset, const std::string& what)
      : std::runtime_error(what), offset_(offset) {}
  std::size_t offset() const noexcept { return offset_; }  ///< bytes from the start

 private:
  std::size_t offset_;
};

/// Value of a name that stands `offset` bytes into the expression.
using NameValue = std::function<double(const std::string& name, std::size_t offset)>;

/// Evaluates numbers, names, `+ - * /`, parentheses, and the functions sqrt exp log sin cos abs
/// (one argument), pow min max (two). Nesting is limited to 32.
/// \return a finite number
/// \throws MdlExpressionError if it cannot be read, divides by zero or leaves the finite numbers;
///         whatever `name_value` throws
double evaluate(const std::string& text, const NameValue& name_value);

}  // namespace ergotic::scene
