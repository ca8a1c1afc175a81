// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "ergotic/exception.hpp"
#include "scene/language/constant.hpp"

namespace ergotic::scene {

/// An error in an expression, with the index of its character.
class ExpressionError : public Exception {
 public:
  ExpressionError(const std::string& what, std::size_t at) : Exception(what), at_(at) {}
  std::size_t at() const noexcept { return at_; }

 private:
  std::size_t at_;
};

/// Numbers (with units too, as in `4 mm`), names, `a[i]`, `+ - * / ^`, comparisons, `a ? b : c`,
/// `sin cos tan exp log sqrt abs min max floor round pow mod`, `note(A4)` in Hz, `cents(5)` as a
/// ratio, `rand(seed, i)`: from 0 to 1, the same everywhere. Every expression ends, and is finite.
/// Operands of sums, comparisons, `min` and `max` are of one kind; a number without a unit is of
/// any.
/// \throws ExpressionError
Constant evaluate(std::string_view expression, const Scope& scope);

/// Text of a constant as a scalar: the shortest number, with its unit, or the words. \pre no list
std::string textOf(const Constant& constant);
/// The same without the unit, for names.
std::string bareTextOf(const Constant& constant);

}  // namespace ergotic::scene
