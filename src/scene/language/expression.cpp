// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expression.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "scene/language/functions.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "scene/text/quantity.hpp"

namespace ergotic::scene {
namespace {

constexpr int kDeepest = 100;
constexpr std::size_t kLongest = 4096;

bool isLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

constexpr const char* kNote = "note";

class Parser {
 public:
  Parser(std::string_view text, const Scope& scope) : text_(text), scope_(scope) {}

  Constant run() {
    Constant value = choice();
    skip();
    if (at_ != text_.size()) {
      fail("'" + std::string(text_.substr(at_, 1)) + "' is not expected here");
    }
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw ExpressionError(what, at_); }

  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
    }
  }
  /// True, and beyond it, if that comes next.
  bool takes(std::string_view token) {
    skip();
    if (text_.substr(at_, token.size()) != token) {
      return false;
    }
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token) {
    if (!takes(token)) {
      fail("'" + std::string(token) + "' is missing");
    }
  }

  double number(const Constant& value) const {
    const auto* const number = std::get_if<double>(&value);
    if (number == nullptr) {
      if (unused_ > 0) {
        return 0.0;
      }
      fail((std::holds_alternative<Node>(value) ? std::string("a list")
                                                : quoted(std::get<std::string>(value))) +
           " is no number");
    }
    return *number;
  }
  double finite(double value) const {
    if (std::isfinite(value)) {
      return value;
    }
    if (unused_ == 0) {
      fail("it is not a finite number");
    }
    return 0.0;
  }

  Constant choice() {
    if (++depth_ > kDeepest) {
      fail("it is nested too deeply");
    }
    Constant value = comparison();
    if (takes("?")) {
      const bool holds = number(value) != 0.0;
      Constant first = branch(holds);
      expect(":");
      Constant second = branch(!holds);
      value = holds ? std::move(first) : std::move(second);
    }
    --depth_;
    return value;
  }

  /// What is not chosen need have no value, as in `n > 0 ? 1/n : 0`.
  Constant branch(bool is_used) {
    unused_ += is_used ? 0 : 1;
    Constant value = choice();
    unused_ -= is_used ? 0 : 1;
    return value;
  }

  Constant comparison() {
    Constant value = sum();
    for (const char* const sign : {"==", "!=", "<=", ">=", "<", ">"}) {
      if (takes(sign)) {
        return compared(value, sign, sum()) ? 1.0 : 0.0;
      }
    }
    return value;
  }
  bool compared(const Constant& a, const std::string& sign, const Constant& b) const {
    if (sign == "==" || sign == "!=") {
      const bool are_words =
          std::holds_alternative<std::string>(a) && std::holds_alternative<std::string>(b);
      const bool are_equal =
          are_words ? std::get<std::string>(a) == std::get<std::string>(b) : number(a) == number(b);
      return are_equal == (sign == "==");
    }
    return sign == "<"    ? number(a) < number(b)
           : sign == ">"  ? number(a) > number(b)
           : sign == "<=" ? number(a) <= number(b)
                          : number(a) >= number(b);
  }

  Constant sum() {
    Constant value = product();
    while (true) {
      if (takes("+")) {
        value = finite(number(value) + number(product()));
      } else if (takes("-")) {
        value = finite(number(value) - number(product()));
      } else {
        return value;
      }
    }
  }

  Constant product() {
    Constant value = sign();
    while (true) {
      if (takes("*")) {
        value = finite(number(value) * number(sign()));
      } else if (takes("/")) {
        value = finite(number(value) / number(sign()));
      } else {
        return value;
      }
    }
  }

  Constant sign() {
    int minuses = 0;
    while (takes("-")) {
      ++minuses;
    }
    skip();
    const std::size_t operand = at_;
    const bool is_negative = minuses % 2 != 0;
    negative_at_ = is_negative ? operand : std::string_view::npos;
    Constant value = power();
    if (minuses == 0) {
      return value;
    }
    return is_negative && taken_at_ != operand ? -number(value) : number(value);
  }

  /// Binds to the right, and more than a sign before it.
  Constant power() {
    Constant base = primary();
    if (!takes("^")) {
      return base;
    }
    if (++depth_ > kDeepest) {
      fail("it is nested too deeply");
    }
    const double exponent = number(sign());
    --depth_;
    return finite(std::pow(number(base), exponent));
  }

  Constant primary() {
    if (takes("(")) {
      Constant value = choice();
      expect(")");
      return value;
    }
    skip();
    if (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) {
      return quantity();
    }
    if (at_ < text_.size() && isLetter(text_[at_])) {
      return named();
    }
    fail(at_ < text_.size() ? "'" + std::string(text_.substr(at_, 1)) + "' is not expected here"
                            : "it ends too soon");
  }

