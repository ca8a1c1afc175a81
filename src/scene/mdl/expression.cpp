// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mdl/expression.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

constexpr int kDeepest = 32;

struct Function {
  const char* name;
  std::size_t arguments;
  double (*apply)(double, double);
};

constexpr std::array<Function, 9> kFunctions{{
    {"sqrt", 1, [](double a, double) { return std::sqrt(a); }},
    {"exp", 1, [](double a, double) { return std::exp(a); }},
    {"log", 1, [](double a, double) { return std::log(a); }},
    {"sin", 1, [](double a, double) { return std::sin(a); }},
    {"cos", 1, [](double a, double) { return std::cos(a); }},
    {"abs", 1, [](double a, double) { return std::abs(a); }},
    {"pow", 2, [](double a, double b) { return std::pow(a, b); }},
    {"min", 2, [](double a, double b) { return std::min(a, b); }},
    {"max", 2, [](double a, double b) { return std::max(a, b); }},
}};

/// Recursive descent: sum -> product -> unary -> primary.
class Evaluator {
 public:
  Evaluator(const std::string& text, const NameValue& name_value)
      : text_(text), name_value_(name_value) {}

  double whole() {
    const double value = sum();
    if (peek() != '\0') {
      fail(std::string("unexpected '") + peek() + "' in expression " + quoted(text_));
    }
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw MdlExpressionError(at_, what); }

  /// The next character that is not blank, 0 at the end.
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) {
      ++at_;
    }
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char c) {
    if (peek() != c) {
      return false;
    }
    ++at_;
    return true;
  }

  double finite(double value, std::size_t offset) const {
    if (!std::isfinite(value)) {
      throw MdlExpressionError(offset, "expression " + quoted(text_) + " has no finite value");
    }
    return value;
  }

  double sum() {
    double value = product();
    for (;;) {
      const std::size_t offset = at_;
      if (take('+')) {
        value = finite(value + product(), offset);
      } else if (take('-')) {
        value = finite(value - product(), offset);
      } else {
        return value;
      }
    }
  }

  double product() {
    double value = unary();
    for (;;) {
      peek();
      const std::size_t offset = at_;
      if (take('*')) {
        value = finite(value * unary(), offset);
      } else if (take('/')) {
        const double divisor = unary();
        if (divisor == 0.0) {
          throw MdlExpressionError(offset, "division by zero in expression " + quoted(text_));
        }
        value = finite(value / divisor, offset);
      } else {
        return value;
      }
    }
  }

  double unary() {
    if (++depth_ > kDeepest) {
      fail("expression " + quoted(text_) +
           " is nested too deeply, allowed: " + std::to_string(kDeepest) + " levels");
    }
    const double value = take('-') ? -unary() : take('+') ? unary() : primary();
    --depth_;
    return value;
  }

  double primary() {
    const char c = peek();
    if (take('(')) {
      const double value = sum();
      close();
      return value;
    }
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      return number();
    }
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') {
      return nameOrCall();
    }
    fail(c == '\0' ? "expression " + quoted(text_) + " ends too early"
                   : std::string("unexpected '") + c + "' in expression " + quoted(text_));
  }

  void close() {
    if (!take(')')) {
      fail("missing ')' in expression " + quoted(text_));
    }
  }

  double number() {
    double value = 0.0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc()) {
      fail("not a finite number in expression " + quoted(text_));
    }
    at_ += static_cast<std::size_t>(end - begin);
    return value;
  }

  double nameOrCall() {
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
      ++at_;
    }
    const std::string name = text_.substr(start, at_ - start);
    return peek() == '(' ? call(name, start) : name_value_(name, start);
  }

  double call(const std::string& name, std::size_t start) {
    const auto function = std::find_if(kFunctions.begin(), kFunctions.end(),
                                       [&name](const Function& f) { return name == f.name; });
    if (function == kFunctions.end()) {
      std::vector<std::string> known;
      for (const Function& f : kFunctions) {
        known.emplace_back(f.name);
      }
      throw MdlExpressionError(start, "unknown function " + quoted(name) + suggestion(name, known));
    }
    take('(');
    std::array<double, 2> arguments{};
    arguments[0] = sum();
    if (function->arguments == 2) {
      if (!take(',')) {
        fail("missing ',' in expression " + quoted(text_) + ": " + name + " takes two arguments");
      }
      arguments[1] = sum();
    }
    close();
    return finite(function->apply(arguments[0], arguments[1]), start);
  }

  const std::string& text_;
  const NameValue& name_value_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

double evaluate(const std::string& text, const NameValue& name_value) {
  return Evaluator(text, name_value).whole();
}

}  // namespace ergotic::scene