  /// A number, and its unit if one follows.
  double quantity() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) {
      ++at_;
    }
    if (at_ + 1 < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E') &&
        (isDigit(text_[at_ + 1]) ||
         (at_ + 2 < text_.size() && (text_[at_ + 1] == '-' || text_[at_ + 1] == '+') &&
          isDigit(text_[at_ + 2])))) {
      at_ += 2;
      while (at_ < text_.size() && isDigit(text_[at_])) {
        ++at_;
      }
    }
    const std::string_view number = text_.substr(first, at_ - first);
    const std::size_t after = at_;
    if (const std::optional<double> value = withUnit(number)) {
      const std::string unit = trimmed(text_.substr(after, at_ - after));
      if (first == negative_at_ && (unit == "dB" || unit == "cents")) {
        taken_at_ = first;  // -6 dB is a half, not minus two
        return parseAnyQuantity("-" + std::string(number) + " " + unit).value_or(0.0);
      }
      return *value;
    }
    const std::optional<double> bare = parseNumber(number);
    if (!bare) {
      fail("'" + std::string(number) + "' is not a finite number");
    }
    return *bare;
  }

  /// As far as it is one: `mm`, `%`, `mm^2`, `kN/m`, without blanks in it, as beside a plain
  /// number.
  std::optional<double> withUnit(std::string_view number) {
    std::size_t from = at_;
    while (from < text_.size() && text_[from] == ' ') {
      ++from;
    }
    std::optional<double> value;
    std::size_t end = from;
    for (std::size_t next = endOfUnit(from); next > end; next = endOfUnit(end)) {
      end = next;
      const std::string unit(text_.substr(from, end - from));
      const std::optional<double> more = parseAnyQuantity(std::string(number) + " " + unit);
      if (!more) {
        break;
      }
      value = more;
      at_ = end;
    }
    return value;
  }
  /// Beyond a word of letters, or of a power or a divisor.
  std::size_t endOfUnit(std::size_t from) const {
    const char sign = from < text_.size() ? text_[from] : ' ';
    const std::size_t first = from + (sign == '^' || sign == '/' ? 1 : 0);
    std::size_t end = first;
    const auto belongs = [&](char c) {
      return sign == '^' ? isDigit(c)
                         : isLetter(c) || c == '%' || static_cast<unsigned char>(c) >= 0x80U;
    };
    while (end < text_.size() && belongs(text_[end])) {
      ++end;
    }
    return end > first ? end : from;
  }

  Constant named() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (isLetter(text_[at_]) || isDigit(text_[at_]))) {
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '#') {
      ++at_;  // the index of what goes through a list
    }
    const std::string name(text_.substr(first, at_ - first));
    if (takes("(")) {
      return called(name);
    }
    const Constant* const known = scope_.find(name);
    if (known == nullptr) {
      at_ = first;
      fail("unknown name " + quoted(name) + suggestion(name, scope_.names()));
    }
    if (!takes("[")) {
      // A list that nobody looks at need not be copied.
      const bool is_list = std::holds_alternative<Node>(*known);
      return unused_ > 0 && is_list ? Constant(0.0) : *known;
    }
    Constant value = item(*known);
    while (takes("[")) {
      value = item(value);
    }
    return value;
  }

  Constant item(const Constant& list) {
    const auto* const node = std::get_if<Node>(&list);
    if ((node == nullptr || !node->isList()) && unused_ == 0) {
      fail("what is no list has no items");
    }
    const double index = number(choice());
    expect("]");
    if (unused_ > 0) {
      return 0.0;
    }
    if (index != std::floor(index) || index < 0.0 || index >= static_cast<double>(node->size())) {
      fail("item " + shortest(index) + " of a list of " + std::to_string(node->size()) +
           (node->size() > 0 ? ", allowed: 0..." + std::to_string(node->size() - 1)
                             : ", which has none"));
    }
    return constantOf((*node)[static_cast<std::size_t>(index)]);
  }

  Constant called(const std::string& name) {
    if (name == kNote) {
      return note();
    }
    const Function* const function = findFunction(name);
    if (function == nullptr) {
      std::vector<std::string> names = functionNames();
      names.emplace_back(kNote);
      fail("unknown function " + quoted(name) + suggestion(name, names));
    }
    double arguments[2] = {};
    for (std::size_t i = 0; i < function->arguments; ++i) {
      if (i > 0) {
        expect(",");
      }
      arguments[i] = number(choice());
    }
    expect(")");
    return finite(function->value(arguments));
  }

  /// `note(A4)`, or of a name that stands for one.
  Constant note() {
    skip();
    const std::size_t end = std::min(text_.find(')', at_), text_.size());
    const std::string word = trimmed(text_.substr(at_, end - at_));
    const Constant* const known = scope_.find(word);
    const auto* const words = known == nullptr ? &word : std::get_if<std::string>(known);
    if (words == nullptr) {
      fail(quoted(word) + " is no note");
    }
    const auto hz = parseQuantity(*words, "Hz");
    if (std::holds_alternative<NoQuantity>(hz)) {
      fail(quoted(*words) + " is no note");
    }
    at_ = end;
    expect(")");
    return std::get<double>(hz);
  }

  std::string_view text_;
  const Scope& scope_;
  std::size_t at_ = 0;
  std::size_t negative_at_ = std::string_view::npos;  // where what a minus stands before begins
  std::size_t taken_at_ = std::string_view::npos;     // that is a number that took the minus
  int depth_ = 0;
  int unused_ = 0;  // branches around
};

}  // namespace

Constant evaluate(std::string_view expression, const Scope& scope) {
  if (expression.size() > kLongest) {
    throw ExpressionError("it has " + std::to_string(expression.size()) +
                              " bytes, allowed: at most " + std::to_string(kLongest),
                          0);
  }
  return Parser(expression, scope).run();
}

Constant constantOf(const Node& node) {
  if (!node.isScalar()) {
    return node;
  }
  const std::optional<double> number = parseAnyQuantity(node.text());
  return number ? Constant(*number) : Constant(node.text());
}

std::string textOf(const Constant& constant) {
  const auto* const number = std::get_if<double>(&constant);
  return number != nullptr ? shortest(*number) : std::get<std::string>(constant);
}

}  // namespace ergotic::scene
